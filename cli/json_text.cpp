#include "cli/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bezel/base/atomic_file.hpp"
#include "bezel/io/cursor.hpp"

namespace bezel::cli {
namespace {

constexpr std::size_t deepest = 16;

std::string read_standard_input() {
  std::string bytes;
  std::array<char, 65536> part;
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), stdin))
    bytes.append(part.data(), n);
  if (std::ferror(stdin) != 0)
    throw InputError(InputPlace{"standard input", 0, {}, -1}, "cannot be read");
  return bytes;
}

/// Position of the last character read.
std::size_t last_read(std::string_view json, std::size_t read) {
  return std::min(read, json.size()) - (read > 0 && !json.empty() ? 1 : 0);
}

/// Builds a JsonValue from the parts of the text.
class Builder {
 public:
  Builder(const std::string& file, std::string_view json) : file_(file), json_(json) {}

  JsonValue read() {
    const Characters begin{json_.data(), &read_}, end{json_.data() + json_.size(), &read_};
    nlohmann::json::sax_parse(begin, end, this);
    return std::move(root_);
  }

  // The interface that nlohmann::json asks for.
  bool null() { return add(JsonValue::Kind::null); }
  bool boolean(bool value) { return add(JsonValue::Kind::boolean, value ? 1.0 : 0.0); }
  bool number_integer(std::int64_t value) {
    return add(JsonValue::Kind::number, static_cast<double>(value));
  }
  bool number_unsigned(std::uint64_t value) {
    return add(JsonValue::Kind::number, static_cast<double>(value));
  }
  bool number_float(double value, const std::string&) {
    return add(JsonValue::Kind::number, value);
  }
  bool string(std::string& text) {
    add(JsonValue::Kind::string);
    last_->text = text;
    return true;
  }
  bool binary(std::vector<std::uint8_t>&) { return add(JsonValue::Kind::null); }  // not in text
  bool start_object(std::size_t) { return open(JsonValue::Kind::object); }
  bool start_array(std::size_t) { return open(JsonValue::Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& key) {
    std::vector<std::string>& keys = open_.back()->keys;
    if (std::find(keys.begin(), keys.end(), key) != keys.end())
      throw InputError(json_place(file_, json_, read_, ""),
                       fmt::format("the key \"{}\" is given twice", files::shown(key)));
    if (keys.size() >= most_keys)
      throw InputError(json_place(file_, json_, read_, ""),
                       fmt::format("an object with more than {} keys", most_keys));
    keys.push_back(key);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    fail_not_json(file_, json_, read_, error.what());
  }

 private:
  static constexpr std::size_t most_keys = 64;  // looked through one by one

  bool add(JsonValue::Kind kind, double number = 0.0) {
    JsonValue value;
    value.kind = kind;
    value.line = line();
    value.number = number;
    if (open_.empty()) {
      root_ = std::move(value);
      last_ = &root_;
    } else {
      open_.back()->items.push_back(std::move(value));
      last_ = &open_.back()->items.back();
    }
    return true;
  }
  // A parent's items do not move while one of them is open: it is the last.
  bool open(JsonValue::Kind kind) {
    if (open_.size() == deepest)
      throw InputError(json_place(file_, json_, read_, ""),
                       fmt::format("values nested deeper than {}", deepest));
    add(kind);
    open_.push_back(last_);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  /// Line of the last character read, counted on from the last call.
  std::int64_t line() {
    const std::size_t end = last_read(json_, read_);
    line_ += std::count(json_.begin() + static_cast<std::ptrdiff_t>(counted_),
                        json_.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    counted_ = end;
    return line_;
  }

  const std::string& file_;
  std::string_view json_;
  std::size_t read_ = 0, counted_ = 0;
  std::int64_t line_ = 1;
  JsonValue root_;
  JsonValue* last_ = nullptr;
  std::vector<JsonValue*> open_;
};

}  // namespace

InputPlace json_place(const std::string& file, std::string_view json, std::size_t read,
                      const std::string& element) {
  return {file, files::line_of(json, last_read(json, read)), element, -1};
}

void fail_not_json(const std::string& file, std::string_view json, std::size_t read,
                   const std::string& message) {
  // "[json.exception...] parse error at line 1, column 2: what", or without the place
  std::string what = message;
  const std::size_t column = what.find("column "), bracket = what.find("] ");
  const std::size_t colon = what.find(": ", std::min(column, what.size()));
  if (colon != std::string::npos) {
    what.erase(0, colon + 2);
  } else if (bracket != std::string::npos) {
    what.erase(0, bracket + 2);
  }
  for (char& c : what)
    if (c < ' ' || c > '~') c = '?';
  InputPlace place = json_place(file, json, read, "column");
  const std::size_t at = last_read(json, read);
  const std::size_t newline = at == 0 ? std::string_view::npos : json.rfind('\n', at - 1);
  place.element =
      static_cast<std::int64_t>(newline == std::string_view::npos ? at + 1 : at - newline);
  throw InputError(place, fmt::format("not JSON: {}", what));
}

InputText read_input_text(const std::string& file) {
  if (file == "-") return {"standard input", read_standard_input()};
  return {file, read_file(file)};
}

const JsonValue* JsonValue::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

std::string described(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::null:
      return "null";
    case JsonValue::Kind::boolean:
      return value.number != 0.0 ? "true" : "false";
    case JsonValue::Kind::number:
      return "a number";
    case JsonValue::Kind::string:
      return fmt::format("'{}'", files::shown(value.text));
    case JsonValue::Kind::array:
      return "an array";
    case JsonValue::Kind::object:
      return "an object";
  }
  return {};
}

JsonValue read_json(const std::string& file, std::string_view json) {
  return Builder(file, json).read();
}

}  // namespace bezel::cli
