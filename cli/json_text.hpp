#pragma once
// JSON as the commands read it: where the text comes from, and values that know their line.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"

namespace bezel::cli {

/// Characters of a text, for nlohmann::json::sax_parse; tells how many were read.
struct Characters {
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  const char* at = nullptr;
  std::size_t* read = nullptr;

  reference operator*() const { return *at; }
  Characters& operator++() {
    ++at;
    ++*read;
    return *this;
  }
  Characters operator++(int) {
    Characters old = *this;
    ++*this;
    return old;
  }
  bool operator==(const Characters& other) const { return at == other.at; }
};

/// The place of the last of the first `read` characters. @param element  what stands there
InputPlace json_place(const std::string& file, std::string_view json, std::size_t read,
                      const std::string& element);

/// The message of an exception of nlohmann, as an error with file, line and column.
[[noreturn]] void fail_not_json(const std::string& file, std::string_view json, std::size_t read,
                                const std::string& message);

/// A text and the name it has in messages.
struct InputText {
  std::string name, text;
};
/// @param file  a path, or "-" for the standard input. @throws InputError when it cannot be read
InputText read_input_text(const std::string& file);

/// A JSON value and the line where it begins (numbers and words: ends).
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
  Kind kind = Kind::null;
  std::int64_t line = 0;
  double number = 0.0;            ///< booleans: 0 or 1
  std::string text;               ///< of a string
  std::vector<std::string> keys;  ///< of an object, different, one for each item
  std::vector<JsonValue> items;   ///< of an array or object

  /// The value of a key; null when an object has none.
  const JsonValue* find(std::string_view key) const;
};

/// "null", "true", "a number", "'text'", "an array", "an object".
std::string described(const JsonValue& value);

/// @throws InputError with file, line and column for what is no JSON; for a key that is given
///         twice, and for values nested deeper than 16
JsonValue read_json(const std::string& file, std::string_view json);

}  // namespace bezel::cli
