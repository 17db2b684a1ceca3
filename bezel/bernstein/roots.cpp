// Roots in [0, 1] by subdivision: sign variations of the coefficients bound the number of roots,
// splits are made where the value's sign is certain, and single roots are bracketed to neighbouring
// doubles.
//
// Everything is computed in double-double with a running bound of the error of every coefficient,
// so a sign counts only when it is certain. The coefficients given are taken as exact.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/numeric/binomial_kernel.hpp"
#include "bezel/numeric/double_double.hpp"

namespace bezel::bernstein {
namespace {

// r a + s b in double-double: two products (5 u^2 each) and a sum (3 u^2), r = 1 - s within u^2:
// below 9 u^2 (|r a| + |s b|); 16 u^2 covers the second order and the rounding of the bound itself.
constexpr double step_error = 16.0 * 0x1p-106;
constexpr double tiny = 0x1p-1000;  // covers underflow in products and their errors
constexpr int max_depth = 200;

struct Coefficient {
  DoubleDouble value;
  double error;  // |value - exact| <= error
  int sign() const { return std::fabs(value.hi) * 0.999 <= error ? 0 : value.hi > 0.0 ? 1 : -1; }
};
using Coefficients = std::vector<Coefficient>;

Coefficient combine(const DoubleDouble& r, const Coefficient& a, const DoubleDouble& s,
                    const Coefficient& b) {
  const DoubleDouble x = r * a.value, y = s * b.value;
  const double error =
      r.hi * a.error + s.hi * b.error + step_error * (std::fabs(x.hi) + std::fabs(y.hi));
  return {x + y, error == 0.0 ? 0.0 : error * (1.0 + 0x1p-48) + tiny};
}

std::pair<Coefficients, Coefficients> split(const Coefficients& c, double t) {
  const DoubleDouble s(t), r = DoubleDouble(1.0) - s;
  Coefficients left, right = c;
  for (std::size_t m = c.size(); m > 0; --m) {
    left.push_back(right[0]);
    for (std::size_t j = 0; j + 1 < m; ++j) right[j] = combine(r, right[j], s, right[j + 1]);
  }
  return {std::move(left), std::move(right)};
}

// The largest number of sign changes that uncertain signs allow.
int variations(const Coefficients& c) {
  constexpr int never = -1000;
  int plus = never, minus = never;  // most changes of a prefix whose last sign is + (-)
  for (const Coefficient& x : c) {
    const int sign = x.sign();
    if (x.error == 0.0 && x.value.hi == 0.0) continue;
    const int to_plus = sign < 0 ? never : std::max({0, plus, minus + 1});
    const int to_minus = sign > 0 ? never : std::max({0, minus, plus + 1});
    if (sign == 0) {  // it may also be zero and change nothing
      plus = std::max(plus, to_plus);
      minus = std::max(minus, to_minus);
    } else {
      plus = to_plus;
      minus = to_minus;
    }
  }
  return std::max({0, plus, minus});
}

// The polynomial on [lo, lo + width] of [0, 1]; the signs of its end coefficients are certain.
struct Piece {
  DoubleDouble lo, width;
  Coefficients c;
};

double clamp(double s) {
  return std::min(1.0, std::max(0.0, s));
}

class Finder {
 public:
  explicit Finder(Coefficients c) : whole_(std::move(c)) {}

  std::vector<Root> run() {
    search({DoubleDouble(0.0), DoubleDouble(1.0), whole_}, 0);
    return std::move(found_);
  }

 private:
  Coefficient value(double s) const {
    const WithError r = two_sum(1.0, -s);
    const DoubleDouble rr(r.value, r.error);
    Coefficients w = whole_;
    for (std::size_t m = w.size(); m > 1; --m)
      for (std::size_t j = 0; j + 1 < m; ++j) w[j] = combine(rr, w[j], DoubleDouble(s), w[j + 1]);
    return w[0];
  }

  void search(const Piece& piece, int depth) {
    const int count = variations(piece.c);
    if (count == 0) return;
    if (count == 1 && piece.c.front().sign() * piece.c.back().sign() < 0) {
      bracket(piece);
      return;
    }
    if (piece.width.hi > 0x1p-53 && depth < max_depth) {
      for (const double t : {0.5, 0.4375, 0.5625, 0.375, 0.625, 0.25, 0.75}) {
        auto [left, right] = split(piece.c, t);
        if (right.front().sign() == 0) continue;
        const DoubleDouble width = piece.width * DoubleDouble(t);
        search({piece.lo, width, std::move(left)}, depth + 1);
        search({piece.lo + width, piece.width - width, std::move(right)}, depth + 1);
        return;
      }
    }
    cluster(piece);
  }

  void cluster(const Piece& piece) {
    const DoubleDouble hi = piece.lo + piece.width;
    const double middle = (piece.lo + piece.width * DoubleDouble(0.5)).hi;
    found_.push_back({clamp(middle), clamp(std::nextafter(piece.lo.hi, -1.0)),
                      clamp(std::nextafter(hi.hi, 2.0)), true});
  }

  // One root in the piece: a bracket of doubles with certain, opposite signs, narrowed by secant
  // steps (Illinois variant) alternating with bisection.
  void bracket(const Piece& piece) {
    const int left_sign = piece.c.front().sign();
    double a = piece.lo.hi, b = (piece.lo + piece.width).hi;
    if ((piece.lo.lo != 0.0 && value(a).sign() != left_sign) ||
        ((piece.lo + piece.width).lo != 0.0 && value(b).sign() != -left_sign)) {
      cluster(piece);  // its ends are no doubles, and the root is closer to one than a double
      return;
    }
    DoubleDouble fa = piece.c.front().value, fb = piece.c.back().value;
    double wa = fa.hi, wb = fb.hi;
    for (int i = 0; i < 2200; ++i) {
      if (std::nextafter(a, 2.0) >= b) break;
      double x = a + (b - a) * 0.5;
      if (i % 3 != 2) {
        const double secant = a + (b - a) * (wa / (wa - wb));
        if (secant > a && secant < b) x = secant;
        // Step a little past the root, so that both ends close in.
        const double past = x + (i % 3 == 0 ? 2.0 : -2.0) * 0x1p-52 * x;
        if (past > a && past < b) x = past;
      }
      if (!(x > a && x < b)) break;
      const Coefficient f = value(x);
      const int sign = f.sign();
      if (sign == 0) {
        close_in(x, left_sign, a, b);
        found_.push_back({x, a, b, false});
        return;
      }
      if (sign == left_sign) {
        a = x, fa = f.value, wa = fa.hi, wb *= 0.5;
      } else {
        b = x, fb = f.value, wb = fb.hi, wa *= 0.5;
      }
    }
    const bool left_is_closer = std::fabs(fa.hi) < std::fabs(fb.hi);
    found_.push_back({left_is_closer ? a : b, a, b, false});
  }

  // The value at x is zero within its bound: the nearest points around it with certain signs.
  void close_in(double x, int left_sign, double& a, double& b) const {
    for (double step = x * 0x1p-53;; step *= 4.0) {
      const double y = std::min(x - step, std::nextafter(x, -1.0));
      if (y <= a) break;
      if (value(y).sign() == left_sign) {
        a = y;
        break;
      }
    }
    for (double step = x * 0x1p-52;; step *= 4.0) {
      const double y = std::max(x + step, std::nextafter(x, 2.0));
      if (y >= b) break;
      if (value(y).sign() == -left_sign) {
        b = y;
        break;
      }
    }
  }

  Coefficients whole_;
  std::vector<Root> found_;
};

}  // namespace

std::vector<Root> roots(std::span<const double> b) {
  const int d = checks::interval(b);
  int first = 0, last = d;
  while (first <= d && b[static_cast<std::size_t>(first)] == 0.0) ++first;
  if (first > d)
    throw InputError("the polynomial is zero everywhere, expected one with finitely many roots");
  while (b[static_cast<std::size_t>(last)] == 0.0) --last;

  // With `first` zeros in front and d - last behind, p = s^first (1-s)^(d-last) q; q has degree
  // last - first and the coefficients b_i C(d, i) / C(last - first, i - first). Scaled by the
  // largest, so that nothing over- or underflows on the way.
  double magnitude = 0.0;
  for (const double c : b) magnitude = std::max(magnitude, std::fabs(c));
  const int exponent = std::ilogb(magnitude);
  Coefficients c;
  for (int i = first; i <= last; ++i) {
    const double x = std::ldexp(b[static_cast<std::size_t>(i)], -exponent);
    if (first == 0 && last == d) {
      c.push_back({DoubleDouble(x), 0.0});
      continue;
    }
    using Table = bezel::kernel::Binomial<DoubleDouble>;
    const DoubleDouble q = DoubleDouble(x) * Table::get(d, i) / Table::get(last - first, i - first);
    c.push_back({q, std::fabs(q.hi) * 2.0 * step_error});
  }
  std::vector<Root> found;
  if (first > 0) found.push_back({0.0, 0.0, 0.0, first > 1});
  if (last > first) {
    const std::vector<Root> inner = Finder(std::move(c)).run();
    found.insert(found.end(), inner.begin(), inner.end());
  }
  if (last < d) found.push_back({1.0, 1.0, 1.0, d - last > 1});
  return found;
}

}  // namespace bezel::bernstein
