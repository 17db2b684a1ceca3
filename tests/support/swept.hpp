#pragma once
// How far tests sweep over widths, angles and degrees.

#include <initializer_list>
#include <vector>

namespace bezel::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

/// All values; the last one only under sanitizers, which look at accesses and not at digits and
/// take thirty times as long.
template <class T>
std::vector<T> swept(std::initializer_list<T> values) {
  return sanitized ? std::vector<T>{*(values.end() - 1)} : std::vector<T>(values);
}

}  // namespace bezel::test
