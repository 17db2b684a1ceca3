#include "bezel/numeric/ratio.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace bezel {
namespace {

Dyadic magnitude(const Dyadic& x) {
  return x.sign() < 0 ? -x : x;
}

/// x 2^-exponent, in [1, 2) for x > 0, rounded.
double leading(const Dyadic& x) {
  return x.scaled(-x.exponent()).to_double();
}

}  // namespace

int compare(const Ratio& a, const Ratio& b) {
  return (a.num * b.den - b.num * a.den).sign();
}

double quotient(const Dyadic& numerator, const Dyadic& denominator) {
  if (numerator.sign() == 0) return 0.0;
  const std::int64_t exponent = numerator.exponent() - denominator.exponent();
  if (exponent > 1100)
    return numerator.sign() * denominator.sign() * std::numeric_limits<double>::infinity();
  if (exponent < -1100) return 0.0;
  return std::ldexp(leading(numerator) / leading(denominator), static_cast<int>(exponent));
}

double to_double(const Ratio& a) {
  const double near = quotient(a.num, a.den);
  if (near == 0.0 || !std::isfinite(near)) return near;
  const double infinity = std::numeric_limits<double>::infinity();
  // The quotient is off by two units in the last place at most.
  double candidate = near;
  for (int i = 0; i < 3; ++i) candidate = std::nextafter(candidate, -infinity);
  double best = candidate;
  Dyadic distance = magnitude(a.num - Dyadic(candidate) * a.den);
  for (int i = 0; i < 6; ++i) {
    candidate = std::nextafter(candidate, infinity);
    if (!std::isfinite(candidate)) continue;
    const Dyadic next = magnitude(a.num - Dyadic(candidate) * a.den);
    const int sign = (next - distance).sign();
    const auto even = [](double x) {
      int exponent = 0;
      return std::fmod(std::ldexp(std::frexp(x, &exponent), 53), 2.0) == 0.0;
    };
    if (sign < 0 || (sign == 0 && even(candidate))) {
      best = candidate;
      distance = next;
    }
  }
  return best;
}

Dyadic floor_quotient(const Dyadic& dividend, const Dyadic& divisor) {
  Dyadic q, rest = dividend;
  while (!(rest < divisor)) {
    const std::int64_t shift = rest.exponent() - divisor.exponent();
    // Not above the true quotient.
    const double f = leading(rest) / leading(divisor) * (1.0 - 0x1p-50);
    Dyadic part = shift <= 50 ? Dyadic(std::floor(std::ldexp(f, static_cast<int>(shift))))
                              : Dyadic(std::floor(std::ldexp(f, 50))).scaled(shift - 50);
    if (part.sign() == 0) part = Dyadic(1.0);
    rest -= part * divisor;
    q += part;
  }
  return q;
}

std::optional<Ratio> simplest_between(const Dyadic& lo, const Dyadic& hi, int max_bits) {
  Dyadic ln = lo, ld = 1.0, hn = hi, hd = 1.0;
  std::vector<Dyadic> quotients;
  int bits = 0;
  Dyadic last;
  for (;;) {
    const Dyadic q = floor_quotient(ln, ld);
    Dyadic rest = ln - q * ld;
    if (rest.sign() == 0) {
      last = q;
      break;
    }
    const Dyadic next = q + Dyadic(1.0);
    if (!(hn < next * hd)) {
      last = next;
      break;
    }
    // The denominator grows at least by the product of the quotients.
    bits += static_cast<int>(q.exponent());
    if (bits > max_bits || quotients.size() > 2U * static_cast<unsigned>(max_bits))
      return std::nullopt;
    quotients.push_back(q);
    // [lo, hi] becomes [1 / (hi - q), 1 / (lo - q)].
    Dyadic upper_rest = hn - q * hd;
    ln = std::move(hd);
    hn = std::move(ld);
    ld = std::move(upper_rest);
    hd = std::move(rest);
  }
  Ratio out{last, Dyadic(1.0)};
  for (std::size_t i = quotients.size(); i-- > 0;) {
    Dyadic num = quotients[i] * out.num + out.den;
    out.den = std::exchange(out.num, std::move(num));
  }
  if (out.den.exponent() > max_bits) return std::nullopt;
  return out;
}

}  // namespace bezel
