#pragma once
// Internal: values in bytes, for another process of the same program.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"

namespace bezel::detail {

/// Writes values one after the other, in the machine's own representation.
class MessageWriter {
 public:
  template <class T>
  void value(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&x, sizeof x);
  }
  template <class T>
  void list(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }
  template <class T>
  void list(const std::vector<T>& values) {
    list(std::span<const T>(values));
  }
  void text(std::string_view s) { list(std::span<const char>(s)); }

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, from, size);
  }
  std::vector<std::byte> bytes_;
};

/// Reads them back in the same order.
/// @throws InternalError when the message ends too early
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T x;
    copy(&x, sizeof x);
    return x;
  }
  template <class T>
  std::vector<T> list() {
    const auto size = value<std::uint64_t>();
    if (size > rest_.size() / sizeof(T)) fail();
    std::vector<T> values(static_cast<std::size_t>(size));
    copy(values.data(), values.size() * sizeof(T));
    return values;
  }
  std::string text() {
    const std::vector<char> letters = list<char>();
    return {letters.begin(), letters.end()};
  }
  bool at_end() const { return rest_.empty(); }

 private:
  [[noreturn]] static void fail() {
    throw InternalError("a message of another process ends early");
  }
  void copy(void* to, std::size_t size) {
    if (size > rest_.size()) fail();
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const std::byte> rest_;
};

}  // namespace bezel::detail
