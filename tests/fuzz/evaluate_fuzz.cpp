#include "tests/fuzz/evaluate_fuzz.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/exact.hpp"

namespace bezel::evaluate_fuzz {
namespace {

using namespace bernstein;
using Doubles = std::vector<double>;
using Span = std::span<const double>;

[[noreturn]] void broken(const std::string& what, Span b, double s) {
  std::ostringstream out;
  out << what << std::hexfloat << "; s = " << s << ", b = {";
  for (const double x : b) out << x << ", ";
  throw std::logic_error(out.str() + "}");
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

Dyadic absolute(const Dyadic& x) {
  return x.sign() < 0 ? -x : x;
}

/// The a-priori bound where it applies: in [0, 1], where nothing overflows. There p~ is the
/// polynomial with coefficients |b_j|.
void check_compensated(Span b, double s, int K, double value, const ExactPolynomial& polynomial,
                       const ExactPolynomial& absolute_polynomial) {
  if (s < 0.0 || s > 1.0) return;
  for (const double c : b)  // sums and products with their errors stay within the doubles
    if (std::fabs(c) > 0x1p+960) return;
  if (!std::isfinite(value)) broken("not finite", b, s);
  const Dyadic p = polynomial(Dyadic(s)), all = absolute_polynomial(Dyadic(s));
  // 2^-1040: fewer than 2^24 operations, each of which may lose 2^-1074 to underflow.
  const Dyadic multiplier(error_multiplier(static_cast<int>(b.size()) - 1, K));
  const Dyadic bound =
      (absolute(p).scaled(-53) + (multiplier * all).scaled(-53 * K)) * Dyadic(1.0 + 0x1p-40) +
      Dyadic(1.0).scaled(-1040);
  if (bound < absolute(Dyadic(value) - p)) broken("outside the a-priori bound", b, s);
}

void check_certified(Span b, double s, double value, double bound, const Dyadic& p) {
  if (std::isnan(value) || std::isnan(bound)) broken("not a number", b, s);
  if (std::isinf(value)) {
    const Dyadic beyond = absolute(p) - Dyadic(DBL_MAX);
    if (beyond.sign() <= 0 || p.sign() != (value > 0 ? 1 : -1) || !std::isinf(bound))
      broken("infinite", b, s);
    return;
  }
  if (std::isinf(bound)) broken("an infinite bound", b, s);
  const Dyadic error = Dyadic(value) - p;
  if (Dyadic(bound) < absolute(error)) broken("the error is larger than its bound", b, s);
  if (error.sign() == 0) return;
  const double other = std::nextafter(value, error.sign() < 0 ? HUGE_VAL : -HUGE_VAL);
  const bool around = std::isfinite(other) ? (Dyadic(other) - p).sign() == -error.sign()
                                           : std::isfinite(p.to_double());
  if (!around) broken("not faithful", b, s);
}

}  // namespace

void check_certified(Span b, double s, double value, double bound) {
  check_certified(b, s, value, bound, ExactPolynomial(b)(Dyadic(s)));
}

bool evaluate_bytes(std::span<const std::uint8_t> bytes) {
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? int{bytes[i]} : 0; };
  const int K = byte(0) % (max_precision + 3) - 1;        // -1 .. 21
  const int d = byte(1) % (max_interval_degree + 4) - 1;  // no coefficients .. degree 62
  const auto count = static_cast<std::size_t>(byte(2) % 20);
  Doubles b(static_cast<std::size_t>(d + 1)), s(count);
  std::size_t at = 3;
  const auto next = [&] {
    double x = 0.0;
    if (at < bytes.size()) std::memcpy(&x, &bytes[at], std::min(sizeof x, bytes.size() - at));
    at += sizeof x;
    return x;
  };
  for (double& x : b) x = next();
  for (double& x : s) x = next();
  bool accepted = true;
  const auto tried = [&](const auto& call) {
    try {
      call();
      return true;
    } catch (const InputError& error) {
      const std::string what = error.what();
      if (what.empty() || what.find('\n') != std::string::npos)
        throw std::logic_error("a message that is not one line: " + what);
      accepted = false;
      return false;
    }
  };
  Doubles value(count), bound(count), compensated(count);
  std::vector<Certificate> certificate(count);
  // An empty bound is one that is not wanted.
  const bool certified = tried([&] { evaluate_certified(b, s, value, bound, certificate); });
  const bool in_batch = tried([&] { evaluate_compensated(b, s, compensated, K); });
  if (!tried([&] { ExactPolynomial{Span(b)}; })) return false;
  Doubles sizes = b;
  for (double& x : sizes) x = std::fabs(x);
  const ExactPolynomial exact{Span(b)}, exact_sizes{Span(sizes)};
  for (std::size_t q = 0; q < count; ++q) {
    tried([&] {
      const CertifiedValue x = evaluate_certified(b, s[q]);
      check_certified(b, s[q], x.value, x.error_bound, exact(Dyadic(s[q])));
      if (certified && (!same(x.value, value[q]) || !same(x.error_bound, bound[q]) ||
                        x.certificate != certificate[q]))
        broken("other bits in a batch", b, s[q]);
    });
    if (q < 3)
      tried([&] {  // one by one they are slow at high K
        const double x = evaluate_compensated(Span(b), s[q], K);
        if (in_batch && K > 1 && !same(x, compensated[q]) && !std::isnan(x))
          broken("other bits in a batch, K > 1", b, s[q]);
        check_compensated(b, s[q], K, x, exact, exact_sizes);
        if (q == 0) evaluate_derivative_compensated(Span(b), s[q], K);
      });
  }
  return accepted;
}

}  // namespace bezel::evaluate_fuzz
