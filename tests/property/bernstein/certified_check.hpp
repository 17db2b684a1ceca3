#pragma once
// Everything that is promised of a certified value, against the exact one.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "bezel/bernstein/certified.hpp"
#include "support/exact_values.hpp"

namespace support {

using bezel::bernstein::Certificate;
using bezel::bernstein::CertifiedValue;

inline std::string described(const std::vector<double>& b, double s) {
  std::ostringstream out;
  out << std::hexfloat << "s = " << s << ", b = {";
  for (const double x : b) out << x << ", ";
  out << "}";
  return out.str();
}

/// The largest error bound allowed: 1.6 u |value|, of exact arithmetic half an ulp rounded up.
inline double largest_bound(const CertifiedValue& x) {
  if (std::isinf(x.value)) return HUGE_VAL;
  const double size = std::fabs(x.value);
  if (x.certificate != Certificate::exact) return 1.6 * 0x1p-53 * size;
  const double above = std::nextafter(size, HUGE_VAL);
  const double ulp = std::isinf(above) ? 0x1p971 : above - size;
  return std::nextafter(0.5 * ulp, HUGE_VAL);
}

/// What is wrong with x as the value p; empty when nothing is.
inline std::string complaint(const CertifiedValue& x, const Number& p) {
  std::string wrong;
  const auto unless = [&](bool good, const char* what) {
    if (!good) wrong += wrong.empty() ? what : std::string(", ") + what;
  };
  const bool exact = x.certificate == Certificate::exact;
  unless(is_faithful(x.value, p), "not faithful");
  unless(is_bound(x.value, x.error_bound, p), "the error is larger than its bound");
  unless(std::isinf(x.value) == std::isinf(x.error_bound), "only one of value and bound infinite");
  unless(x.error_bound <= largest_bound(x), "the bound is larger than promised");
  unless(p.sign() != 0 || x.error_bound == 0.0, "a zero that is not proven");
  unless(!exact || is_nearest(x.value, p), "exact but not the nearest double");
  unless(exact || x.certificate == Certificate::doubled || x.certificate == Certificate::tripled ||
             x.certificate == Certificate::quadrupled,
         "no certificate");
  if (wrong.empty()) return wrong;
  std::ostringstream out;
  out << wrong << std::hexfloat << ": value " << x.value << ", bound " << x.error_bound
      << ", certificate " << static_cast<int>(x.certificate);
  return out.str();
}

/// Batch evaluation into an array of structures.
inline std::vector<CertifiedValue> certified_batch(std::span<const double> b,
                                                   std::span<const double> s) {
  std::vector<double> value(s.size()), bound(s.size());
  std::vector<Certificate> certificate(s.size());
  bezel::bernstein::evaluate_certified(b, s, value, bound, certificate);
  std::vector<CertifiedValue> out(s.size());
  for (std::size_t q = 0; q < s.size(); ++q) out[q] = {value[q], bound[q], certificate[q]};
  return out;
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const CertifiedValue& a, const CertifiedValue& b) {
  return same_bits(a.value, b.value) && same_bits(a.error_bound, b.error_bound) &&
         a.certificate == b.certificate;
}

}  // namespace support
