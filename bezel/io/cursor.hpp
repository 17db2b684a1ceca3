#pragma once
// Internal to io: a place in the bytes of a file, from which text and binary values are read.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "bezel/base/error.hpp"

namespace bezel::files {

/// Text of a file as it may appear in a message: at most 40 characters, none of them control
/// characters.
std::string shown(std::string_view text);

/// 1-based line of a byte.
std::int64_t line_of(std::string_view data, std::size_t position);

/// Appends the shortest decimal that reads back as the same double; an integer.
void append_number(std::string& out, double value);
void append_number(std::string& out, std::int64_t value);
/// Appends the value as a hex float such as -0x1.8p+1.
void append_hex(std::string& out, double value);
/// Reads a whole decimal or hex float. False when the text is anything else (nan and inf are read).
bool parse_real(std::string_view text, double& value);
bool parse_integer(std::string_view text, std::int64_t& value);

/// Reads values one after the other. Text values are separated by white space; errors carry the
/// file and, in text, the line of the value; in binary, the byte.
class Cursor {
 public:
  Cursor(std::string_view data, std::string file) : data_(data), file_(std::move(file)) {}

  /// Binary values follow, in the machine's byte order or the other one.
  void set_binary(bool binary, bool swap) {
    binary_ = binary;
    swap_ = swap;
  }
  bool binary() const { return binary_; }
  bool swapped() const { return swap_; }

  std::size_t position() const { return position_; }
  void seek(std::size_t position) { position_ = position; }
  std::size_t remaining() const { return data_.size() - position_; }
  std::string_view data() const { return data_; }
  const std::string& file() const { return file_; }

  void skip_space();
  bool at_end() {
    skip_space();
    return remaining() == 0;
  }
  /// The next word, without moving past it; empty at the end.
  std::string_view peek();
  std::string_view word(const char* what);
  /// What is left of the line, without its end.
  std::string_view line();
  /// A "quoted" string on one line.
  std::string quoted(const char* what);
  std::int64_t text_integer(const char* what);
  double text_real(const char* what);
  void expect(std::string_view word);

  /// An int32, int64 / size_t, or double: text or binary as set.
  std::int32_t i32(const char* what);
  std::int64_t i64(const char* what);
  double f64(const char* what);
  /// f64 that must be finite.
  double finite(const char* what);
  /// A count 0 <= n (int32 or int64 in binary) of things that take at least bytes_each bytes each:
  /// more than the file can hold is an error, so the count is safe to allocate for.
  std::size_t count(const char* what, std::size_t bytes_each, bool wide);
  /// The same check for a count read elsewhere.
  std::size_t check_count(std::int64_t n, const char* what, std::size_t bytes_each) const;

  [[noreturn]] void fail(const std::string& message) const { fail("", -1, message); }
  [[noreturn]] void fail(const std::string& kind, std::int64_t number,
                         const std::string& message) const;

 private:
  template <class T>
  T raw(const char* what) {
    start_ = position_;
    if (remaining() < sizeof(T)) ended(what);
    std::array<unsigned char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data_.data() + position_, sizeof(T));
    if (swap_) {
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    }
    position_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }
  [[noreturn]] void ended(const char* what) const;

  std::string_view data_;
  std::string file_;
  std::size_t position_ = 0;
  std::size_t start_ = 0;  // of the value read last
  bool binary_ = false;
  bool swap_ = false;
};

}  // namespace bezel::files
