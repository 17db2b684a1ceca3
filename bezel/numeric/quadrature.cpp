#include "bezel/numeric/quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/triangle_rule_table.hpp"

namespace bezel {
namespace {

constexpr int max_points = 200;
constexpr int max_triangle_rule_degree = 80;

void check_points(const char* name, int n, int least) {
  if (n < least || n > max_points)
    throw InputError(std::string(name) + " rule with " + std::to_string(n) + " points, expected " +
                     std::to_string(least) + " to " + std::to_string(max_points));
}

// P_n, P_{n+1} at x, by the three-term recurrence.
struct Pair {
  DoubleDouble low, high;
};
Pair legendre(int n, const DoubleDouble& x) {
  DoubleDouble previous(1.0), current = x;
  for (int k = 1; k <= n; ++k) {
    const DoubleDouble next =
        (DoubleDouble(2.0 * k + 1.0) * x * current - DoubleDouble(double(k)) * previous) /
        DoubleDouble(k + 1.0);
    previous = current;
    current = next;
  }
  return {previous, current};
}

// Newton's method in double-double; step(x) returns f / f'. From the asymptotic guesses below it
// converges monotonically in order to full precision within 8 steps for every size allowed here
// (tested).
template <class Step>
DoubleDouble newton(double guess, const Step& step) {
  DoubleDouble x(guess);
  for (int i = 0; i < 12; ++i) {
    const DoubleDouble dx = step(x);
    x = x - dx;
    if (std::fabs(dx.hi) < 1e-20) break;  // quadratic: the next error is below 1e-30
  }
  return x;
}

DoubleDouble to_unit(const DoubleDouble& x) {
  return (DoubleDouble(1.0) + x) * DoubleDouble(0.5);
}

// (1 - x^2) P_n'(x) = n (P_{n-1} - x P_n) = (n+1) (x P_n - P_{n+1})
DoubleDouble legendre_slope(int n, const DoubleDouble& x, const Pair& p) {
  return DoubleDouble(n + 1.0) * (x * p.low - p.high) / (DoubleDouble(1.0) - x * x);
}

// Gauss rule for the weight 1 - x on [0, 1]: its nodes are those of the (n+1)-point Radau rule that
// contains 1, the roots of (P_n - P_{n+1}) / (1 - x); its weights are the Radau weights times 1 -
// x.
IntervalRule gauss_jacobi(int n) {
  const auto size = static_cast<std::size_t>(n);
  IntervalRule rule{std::vector<double>(size), std::vector<double>(size)};
  for (int i = 1; i <= n; ++i) {
    const double guess = std::cos((i + 0.25) * std::numbers::pi / (n + 1.0));
    const auto step = [n](const DoubleDouble& x) {
      const Pair p = legendre(n, x);
      const DoubleDouble one_x2 = DoubleDouble(1.0) - x * x;
      const DoubleDouble slope_low = DoubleDouble(n + 1.0) * (x * p.low - p.high) / one_x2;
      const DoubleDouble slope_high = DoubleDouble(n + 1.0) * (p.low - x * p.high) / one_x2;
      // Newton for g = (P_n - P_{n+1}) / (1 - x), so that the root 1 does not attract.
      const DoubleDouble f = p.low - p.high;
      return f / (slope_low - slope_high + f / (DoubleDouble(1.0) - x));
    };
    const DoubleDouble x = newton(guess, step);
    const DoubleDouble p = legendre(n, x).low;
    const auto at = static_cast<std::size_t>(n - i);
    rule.node[at] = to_unit(x).hi;
    rule.weight[at] =
        ((DoubleDouble(1.0) - x * x) / (DoubleDouble(4.0 * (n + 1.0) * (n + 1.0)) * p * p)).hi;
  }
  return rule;
}

void add_orbit(TriangleRule& rule, double a, double weight) {
  const double b = 1.0 - 2.0 * a;
  rule.lambda.push_back({b, a, a});
  rule.lambda.push_back({a, b, a});
  rule.lambda.push_back({a, a, b});
  rule.weight.insert(rule.weight.end(), 3, weight);
}

TriangleRule expand(const SymmetricRule& table) {
  TriangleRule rule;
  const double* x = table.number.data();
  if (table.ones > 0) {
    rule.lambda.push_back({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
    rule.weight.push_back(*x++);
  }
  for (int i = 0; i < table.threes; ++i, x += 2) add_orbit(rule, x[1], x[0]);
  for (int i = 0; i < table.sixes; ++i, x += 3) {
    const double a = x[1], b = x[2], c = 1.0 - a - b;
    rule.lambda.insert(rule.lambda.end(),
                       {{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}, {c, b, a}, {b, a, c}});
    rule.weight.insert(rule.weight.end(), 6, x[0]);
  }
  return rule;
}

}  // namespace

IntervalRule gauss_legendre(int n) {
  check_points("gauss-legendre", n, 1);
  const auto size = static_cast<std::size_t>(n);
  IntervalRule rule{std::vector<double>(size), std::vector<double>(size)};
  for (int i = 1; 2 * i <= n + 1; ++i) {
    DoubleDouble x(0.0);
    if (2 * i != n + 1) {
      const double guess = -std::cos((i - 0.25) * std::numbers::pi / (n + 0.5));
      x = newton(guess, [n](const DoubleDouble& y) {
        const Pair p = legendre(n, y);
        return p.low / legendre_slope(n, y, p);
      });
    }
    const Pair p = legendre(n, x);
    // With P_n = 0, (1 - x^2) P_n' = -(n+1) P_{n+1}: the weight 2 / ((1-x^2) P_n'^2) on [-1, 1].
    const DoubleDouble weight =
        (DoubleDouble(1.0) - x * x) / (DoubleDouble((n + 1.0) * (n + 1.0)) * p.high * p.high);
    const auto left = static_cast<std::size_t>(i - 1), right = static_cast<std::size_t>(n - i);
    rule.node[left] = to_unit(x).hi;
    rule.node[right] = to_unit(-x).hi;
    rule.weight[left] = rule.weight[right] = weight.hi;
  }
  return rule;
}

IntervalRule gauss_lobatto(int n) {
  check_points("gauss-lobatto", n, 2);
  const auto size = static_cast<std::size_t>(n);
  IntervalRule rule{std::vector<double>(size), std::vector<double>(size)};
  const int m = n - 1;  // the interior nodes are the roots of P_m'
  const double mm = m * (m + 1.0);
  for (int i = 0; 2 * i <= m; ++i) {
    DoubleDouble x(0.0);
    if (i == 0) {
      x = DoubleDouble(-1.0);
    } else if (2 * i != m) {
      const double angle = (i + 0.25) * std::numbers::pi / m;
      const double guess = -std::cos(angle - 3.0 / (8.0 * m * m * angle));
      x = newton(guess, [m, mm](const DoubleDouble& y) {
        const Pair p = legendre(m, y);
        const DoubleDouble slope = legendre_slope(m, y, p);
        // (1 - x^2) P'' = 2 x P' - m (m+1) P
        const DoubleDouble bend = (DoubleDouble(2.0) * y * slope - DoubleDouble(mm) * p.low) /
                                  (DoubleDouble(1.0) - y * y);
        return slope / bend;
      });
    }
    const DoubleDouble p = legendre(m, x).low;
    const auto left = static_cast<std::size_t>(i), right = static_cast<std::size_t>(m - i);
    rule.node[left] = to_unit(x).hi;
    rule.node[right] = to_unit(-x).hi;
    rule.weight[left] = rule.weight[right] = (DoubleDouble(1.0) / (DoubleDouble(mm) * p * p)).hi;
  }
  return rule;
}

TriangleRule triangle_rule(int degree) {
  if (degree < 0 || degree > max_triangle_rule_degree)
    throw InputError("triangle rule of degree " + std::to_string(degree) + ", expected 0 to " +
                     std::to_string(max_triangle_rule_degree));
  for (const SymmetricRule& table : symmetric_rules)
    if (degree > 5 && table.degree >= degree) return expand(table);
  TriangleRule rule;
  if (degree <= 1) {
    rule.lambda.push_back({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
    rule.weight.push_back(0.5);
  } else if (degree == 2) {
    add_orbit(rule, 1.0 / 6.0, 1.0 / 6.0);
  } else if (degree <= 4) {
    // Six points; the closed form solves the moment equations of degree 4 for two orbits of three.
    const double a = 8.0 - std::sqrt(10.0), b = std::sqrt(38.0 - 44.0 * std::sqrt(0.4));
    const double w = std::sqrt(213125.0 - 53320.0 * std::sqrt(10.0));
    add_orbit(rule, (a + b) / 18.0, (620.0 + w) / 7440.0);
    add_orbit(rule, (a - b) / 18.0, (620.0 - w) / 7440.0);
  } else if (degree == 5) {
    const double root = std::sqrt(15.0);  // Radon's seven points
    rule.lambda.push_back({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
    rule.weight.push_back(9.0 / 80.0);
    add_orbit(rule, (6.0 + root) / 21.0, (155.0 + root) / 2400.0);
    add_orbit(rule, (6.0 - root) / 21.0, (155.0 - root) / 2400.0);
  } else {
    const int n = degree / 2 + 1;
    const IntervalRule outer = gauss_jacobi(n), inner = gauss_legendre(n);
    for (std::size_t i = 0; i < outer.node.size(); ++i)
      for (std::size_t j = 0; j < inner.node.size(); ++j) {
        const double rest = 1.0 - outer.node[i];
        rule.lambda.push_back(
            {rest * inner.node[inner.node.size() - 1 - j], outer.node[i], rest * inner.node[j]});
        rule.weight.push_back(outer.weight[i] * inner.weight[j]);
      }
  }
  return rule;
}

}  // namespace bezel
