#include "bezel/io/cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bezel::files {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}  // namespace

std::string shown(std::string_view text) {
  std::string out(text.substr(0, 40));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return text.size() > 40 ? out + "..." : out;
}

std::int64_t line_of(std::string_view data, std::size_t position) {
  const auto end = data.begin() + static_cast<std::ptrdiff_t>(std::min(position, data.size()));
  return 1 + std::count(data.begin(), end, '\n');
}

void append_number(std::string& out, double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  out.append(buffer, end);
}

void append_number(std::string& out, std::int64_t value) {
  char buffer[24];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  out.append(buffer, end);
}

void append_hex(std::string& out, double value) {
  char buffer[40];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, std::abs(value), std::chars_format::hex).ptr;
  if (std::signbit(value)) out += '-';
  out += "0x";
  out.append(buffer, end);
}

bool parse_real(std::string_view text, double& value) {
  bool negative = false;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    negative = text[0] == '-';
    text.remove_prefix(1);
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) return false;
  }
  auto format = std::chars_format::general;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
    format = std::chars_format::hex;
    text.remove_prefix(2);
    if (text[0] == '-') return false;
  }
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, format);
  if (text.empty() || result.ptr != end) return false;
  if (result.ec == std::errc::result_out_of_range) {
    // Too small is zero or a denormal to other writers; too large is not a number we can hold.
    value = std::strtod(
        (format == std::chars_format::hex ? "0x" + std::string(text) : std::string(text)).c_str(),
        nullptr);
  } else if (result.ec != std::errc()) {
    return false;
  }
  if (negative) value = -value;
  return true;
}

bool parse_integer(std::string_view text, std::int64_t& value) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return !text.empty() && result.ec == std::errc() && result.ptr == end;
}

void Cursor::fail(const std::string& kind, std::int64_t number, const std::string& message) const {
  InputPlace place;
  place.file = file_;
  place.element_kind = kind;
  place.element = number;
  if (binary_) throw InputError(place, message + fmt::format(" (at byte {})", start_));
  place.line = line_of(data_, start_);
  throw InputError(place, message);
}

void Cursor::ended(const char* what) const {
  fail(fmt::format("the file ends where {} was expected", what));
}

void Cursor::skip_space() {
  while (position_ < data_.size() && is_space(data_[position_])) ++position_;
}

std::string_view Cursor::peek() {
  skip_space();
  std::size_t end = position_;
  while (end < data_.size() && !is_space(data_[end])) ++end;
  return data_.substr(position_, end - position_);
}

std::string_view Cursor::word(const char* what) {
  const std::string_view found = peek();
  start_ = position_;
  if (found.empty()) ended(what);
  position_ += found.size();
  return found;
}

std::string_view Cursor::line() {
  start_ = position_;
  const std::size_t end = std::min(data_.find('\n', position_), data_.size());
  std::string_view found = data_.substr(position_, end - position_);
  position_ = std::min(end + 1, data_.size());
  if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
  return found;
}

std::string Cursor::quoted(const char* what) {
  skip_space();
  start_ = position_;
  if (remaining() == 0) ended(what);
  const std::size_t line_end = std::min(data_.find('\n', position_), data_.size());
  const std::size_t close = data_.find('"', position_ + 1);
  if (data_[position_] != '"' || close == std::string_view::npos || close > line_end)
    fail(fmt::format("expected {} in double quotes, found '{}'", what,
                     shown(data_.substr(position_, line_end - position_))));
  std::string found(data_.substr(position_ + 1, close - position_ - 1));
  position_ = close + 1;
  return found;
}

std::int64_t Cursor::text_integer(const char* what) {
  const std::string_view found = word(what);
  std::int64_t value = 0;
  if (!parse_integer(found, value))
    fail(fmt::format("expected {} (an integer), found '{}'", what, shown(found)));
  return value;
}

double Cursor::text_real(const char* what) {
  const std::string_view found = word(what);
  double value = 0.0;
  if (!parse_real(found, value))
    fail(fmt::format("expected {} (a number), found '{}'", what, shown(found)));
  return value;
}

void Cursor::expect(std::string_view expected) {
  const std::string_view found = peek();
  start_ = position_;
  if (found != expected) {
    if (found.empty()) ended(fmt::format("'{}'", expected).c_str());
    fail(fmt::format("expected '{}', found '{}'", expected, shown(found)));
  }
  position_ += found.size();
}

std::int32_t Cursor::i32(const char* what) {
  if (binary_) return raw<std::int32_t>(what);
  const std::int64_t value = text_integer(what);
  if (value != static_cast<std::int32_t>(value))
    fail(fmt::format("{} {} is out of range, expected a 32-bit integer", what, value));
  return static_cast<std::int32_t>(value);
}

std::int64_t Cursor::i64(const char* what) {
  return binary_ ? raw<std::int64_t>(what) : text_integer(what);
}

double Cursor::f64(const char* what) {
  return binary_ ? raw<double>(what) : text_real(what);
}

double Cursor::finite(const char* what) {
  const double value = f64(what);
  if (!std::isfinite(value)) fail(fmt::format("{} is {}, expected a finite number", what, value));
  return value;
}

std::size_t Cursor::check_count(std::int64_t n, const char* what, std::size_t bytes_each) const {
  if (n < 0) fail(fmt::format("{} is {}, expected 0 or more", what, n));
  const std::size_t each = std::max<std::size_t>(bytes_each, 1);
  if (static_cast<std::uint64_t>(n) > remaining() / each + 1)
    fail(fmt::format("{} is {}, more than the {} bytes left in the file can hold", what, n,
                     remaining()));
  return static_cast<std::size_t>(n);
}

std::size_t Cursor::count(const char* what, std::size_t bytes_each, bool wide) {
  const std::int64_t n = wide ? i64(what) : i32(what);
  return check_count(n, what, bytes_each);
}

}  // namespace bezel::files
