#pragma once
// The truth about two plane Bezier curves, by elimination in exact integers: a second method,
// independent of Bezel's kernels.
//
// With a(s) - b(t) = 0 as two polynomials in s, their Bezout matrix B(t) has determinant R(t),
// whose roots are the parameters t of all common points, also of those with complex s. Where B has
// rank one less than its size, its kernel is (1, s, s^2, ...): s is unique, real, and the quotient
// of two entries of the adjugate, that is of two polynomials in t. Where the rank is lower, b
// passes through a multiple point or cusp of a; then the same with the curves exchanged. R = 0
// means that both lie on one algebraic curve; an affine change of parameter is divided out then.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/exact_roots.hpp"

namespace support {

/// A common point with parameters in [0, 1]: alone in [s_lo, s_hi] x [t_lo, t_hi].
struct CommonPoint {
  mpq_class s_lo, s_hi, t_lo, t_hi;  ///< equal when known exactly, else at most 2^-80 wide
  /// Order of contact of the two branches: 1 transversal, 2 touching, ...; 0: the two are parts of
  /// one curve, or one of them is a point
  int multiplicity;
  bool smooth;        ///< neither curve has a vanishing derivative there
  bool s_end, t_end;  ///< the parameter is 0 or 1 exactly
  int sign;           ///< of cross(a', b') when transversal and smooth, else 0
  double condition;   ///< largest |coordinate| / (slower speed * sine), infinite when not simple
  double s() const { return mpq_class((s_lo + s_hi) / 2).get_d(); }
  double t() const { return mpq_class((t_lo + t_hi) / 2).get_d(); }
};
struct CommonInterval {
  mpq_class s0, s1, t0, t1;  ///< s0 < s1; b(t0) = a(s0), b(t1) = a(s1)
};
struct CommonParts {
  /// False: a multiple point of one meets a multiple point of the other, or parts coincide under a
  /// change of parameter that is not affine. Nothing else is then filled in.
  bool decided = true;
  std::vector<CommonPoint> points;        ///< ascending s
  std::vector<CommonInterval> intervals;  ///< ascending s
};

using RationalPoint = std::array<mpq_class, 2>;

namespace curve_oracle_detail {

/// sum f[i](t) s^i and the same for g; the leading coefficients of s are constants, not both 0.
struct System {
  std::vector<Polynomial> f, g;
};
struct PlanePolynomial {
  std::array<Polynomial, 2> c;  // by coordinate, not trimmed: size degree + 1
  std::size_t degree() const { return c[0].size() - 1; }
};

inline mpz_class determinant(std::vector<std::vector<mpz_class>> m) {
  const std::size_t n = m.size();
  if (n == 0) return 1;
  mpz_class before = 1;
  bool negative = false;
  for (std::size_t k = 0; k + 1 < n; ++k) {  // Bareiss: all divisions are exact
    std::size_t pivot = k;
    while (pivot < n && m[pivot][k] == 0) ++pivot;
    if (pivot == n) return 0;
    if (pivot != k) {
      std::swap(m[pivot], m[k]);
      negative = !negative;
    }
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = k + 1; j < n; ++j) {
        mpz_class x = m[i][j] * m[k][k] - m[i][k] * m[k][j];
        mpz_divexact(m[i][j].get_mpz_t(), x.get_mpz_t(), before.get_mpz_t());
      }
    before = m[k][k];
  }
  return negative ? mpz_class(-m[n - 1][n - 1]) : m[n - 1][n - 1];
}

/// The polynomial with values y[k] at first + k, of degree below y.size() and with integer
/// coefficients.
inline Polynomial interpolate(std::vector<mpz_class> y, long first) {
  const std::size_t n = y.size();
  for (std::size_t k = 1; k < n; ++k)
    for (std::size_t i = n; i-- > k;) y[i] -= y[i - 1];
  // sum of y[k] / k! (t - first) ... (t - first - k + 1), times (n - 1)!.
  mpz_class factorial = 1;
  for (std::size_t k = n; k-- > 0;) {
    y[k] *= factorial;
    factorial *= static_cast<unsigned long>(std::max<std::size_t>(k, 1));
  }
  Polynomial p{y[n - 1]};
  for (std::size_t k = n - 1; k-- > 0;) {
    const long root = first + static_cast<long>(k);
    p.insert(p.begin(), mpz_class(0));
    for (std::size_t i = 0; i + 1 < p.size(); ++i) p[i] -= root * p[i + 1];
    p[0] += y[k];
  }
  for (mpz_class& x : p) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), factorial.get_mpz_t());
  trim(p);
  return p;
}

struct Elimination {
  Polynomial resultant, numerator, denominator;  // s = numerator / denominator
};

/// @param degree  bound of the degrees in t
inline Elimination eliminate(const System& system, std::size_t degree) {
  const std::size_t m = system.f.size() - 1;
  std::vector<mpz_class> r, p, q;
  const long first = -static_cast<long>(degree / 2);
  for (std::size_t k = 0; k <= degree; ++k) {
    const mpz_class t = first + static_cast<long>(k);
    std::vector<mpz_class> f, g;
    for (const Polynomial& c : system.f) f.push_back(scaled_value(c, t, 0));
    for (const Polynomial& c : system.g) g.push_back(scaled_value(c, t, 0));
    std::vector<std::vector<mpz_class>> bezout(m, std::vector<mpz_class>(m));
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) {
        bezout[i][j] = f[j + 1] * g[i] - f[i] * g[j + 1];
        if (i > 0 && j + 1 < m) bezout[i][j] += bezout[i - 1][j + 1];
      }
    // Entries 0 and 1 of the adjugate's first row.
    const auto minor = [&](std::size_t column) {
      std::vector<std::vector<mpz_class>> out;
      for (std::size_t i = 1; i < m; ++i) {
        out.push_back(bezout[i]);
        out.back().erase(out.back().begin() + static_cast<std::ptrdiff_t>(column));
      }
      return determinant(std::move(out));
    };
    r.push_back(determinant(bezout));
    if (m > 1) {
      q.push_back(minor(0));
      p.push_back(-minor(1));
    } else {
      const bool by_f = f[1] != 0;
      q.push_back(by_f ? f[1] : g[1]);
      p.push_back(by_f ? -f[0] : -g[0]);
    }
  }
  return {interpolate(std::move(r), first), interpolate(std::move(p), first),
          interpolate(std::move(q), first)};
}

struct Solution {
  RealRoot t;
  mpq_class s_lo, s_hi;
  int multiplicity;
};
struct Solutions {
  bool common_component = false;
  std::vector<Solution> found;
  std::vector<RealRoot> singular;  // t where s is not unique
};

/// All solutions in [0, 1]^2 where s is unique to t.
inline Solutions solve(const System& system, std::size_t degree) {
  Solutions out;
  const Elimination e = eliminate(system, degree);
  if (e.resultant.empty()) {
    out.common_component = true;
    return out;
  }
  const Polynomial beyond = difference(e.denominator, e.numerator);
  int multiplicity = 0;
  for (const Polynomial& factor : squarefree_factors(primitive(e.resultant))) {
    ++multiplicity;
    for (RealRoot root : roots_in_unit_interval(factor)) {
      const int scale = root.sign(e.denominator);
      if (scale == 0) {
        root.refine(160);
        out.singular.push_back(root);
        continue;
      }
      const int low = scale * root.sign(e.numerator), high = scale * root.sign(beyond);
      if (low < 0 || high < 0) continue;
      mpq_class s_lo = 0, s_hi = 0;
      root.refine(112);
      if (high == 0) s_lo = s_hi = 1;
      mpq_class width = 1;
      mpq_div_2exp(width.get_mpq_t(), width.get_mpq_t(), 80);
      if (low > 0 && high > 0)
        for (unsigned long bits = 128;; bits += 64) {
          const auto n = root.range(e.numerator), d = root.range(e.denominator);
          if (sgn(d.first) * sgn(d.second) > 0) {
            const mpq_class quotients[] = {n.first / d.first, n.first / d.second,
                                           n.second / d.first, n.second / d.second};
            s_lo = *std::min_element(quotients, quotients + 4);
            s_hi = *std::max_element(quotients, quotients + 4);
            if (s_hi - s_lo <= width) break;
          }
          root.refine(bits);
        }
      out.found.push_back({root, s_lo, s_hi, multiplicity});
    }
  }
  return out;
}

/// a(s) - b(t), for the elimination of s. @pre the degree of a is at least 1
inline System meeting(const PlanePolynomial& a, const PlanePolynomial& b) {
  const auto one = [&](std::size_t k) {
    std::vector<Polynomial> f;
    for (const mpz_class& x : a.c[k]) f.push_back(x == 0 ? Polynomial{} : Polynomial{x});
    f[0] = difference(a.c[k][0] == 0 ? Polynomial{} : Polynomial{a.c[k][0]}, b.c[k]);
    return f;
  };
  return {one(0), one(1)};
}

inline mpq_class value(const Polynomial& p, const mpq_class& x) {
  mpq_class h = 0;
  for (std::size_t i = p.size(); i-- > 0;) h = h * x + p[i];
  return h;
}
/// Bound of |p'| on [0, 1].
inline mpz_class slope(const Polynomial& p) {
  mpz_class out = 0;
  for (std::size_t i = 1; i < p.size(); ++i) out += abs(p[i]) * static_cast<unsigned long>(i);
  return out;
}

/// a(s) = b(t) is impossible on the box.
inline bool apart(const PlanePolynomial& a, const PlanePolynomial& b, const RealRoot& s,
                  const RealRoot& t) {
  for (std::size_t k = 0; k < 2; ++k) {
    const auto x = s.range(a.c[k]), y = t.range(b.c[k]);
    if (x.first > y.second || y.first > x.second) return true;
  }
  return false;
}

inline bool is_end(const mpq_class& lo, const mpq_class& hi) {
  return lo == hi && (lo == 0 || lo == 1);
}

/// Common factor of the two coordinates' derivatives: its roots are the singular parameters.
inline Polynomial singular_parameters(const PlanePolynomial& a) {
  return common_divisor(derivative(a.c[0]), derivative(a.c[1]));
}
/// The derivative vanishes somewhere in [lo, hi], which holds one parameter of interest.
inline bool vanishes_within(const Polynomial& g, const mpq_class& lo, const mpq_class& hi) {
  if (g.size() <= 1) return g.empty();
  for (const Polynomial& factor : squarefree_factors(g))
    for (RealRoot& root : roots_in_unit_interval(factor)) {
      root.refine(80);
      if (root.lo() <= hi && lo <= root.hi()) return true;
    }
  return false;
}

/// Sign, condition, smoothness from the box.
inline void describe(const PlanePolynomial& a, const PlanePolynomial& b, const mpq_class& magnitude,
                     CommonPoint& p) {
  p.s_end = is_end(p.s_lo, p.s_hi);
  p.t_end = is_end(p.t_lo, p.t_hi);
  p.smooth = !vanishes_within(singular_parameters(a), p.s_lo, p.s_hi) &&
             !vanishes_within(singular_parameters(b), p.t_lo, p.t_hi);
  p.sign = 0;
  p.condition = HUGE_VAL;
  if (!p.smooth || p.multiplicity != 1) return;
  const mpq_class s = (p.s_lo + p.s_hi) / 2, t = (p.t_lo + p.t_hi) / 2;
  const Polynomial ax = derivative(a.c[0]), ay = derivative(a.c[1]);
  const Polynomial bx = derivative(b.c[0]), by = derivative(b.c[1]);
  const mpq_class x = value(ax, s), y = value(ay, s), u = value(bx, t), v = value(by, t);
  const mpq_class ds = p.s_hi - p.s_lo, dt = p.t_hi - p.t_lo, turn = x * v - y * u;
  const mpq_class ex = slope(ax) * ds, ey = slope(ay) * ds, eu = slope(bx) * dt,
                  ev = slope(by) * dt;
  const mpq_class error = abs(x) * ev + abs(v) * ex + ex * ev + abs(y) * eu + abs(u) * ey + ey * eu;
  if (abs(turn) > error) p.sign = sgn(turn);
  // Numbers may be far beyond the range of doubles: quotients first.
  const mpq_class size = std::max(abs(x), abs(y)), other = std::max(abs(u), abs(v));
  if (size == 0 || other == 0) return;
  const auto ratio = [](const mpq_class& p1, const mpq_class& q1) {
    return mpq_class(p1 / q1).get_d();
  };
  const double la = std::hypot(ratio(x, size), ratio(y, size));
  const double lb = std::hypot(ratio(u, other), ratio(v, other));
  const double sine = std::fabs(ratio(turn, size * other)) / (la * lb);
  const double slower = std::min(la, lb * ratio(other, size));
  if (magnitude > 0) p.condition = ratio(magnitude, size) / (slower * sine);
}

/// beta with beta^m = ratio, when it is rational; the positive one when m is even.
inline std::optional<mpq_class> rational_root(const mpq_class& ratio, std::size_t m) {
  if (ratio == 0 || (m % 2 == 0 && ratio < 0)) return std::nullopt;
  mpz_class n, d;
  const mpz_class numerator = ratio.get_num(), denominator = ratio.get_den();
  if (mpz_root(n.get_mpz_t(), numerator.get_mpz_t(), m) == 0 ||
      mpz_root(d.get_mpz_t(), denominator.get_mpz_t(), m) == 0)
    return std::nullopt;
  return mpq_class(n, d);
}

/// p(alpha + beta t).
inline std::vector<mpq_class> substituted(const Polynomial& p, const mpq_class& alpha,
                                          const mpq_class& beta) {
  std::vector<mpq_class> h;
  for (std::size_t i = p.size(); i-- > 0;) {
    h.emplace_back(0);
    for (std::size_t j = h.size() - 1; j-- > 0;) {
      h[j + 1] += beta * h[j];
      h[j] *= alpha;
    }
    h[0] += p[i];
  }
  return h;
}

/// b(t) = a(alpha + beta t), when that holds.
inline std::optional<std::array<mpq_class, 2>> affine_change(const PlanePolynomial& a,
                                                             const PlanePolynomial& b) {
  const std::size_t m = a.degree();
  if (b.degree() != m || m == 0) return std::nullopt;
  const std::size_t k = a.c[0][m] != 0 ? 0 : 1;
  const std::optional<mpq_class> root =
      rational_root(mpq_class(b.c[k][m]) / mpq_class(a.c[k][m]), m);
  if (!root) return std::nullopt;
  for (const int sign : {1, -1}) {
    const mpq_class beta = sign * *root;
    mpq_class power = 1;
    for (std::size_t i = 1; i < m; ++i) power *= beta;
    const mpq_class alpha = (b.c[k][m - 1] / power - a.c[k][m - 1]) /
                            (static_cast<unsigned long>(m) * mpq_class(a.c[k][m]));
    bool same = power * beta * a.c[k][m] == b.c[k][m];
    for (std::size_t c = 0; same && c < 2; ++c) {
      const std::vector<mpq_class> h = substituted(a.c[c], alpha, beta);
      for (std::size_t i = 0; i <= m; ++i) same = same && h[i] == b.c[c][i];
    }
    if (same) return std::array<mpq_class, 2>{alpha, beta};
  }
  return std::nullopt;
}

/// Polynomials over the rationals times the common denominator of all.
inline std::vector<Polynomial> integral(const std::vector<std::vector<mpq_class>>& f) {
  mpz_class common = 1;
  for (const auto& p : f)
    for (const mpq_class& x : p) common = lcm(common, x.get_den());
  std::vector<Polynomial> out;
  for (const auto& p : f) {
    Polynomial q;
    for (const mpq_class& x : p) q.push_back(x.get_num() * (common / x.get_den()));
    trim(q);
    out.push_back(std::move(q));
  }
  return out;
}

/// (a(s) - b(t)) / (s - alpha - beta t).
inline System other_meetings(const PlanePolynomial& a, const mpq_class& alpha,
                             const mpq_class& beta) {
  const std::size_t m = a.degree();
  const auto one = [&](std::size_t k) {
    std::vector<std::vector<mpq_class>> q(m);
    q[m - 1] = {mpq_class(a.c[k][m])};
    for (std::size_t i = m - 1; i-- > 0;) {
      const auto& above = q[i + 1];
      q[i].assign(above.size() + 1, mpq_class(0));
      for (std::size_t j = 0; j < above.size(); ++j) {
        q[i][j] += alpha * above[j];
        q[i][j + 1] += beta * above[j];
      }
      q[i][0] += a.c[k][i + 1];
    }
    return integral(q);
  };
  return {one(0), one(1)};
}

/// Both curves lie on one algebraic curve.
inline CommonParts on_one_curve(const PlanePolynomial& a, const PlanePolynomial& b,
                                const mpq_class& magnitude) {
  CommonParts out;
  const auto change = affine_change(a, b);
  if (!change) {
    out.decided = false;
    return out;
  }
  const auto [alpha, beta] = *change;
  const mpq_class end = alpha + beta;
  const mpq_class lo = std::max(mpq_class(0), std::min(alpha, end));
  const mpq_class hi = std::min(mpq_class(1), std::max(alpha, end));
  const mpq_class t_lo = (lo - alpha) / beta, t_hi = (hi - alpha) / beta;
  if (lo < hi) out.intervals.push_back({lo, hi, t_lo, t_hi});
  if (lo == hi) {
    CommonPoint p{lo, lo, t_lo, t_lo, 0, true, false, false, 0, HUGE_VAL};
    describe(a, b, magnitude, p);
    out.points.push_back(p);
  }
  const std::size_t m = a.degree();
  if (m == 1) return out;
  Solutions rest = solve(other_meetings(a, alpha, beta), (m - 1) * (m - 1));
  if (rest.common_component || !rest.singular.empty()) {
    out.decided = false;
    return out;
  }
  const Polynomial cusp = integral({substituted(singular_parameters(a), alpha, beta)}).front();
  for (Solution& x : rest.found) {
    if (cusp.size() > 1 && x.t.sign(cusp) == 0) continue;  // on the common part
    CommonPoint p{x.s_lo, x.s_hi, x.t.lo(), x.t.hi(), x.multiplicity, true, false, false, 0, 0};
    describe(a, b, magnitude, p);
    out.points.push_back(p);
  }
  return out;
}

/// The places where a curve passes through a point.
inline CommonParts through_point(const PlanePolynomial& curve, const PlanePolynomial& point,
                                 bool exchanged) {
  CommonParts out;
  Polynomial g;
  for (std::size_t k = 0; k < 2; ++k) {
    Polynomial f = curve.c[k];
    f[0] -= point.c[k][0];
    g = common_divisor(g, f);
  }
  const auto add = [&](const mpq_class& lo, const mpq_class& hi) {
    CommonPoint p{lo, hi, 0, 0, 0, false, is_end(lo, hi), true, 0, HUGE_VAL};
    if (exchanged) {
      std::swap(p.s_lo, p.t_lo);
      std::swap(p.s_hi, p.t_hi);
      std::swap(p.s_end, p.t_end);
    }
    out.points.push_back(p);
  };
  if (g.empty()) {
    add(0, 0);
    return out;
  }
  for (const Polynomial& factor : squarefree_factors(g))
    for (RealRoot& root : roots_in_unit_interval(factor)) {
      root.refine(100);
      add(root.lo(), root.hi());
    }
  return out;
}

inline std::array<PlanePolynomial, 2> power_forms(
    const std::array<const std::vector<RationalPoint>*, 2>& curves) {
  std::array<std::array<std::vector<mpq_class>, 2>, 2> rational;
  mpz_class common = 1, content = 0;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<mpq_class>& p = rational[c][k];
      // Relative to one point of both: smaller numbers.
      for (const RationalPoint& x : *curves[c]) p.push_back(x[k] - curves[0]->front()[k]);
      const std::size_t d = p.size() - 1;
      for (std::size_t i = 1; i <= d; ++i)
        for (std::size_t j = d; j >= i; --j) p[j] -= p[j - 1];
      mpz_class binomial = 1;
      for (std::size_t i = 0; i <= d; ++i) {
        p[i] *= binomial;
        binomial = binomial * static_cast<unsigned long>(d - i) / static_cast<unsigned long>(i + 1);
        common = lcm(common, p[i].get_den());
      }
    }
  std::array<PlanePolynomial, 2> out;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t k = 0; k < 2; ++k)
      for (const mpq_class& x : rational[c][k]) {
        out[c].c[k].push_back(x.get_num() * (common / x.get_den()));
        content = gcd(content, out[c].c[k].back());
      }
  for (PlanePolynomial& p : out) {
    if (content > 1)
      for (Polynomial& q : p.c)
        for (mpz_class& x : q) x /= content;
    while (p.c[0].size() > 1 && p.c[0].back() == 0 && p.c[1].back() == 0)
      for (Polynomial& q : p.c) q.pop_back();
  }
  return out;
}

}  // namespace curve_oracle_detail

/// All common points of two curves given by their control points.
///
/// @cost  random cubics with coordinates of 53 bits about 1 ms, degree 10 about 1 s
inline CommonParts common_parts(const std::vector<RationalPoint>& control_a,
                                const std::vector<RationalPoint>& control_b) {
  using namespace curve_oracle_detail;
  const std::array<PlanePolynomial, 2> curves = power_forms({&control_a, &control_b});
  const PlanePolynomial &a = curves[0], &b = curves[1];
  // The condition is a ratio: the largest coordinate in the unit of the power forms.
  mpq_class largest = 0, first_size = 0;
  for (const auto* control : {&control_a, &control_b})
    for (const RationalPoint& p : *control)
      for (const mpq_class& x : p) largest = std::max(largest, mpq_class(abs(x)));
  mpq_class unit = 0;  // one step of the power forms, from any nonzero coefficient of degree 1
  for (std::size_t c = 0; c < 2 && unit == 0; ++c) {
    const auto& control = c == 0 ? control_a : control_b;
    const PlanePolynomial& p = c == 0 ? a : b;
    for (std::size_t k = 0; k < 2 && unit == 0; ++k)
      if (p.degree() >= 1 && p.c[k][1] != 0)
        unit = static_cast<unsigned long>(control.size() - 1) * (control[1][k] - control[0][k]) /
               p.c[k][1];
  }
  const mpq_class magnitude = unit == 0 ? mpq_class(0) : mpq_class(largest / abs(unit));

  CommonParts out;
  const std::size_t m = a.degree(), n = b.degree();
  if (m == 0 || n == 0) {
    out = n == 0 ? through_point(a, b, false) : through_point(b, a, true);
  } else {
    Solutions by_t = solve(meeting(a, b), m * n);
    if (by_t.common_component) {
      out = on_one_curve(a, b, magnitude);
    } else {
      const auto add = [&](const mpq_class& s_lo, const mpq_class& s_hi, const mpq_class& t_lo,
                           const mpq_class& t_hi, int multiplicity) {
        CommonPoint p{s_lo, s_hi, t_lo, t_hi, multiplicity, true, false, false, 0, 0};
        describe(a, b, magnitude, p);
        out.points.push_back(p);
      };
      for (const Solution& x : by_t.found) add(x.s_lo, x.s_hi, x.t.lo(), x.t.hi(), x.multiplicity);
      if (!by_t.singular.empty()) {
        // b passes through multiple points of a: those solutions with the roles exchanged.
        Solutions by_s = solve(meeting(b, a), m * n);
        const auto has = [](const Solution& x, const RealRoot& t) {
          return t.lo() <= x.s_hi && x.s_lo <= t.hi();
        };
        for (const Solution& x : by_s.found) {
          if (std::none_of(by_t.singular.begin(), by_t.singular.end(),
                           [&](const RealRoot& t) { return has(x, t); }))
            continue;
          add(x.t.lo(), x.t.hi(), x.s_lo, x.s_hi, x.multiplicity);
          // Too close to another common point to tell whether it is the same.
          for (const Solution& y : by_t.found)
            if (has(x, y.t) && y.s_lo <= x.t.hi() && x.t.lo() <= y.s_hi) out.decided = false;
        }
        for (const RealRoot& s : by_s.singular)
          for (const RealRoot& t : by_t.singular)
            if (!apart(a, b, s, t)) out.decided = false;
      }
    }
  }
  if (!out.decided) {
    out.points.clear();
    out.intervals.clear();
  }
  std::sort(out.points.begin(), out.points.end(), [](const CommonPoint& p, const CommonPoint& q) {
    return p.s_lo != q.s_lo ? p.s_lo < q.s_lo : p.t_lo < q.t_lo;
  });
  return out;
}

/// The same for control points with double coordinates x(), y().
template <class Points>
std::vector<RationalPoint> rational_points(const Points& points) {
  std::vector<RationalPoint> out;
  for (const auto& p : points) out.push_back({mpq_class(p.x()), mpq_class(p.y())});
  return out;
}

}  // namespace support
