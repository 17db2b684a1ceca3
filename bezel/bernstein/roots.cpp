// Roots in [0, 1] by bisection: sign variations of the coefficients of a part bound its number of
// roots. Signs come from twice the working precision with an error bound, and from exact arithmetic
// where those cannot tell. docs/methods/newton.md derives every bound.

#include "bezel/bernstein/roots.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::bernstein {
namespace {

using short_names::infinity;
using short_names::u;

constexpr double tiny = 0x1p-1050;  // covers underflow: below 6 d^2 roundings of 2^-1075
constexpr int levels_below_doubles = 64;

double next_up(double s) {
  return std::nextafter(s, 2.0);
}
double next_down(double s) {
  return std::nextafter(s, -1.0);
}

// ---- Coefficients of a part, in twice the precision ----

struct Coefficient {
  DoubleDouble value;
  double error;  // |value - exact| <= error
  bool is_zero() const { return error == 0.0 && value.hi == 0.0; }
  // The last place of hi and all of lo are below 0.001 |hi|.
  int sign() const { return std::fabs(value.hi) * 0.999 <= error ? 0 : value.hi > 0.0 ? 1 : -1; }
};

// (a + b) / 2: the sum is within 3 u^2 of itself [joldes2017]; 4 u^2 covers the second order.
Coefficient middle(const Coefficient& a, const Coefficient& b) {
  const DoubleDouble sum = a.value + b.value;
  const double error =
      0.5 * ((a.error + b.error) * (1.0 + 0x1p-48) + 4.0 * u * u * std::fabs(sum.hi));
  const bool zero = a.is_zero() && b.is_zero();
  return {{0.5 * sum.hi, 0.5 * sum.lo}, zero ? 0.0 : error + tiny};
}

/// Number of sign changes and the outermost signs; zeros do not count.
struct Variations {
  int most;         // uncertain signs allow no more
  int first, last;  // 0 when uncertain
};

Variations variations(std::span<const Coefficient> c) {
  constexpr int never = -1000;
  int plus = never, minus = never;  // most changes of a prefix whose last sign is + (-)
  int first = 2, last = 0;
  for (const Coefficient& x : c) {
    if (x.is_zero()) continue;
    const int sign = x.sign();
    if (first == 2) first = sign;
    last = sign;
    const int to_plus = sign < 0 ? never : std::max({0, plus, minus + 1});
    const int to_minus = sign > 0 ? never : std::max({0, minus, plus + 1});
    // An uncertain one may also be zero and change nothing.
    plus = sign == 0 ? std::max(plus, to_plus) : to_plus;
    minus = sign == 0 ? std::max(minus, to_minus) : to_minus;
  }
  return {std::max({0, plus, minus}), first, last};
}

// ---- The same, exactly ----

using Exact = std::vector<Dyadic>;

Variations variations(const Exact& c) {
  Variations out{0, 0, 0};
  for (const Dyadic& x : c) {
    const int sign = x.sign();
    if (sign == 0) continue;
    if (out.first == 0) out.first = sign;
    if (out.last * sign < 0) ++out.most;
    out.last = sign;
  }
  return out;
}

int leading_zeros(const Exact& c) {
  int k = 0;
  while (c[static_cast<std::size_t>(k)].sign() == 0) ++k;
  return k;
}

/// Coefficients on [lo, hi], times hi^d.
Exact restrict_to(Exact c, double lo, double hi) {
  const std::size_t d = c.size() - 1;
  if (hi != 1.0) {
    const Dyadic s(hi), r = Dyadic(1.0) - s;
    for (std::size_t k = 1; k <= d; ++k)  // c[k..d] become level k; c[0..k-1] are done
      for (std::size_t j = d; j >= k; --j) c[j] = r * c[j - 1] + s * c[j];
  }
  if (lo != 0.0) {
    // Split at lo / hi with the weights hi - lo and lo: level k is hi^k times itself.
    const Dyadic s(lo), end(hi), r = end - s;
    for (std::size_t m = d; m > 0; --m)
      for (std::size_t j = 0; j < m; ++j) c[j] = r * c[j] + s * c[j + 1];
    Dyadic power(1.0);
    for (std::size_t j = 1; j <= d; ++j) c[j] *= (power *= end);
  }
  return c;
}

void round_to(std::span<Coefficient> out, const Exact& c) {
  std::int64_t exponent = std::numeric_limits<std::int64_t>::min();
  for (const Dyadic& x : c)
    if (x.sign() != 0) exponent = std::max(exponent, x.exponent());
  for (std::size_t j = 0; j < c.size(); ++j) {
    if (c[j].sign() == 0) {
      out[j] = {DoubleDouble(0.0), 0.0};
      continue;
    }
    const Dyadic x = c[j].scaled(-exponent);
    const double hi = x.to_double(), lo = (x - Dyadic(hi)).to_double();
    out[j] = {{hi, lo}, 2.0 * u * u * std::fabs(hi) + tiny};
  }
}

// ---- Signs of values ----

/// s = s0 + s1 and 1 - s = r0 + r1, up to u^2.
struct Parameter {
  double s0, s1, r0, r1;
};

Parameter at_double(double s) {
  const WithError r = two_sum(1.0, -s);
  return {s, 0.0, r.value, r.error};
}
Parameter at_middle(double lo, double hi) {
  const double half = 0.5 * (hi - lo);
  const WithError r = two_sum(1.0, -lo);
  const WithError rest = two_sum(r.value, r.error - half);
  return {lo, half, rest.value, rest.error};
}

class Signs {
 public:
  explicit Signs(std::span<const double> b) : b_(b), d_(static_cast<int>(b.size()) - 1) {
    for (const double x : b) largest_ = std::max(largest_, std::fabs(x));
    if (largest_ == 0.0) return;
    exponent_ = std::ilogb(largest_);
    largest_ = std::ldexp(largest_, -exponent_);
    for (std::size_t j = 0; j < b.size(); ++j) c_[j] = std::ldexp(b[j], -exponent_);
  }

  int degree() const { return d_; }
  /// The coefficients, scaled to a largest one between 1 and 2 (what is below 2^-1022 is rounded).
  std::span<const double> scaled() const { return {c_.data(), b_.size()}; }

  /// p / 2^exponent in two levels, with its sign when certain, else 0.
  struct Value {
    double value, compensation;
    int sign;
  };

  /// Compensated de Casteljau with s and 1 - s in two parts.
  Value value(const Parameter& p) {
    double a[2 * (max_interval_degree + 1)];
    const std::size_t n = b_.size();
    double *w = a, *e = a + n;
    for (std::size_t j = 0; j < n; ++j) {
      w[j] = c_[j];
      e[j] = 0.0;
    }
    for (std::size_t m = n - 1; m > 0; --m)
      for (std::size_t j = 0; j < m; ++j) {
        const WithError x = two_prod(p.r0, w[j]), y = two_prod(p.s0, w[j + 1]);
        const WithError sum = two_sum(x.value, y.value);
        e[j] = (((x.error + y.error) + sum.error) + (p.r1 * w[j] + p.s1 * w[j + 1])) +
               (p.r0 * e[j] + p.s0 * e[j + 1]);
        w[j] = sum.value;
      }
    const double v = w[0] + e[0];
    // At most (6 d^2 + 6 d) u^2 p~ to first order (docs/methods/newton.md).
    const double factor = 16.0 * d_ * d_ * u * u;
    bool certain = std::fabs(v) > 1.01 * (factor * largest_ + tiny);
    if (!certain) certain = std::fabs(v) > 1.01 * (factor * absolute(p.s0, p.r0) + tiny);
    return {w[0], e[0], !certain ? 0 : v > 0.0 ? 1 : -1};
  }

  int exact_sign(const Dyadic& s) {
    if (d_ != 1) return exact().sign(s);
    return (Dyadic(b_[0]) + s * (Dyadic(b_[1]) - Dyadic(b_[0]))).sign();
  }
  int sign(double s) {
    const int certain = value(at_double(s)).sign;
    return certain != 0 ? certain : exact_sign(Dyadic(s));
  }
  /// Halfway between neighbouring doubles.
  int sign_between(double lo, double hi) {
    if (lo >= 0x1p-1000) {
      const int certain = value(at_middle(lo, hi)).sign;
      if (certain != 0) return certain;
    }
    return exact_sign((Dyadic(lo) + Dyadic(hi)).scaled(-1));
  }

  const ExactPolynomial& exact() {
    if (!exact_) exact_.emplace(b_);
    return *exact_;
  }

  /// root_condition.
  double condition(double s) {
    if (s == 0.0 || d_ == 0) return infinity;
    // p' = d times the value of the differences, plain: each level adds 3 roundings, each
    // difference one.
    double w[max_interval_degree + 1], z[max_interval_degree + 1];
    for (int j = 0; j < d_; ++j) {
      w[j] = c_[static_cast<std::size_t>(j) + 1] - c_[static_cast<std::size_t>(j)];
      z[j] = std::fabs(w[j]);
    }
    const double r = 1.0 - s;
    for (int m = d_ - 1; m > 0; --m) {
      kernel::step(w, m, r, s);
      kernel::step(z, m, std::fabs(r), std::fabs(s));
    }
    const double sum = absolute(std::fabs(s), std::fabs(r)) / std::fabs(s);
    if (std::isfinite(z[0]) && std::fabs(w[0]) >= 0x1p21 * (4.0 * d_ * u * z[0] + tiny))
      return sum / (d_ * std::fabs(w[0]));
    const Dyadic slope = exact().derivative()(Dyadic(s));
    if (slope.sign() == 0) return infinity;
    const std::int64_t e = slope.exponent();
    const double mantissa = slope.scaled(-e).to_double();
    return std::ldexp(sum / std::fabs(mantissa), static_cast<int>(exponent_ - e));
  }

 private:
  double absolute(double s, double r) const {
    double w[max_interval_degree + 1];
    for (std::size_t j = 0; j < b_.size(); ++j) w[j] = std::fabs(c_[j]);
    for (int m = d_; m > 0; --m) kernel::step(w, m, r, s);
    return w[0];
  }

  std::span<const double> b_;
  int d_;
  double largest_ = 0.0;
  std::array<double, max_interval_degree + 1> c_{};
  int exponent_ = 0;
  std::optional<ExactPolynomial> exact_;
};

// ---- The search ----

class Finder {
 public:
  explicit Finder(std::span<const double> b) : b_(b), signs_(b), n_(b.size()) {}

  std::vector<Root> run() {
    parts_.resize(8 * n_);
    int first = 0, last = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      const double c = signs_.scaled()[j];
      // Scaling by a power of two is exact unless it underflows.
      const bool exact = c == 0.0 ? b_[j] == 0.0 : std::fabs(c) >= 0x1p-1022;
      parts_[j] = {DoubleDouble(c), exact ? 0.0 : tiny};
    }
    while (b_[static_cast<std::size_t>(first)] == 0.0) ++first;
    while (b_[n_ - 1 - static_cast<std::size_t>(last)] == 0.0) ++last;
    if (first > 0) found_at(0.0, first);
    if (n_ > 1) search();
    if (last > 0) found_at(1.0, last);
    return std::move(found_);
  }

 private:
  std::span<Coefficient> part(std::size_t index) { return {parts_.data() + index * n_, n_}; }

  void found_at(double s, int multiplicity) {
    const bool simple = multiplicity == 1;
    found_.push_back(
        {s, s, s, !simple, multiplicity, multiplicity, simple ? signs_.condition(s) : infinity});
  }
  void found_simple(double s, double lo, double hi) {
    found_.push_back({s, lo, hi, false, 1, 1, signs_.condition(s)});
  }

  /// A part (lo, hi) whose roots are still to be found, in its turn from left to right: the at-th
  /// has its coefficients in part(at), and exactly in `exact` unless that is empty. Every part is a
  /// binary fraction of [0, 1], so lo, hi, and the middle of lo and hi are doubles until lo and hi
  /// are neighbours.
  struct Open {
    double lo, hi;
    Exact exact;
    int zeros_at_lo;  // multiplicity of a root at lo, to be reported first
  };

  void search() {
    // Not by recursion: near 0 there are a thousand levels.
    std::vector<Open> open;
    open.push_back({0.0, 1.0, {}, 0});
    while (!open.empty()) {
      const std::size_t at = open.size() - 1;
      if (open[at].zeros_at_lo > 0) found_at(open[at].lo, open[at].zeros_at_lo);
      open[at].zeros_at_lo = 0;
      std::optional<Open> left = step(open[at], at);
      if (!left) {
        open.pop_back();
      } else if (left->lo < left->hi) {
        open.push_back(std::move(*left));
      }
    }
  }

  /// Settles a part (nothing returned), or makes it its right half and returns the left one, whose
  /// coefficients are then in part(at + 1), or an empty interval when there is more to do at once.
  std::optional<Open> step(Open& p, std::size_t at) {
    const bool smallest = next_up(p.lo) >= p.hi;
    const double mid = p.lo + 0.5 * (p.hi - p.lo);
    const Variations v = p.exact.empty() ? variations(part(at)) : variations(p.exact);
    if (v.most == 0) return {};
    if (v.most == 1 && v.first * v.last < 0) {
      bracket(p.lo, p.hi, v.first, part(at));
      return {};
    }
    if (parts_.size() < (at + 2) * n_) parts_.resize(2 * parts_.size());
    if (!smallest && bisect_doubled(at)) {
      p.exact.clear();
      return Open{std::exchange(p.lo, mid), mid, {}, 0};
    }
    if (p.exact.empty()) {
      p.exact = restrict_to(
          Exact(signs_.exact().coefficients().begin(), signs_.exact().coefficients().end()), p.lo,
          p.hi);
      round_to(part(at), p.exact);
      return Open{p.lo, p.lo, {}, 0};  // now the variations are known exactly
    }
    if (smallest) {
      search_below(p.lo, p.hi, p.lo, std::move(p.exact), 0);
      return {};
    }
    Exact left = bisect_exactly(p.exact);
    p.zeros_at_lo = leading_zeros(p.exact);
    round_to(part(at + 1), left);
    round_to(part(at), p.exact);
    return Open{std::exchange(p.lo, mid), mid, std::move(left), 0};
  }

  /// Bisects part(at): the right half stays there, the left one goes to part(at + 1). False when
  /// the sign in the middle is uncertain; then both are spoilt.
  bool bisect_doubled(std::size_t at) {
    const std::span<Coefficient> c = part(at), left = part(at + 1);
    left[0] = c[0];
    for (std::size_t m = n_ - 1; m > 0; --m) {
      for (std::size_t j = 0; j < m; ++j) c[j] = middle(c[j], c[j + 1]);
      left[n_ - m] = c[0];
    }
    return c[0].sign() != 0;
  }

  /// Neighbouring doubles lo and hi, and several variations between: goes on exactly. `half` is lo
  /// or hi, whichever is nearer to the part (level 0: unused).
  void search_below(double lo, double hi, double half, Exact exact, int level) {
    const int count = variations(exact).most;
    if (count == 0) return;
    if (count == 1) {
      found_simple(half, lo, hi);
      return;
    }
    if (level == levels_below_doubles) {
      found_.push_back({half, lo, hi, true, count % 2, count, infinity});
      return;
    }
    Exact left = bisect_exactly(exact);
    const int zeros = leading_zeros(exact);
    search_below(lo, hi, level == 0 ? lo : half, std::move(left), level + 1);
    if (zeros == 1) found_simple(half, lo, hi);
    if (zeros > 1) found_.push_back({half, lo, hi, true, zeros, zeros, infinity});
    search_below(lo, hi, level == 0 ? hi : half, std::move(exact), level + 1);
  }

  /// One simple root in (lo, hi); left_sign is the sign of p between lo and it.
  void bracket(double lo, double hi, int left_sign, std::span<const Coefficient> c) {
    double x = lo + (hi - lo) * local_root(c, left_sign);
    // Newton's method with the value in twice the precision; then two signs prove the result.
    int sign = 0;
    for (int i = 0; i < 5 && x > lo && x < hi; ++i) {
      const Signs::Value p = signs_.value(at_double(x));
      const double slope =
          kernel::evaluate_derivative_unchecked(signs_.degree(), signs_.scaled().data(), x)
              .derivative;
      const double next = x - (p.value + p.compensation) / slope;
      sign = p.sign;
      if (!(next > lo && next < hi) || next == x) break;
      sign = 0;
      const bool settled = std::fabs(next - x) <= 0x1p-50 * x;
      x = next;
      if (settled) break;
    }
    bool from_lo = true;
    if (x > lo && x < hi) {
      if (sign == 0) sign = signs_.sign(x);
      if (sign == 0) {
        found_at(x, 1);
        return;
      }
      from_lo = sign == left_sign;
      const double other = from_lo ? next_up(x) : next_down(x);
      (from_lo ? lo : hi) = x;
      const auto crossed = [&](int s_between) { return (s_between == left_sign) != from_lo; };
      if (other > lo && other < hi &&
          crossed(signs_.sign_between(from_lo ? x : other, from_lo ? other : x))) {
        // Between x and halfway to its neighbour.
        found_simple(x, from_lo ? x : other, from_lo ? other : x);
        return;
      }
    }
    narrow(lo, hi, left_sign, from_lo);
  }

  /// A root of the part, roughly, in its own parameter: Newton's method kept between the signs.
  double local_root(std::span<const Coefficient> c, int left_sign) const {
    double w[max_interval_degree + 1], a = 0.0, b = 1.0;
    for (std::size_t j = 0; j < n_; ++j) w[j] = c[j].value.hi;
    double t = w[0] / (w[0] - w[n_ - 1]);
    if (!(t > 0.0 && t < 1.0)) t = 0.5;
    for (int i = 0; i < 8; ++i) {
      const auto [value, slope] = kernel::evaluate_derivative_unchecked(signs_.degree(), w, t);
      if (value == 0.0) break;
      ((value > 0.0) == (left_sign > 0) ? a : b) = t;
      double next = t - value / slope;
      if (!(next > a && next < b)) next = a + 0.5 * (b - a);
      const bool settled = std::fabs(next - t) <= 1e-12 * t;
      t = next;
      if (settled) break;
    }
    return t;
  }

  /// The root in (lo, hi) to neighbouring doubles: in growing steps away from lo (or hi), then
  /// bisecting the doubles between, counted.
  void narrow(double lo, double hi, int left_sign, bool from_lo) {
    auto a = std::bit_cast<std::int64_t>(lo), b = std::bit_cast<std::int64_t>(hi);
    bool stride = true;
    for (std::int64_t step = 1; b - a > 1;) {
      stride = stride && step < b - a;
      const std::int64_t k = !stride ? a + (b - a) / 2 : from_lo ? a + step : b - step;
      const auto x = std::bit_cast<double>(k);
      const int sign = signs_.sign(x);
      if (sign == 0) {
        found_at(x, 1);
        return;
      }
      (sign == left_sign ? a : b) = k;
      stride = stride && (sign == left_sign) == from_lo;
      if (stride) step = step < (b - a) / 8 ? 8 * step : b - a;
    }
    lo = std::bit_cast<double>(a);
    hi = std::bit_cast<double>(b);
    found_simple(signs_.sign_between(lo, hi) == left_sign ? hi : lo, lo, hi);
  }

  std::span<const double> b_;
  Signs signs_;
  std::size_t n_;
  std::vector<Coefficient> parts_;  // one part of n_ coefficients per level of the search
  std::vector<Root> found_;
};

}  // namespace

std::vector<Root> roots(std::span<const double> b) {
  checks::interval(b);
  if (std::all_of(b.begin(), b.end(), [](double c) { return c == 0.0; }))
    throw InputError("the polynomial is zero everywhere, expected one with finitely many roots");
  return Finder(b).run();
}

double root_condition(std::span<const double> b, double alpha) {
  checks::interval(b);
  checks::finite(alpha, "root");
  return Signs(b).condition(alpha);
}

}  // namespace bezel::bernstein
