#include "bezel/bernstein/compensated.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "bezel/bernstein/casteljau_batch.hpp"
#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/compensated_batch.hpp"
#include "bezel/bernstein/components.hpp"
#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::bernstein {
namespace {

void check_precision(int K) {
  if (K < 1 || K > max_precision)
    throw InputError("found K = " + std::to_string(K) + ", expected 1 to " +
                     std::to_string(max_precision));
}

/// Runs body(places) on `count` doubles, on the stack when few.
template <class Body>
auto with_places(int count, const Body& body) {
  std::array<double, 64> few;
  if (count <= static_cast<int>(few.size())) return body(few.data());
  std::vector<double> many(static_cast<std::size_t>(count));
  return body(many.data());
}

double sum_levels(const double* levels, int K) {
  return sum_k({levels, static_cast<std::size_t>(K)}, K);
}

using Levels = std::array<double, max_precision>;

double value_of(int d, const double* b, double s, int K) {
  Levels levels;
  with_places((d + 1) * K,
              [&](double* w) { kernel::compensated_levels(d, b, s, K, w, levels.data()); });
  return sum_levels(levels.data(), K);
}

double derivative_of(int d, const double* b, double s, int K) {
  if (d == 0) return 0.0;
  Levels levels;
  with_places(d * K, [&](double* w) {
    kernel::compensated_derivative_levels(d, b, s, K, w, levels.data());
  });
  return d * sum_levels(levels.data(), K);
}

double triangle_value_of(int d, const double* b, const kernel::SplitLambda& lambda, int K) {
  Levels levels;
  with_places(triangle_size(d) * K, [&](double* w) {
    kernel::compensated_triangle_levels(d, b, lambda, K, w, levels.data());
  });
  return sum_levels(levels.data(), K);
}

/// routine(coefficients) for each coordinate of the values.
template <class Value, class Routine>
Value per_coordinate(std::span<const Value> b, const Routine& routine) {
  if constexpr (std::is_same_v<Value, double>) {
    return routine(b.data());
  } else {
    Value out;
    std::vector<double> c(b.size());
    for (int i = 0; i < components(b.data()); ++i) {
      for (std::size_t n = 0; n < b.size(); ++n) c[n] = component(b[n], i);
      component(out, i) = routine(c.data());
    }
    return out;
  }
}

/// 1 - u - v as three doubles that sum to it exactly, each at most u times the one before.
kernel::SplitLambda split(double u, double v) {
  const WithError a = two_sum(1.0, -u), b = two_sum(a.value, -v);
  // a.error + b.error + b.value, renormalised; three doubles hold the sum of three exactly.
  const WithError c = two_sum(a.error, b.error), top = two_sum(b.value, c.value);
  const WithError low = two_sum(top.error, c.error);
  const WithError high = two_sum(top.value, low.value);
  return {high.value, u, v, high.error, low.error};
}

/// q_F(n) from r_1 = step, r_{F+1}(k) = step q_F(k-1) + F per_level r_F(k), q_F(k) = sum r_F.
double multiplier(int n, int K, double step, double per_level) {
  std::vector<Dyadic> r(static_cast<std::size_t>(n), Dyadic(step)), q(r.size());
  for (int f = 1;; ++f) {
    Dyadic sum;
    for (std::size_t k = 0; k < r.size(); ++k) q[k] = sum = sum + r[k];
    if (f == K) return sum.to_double();
    const Dyadic factor(per_level * f);
    for (std::size_t k = r.size(); k-- > 0;)
      r[k] = r[k] * factor + (k > 0 ? q[k - 1] * Dyadic(step) : Dyadic());
  }
}

/// u |p| + multiplier u^K p~, rounded up.
double error_bound(double value, double multiplier, double absolute, int K) {
  constexpr double up = 1.0 + 0x1p-40, u = 0x1p-53;
  for (int f = 0; f < K; ++f) multiplier *= u;
  return (u * std::fabs(value) + multiplier * absolute) * up;
}

/// p(lambda), correctly rounded: the kernel is a template on the scalar.
double exact_value(int d, std::span<const double> b, const Lambda& lambda) {
  const std::vector<Dyadic> exact(b.begin(), b.end());
  return kernel::evaluate_unchecked(
             d, exact.data(),
             std::array<Dyadic, 3>{Dyadic(lambda[0]), Dyadic(lambda[1]), Dyadic(lambda[2])})
      .to_double();
}

double condition(double absolute, double value) {
  if (absolute == 0.0) return 1.0;
  return value == 0.0 ? std::numeric_limits<double>::infinity() : absolute / std::fabs(value);
}

std::vector<double> absolute_values(std::span<const double> b) {
  std::vector<double> w(b.begin(), b.end());
  for (double& x : w) x = std::fabs(x);
  return w;
}

}  // namespace

template <class Value>
Value evaluate_compensated(std::span<const Value> b, double s, int K) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  check_precision(K);
  return per_coordinate(b, [&](const double* c) {
    double value = 0.0;
    return compensated_points(d, c, &s, 1, K, &value) ? value : value_of(d, c, s, K);
  });
}

void evaluate_compensated(std::span<const double> b, std::span<const double> s,
                          std::span<double> out, int K) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  check_precision(K);
  checks::size(out.size(), s.size(), "places for values");
  if (K == 1) {
    casteljau_points(d, b.data(), s.data(), s.size(), out.data());
  } else if (!compensated_points(d, b.data(), s.data(), s.size(), K, out.data())) {
    for (std::size_t q = 0; q < s.size(); ++q) out[q] = value_of(d, b.data(), s[q], K);
  }
}

void compensated_levels(std::span<const double> b, double s, std::span<double> levels) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  const int K = static_cast<int>(std::min<std::size_t>(levels.size(), max_precision + 1));
  check_precision(K);
  with_places((d + 1) * K,
              [&](double* w) { kernel::compensated_levels(d, b.data(), s, K, w, levels.data()); });
}

template <class Value>
Value evaluate_derivative_compensated(std::span<const Value> b, double s, int K) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  check_precision(K);
  return per_coordinate(b, [&](const double* c) { return derivative_of(d, c, s, K); });
}

template <class Value>
Value evaluate_compensated(int d, std::span<const Value> b, const Lambda& lambda, int K) {
  checks::triangle(d, b);
  checks::finite(std::span<const double>(lambda), "barycentric");
  check_precision(K);
  const kernel::SplitLambda exact{lambda[0], lambda[1], lambda[2], 0.0, 0.0};
  return per_coordinate(b, [&](const double* c) { return triangle_value_of(d, c, exact, K); });
}

template <class Value>
Value evaluate_compensated(int d, std::span<const Value> b, double u, double v, int K) {
  checks::triangle(d, b);
  checks::finite(u, "coordinate u");
  checks::finite(v, "coordinate v");
  check_precision(K);
  return per_coordinate(b,
                        [&](const double* c) { return triangle_value_of(d, c, split(u, v), K); });
}

double absolute_value_sum(std::span<const double> b, double s) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  std::vector<double> w = absolute_values(b);
  for (int m = d; m > 0; --m) kernel::step(w.data(), m, std::fabs(1.0 - s), std::fabs(s));
  return w[0];
}

double absolute_value_sum(int d, std::span<const double> b, const Lambda& lambda) {
  checks::triangle(d, b);
  checks::finite(std::span<const double>(lambda), "barycentric");
  const std::vector<double> w = absolute_values(b);
  return evaluate(d, std::span<const double>(w),
                  Lambda{std::fabs(lambda[0]), std::fabs(lambda[1]), std::fabs(lambda[2])});
}

double condition_number(std::span<const double> b, double s) {
  return condition(absolute_value_sum(b, s), evaluate_certified(b, s).value);
}

double condition_number(int d, std::span<const double> b, const Lambda& lambda) {
  return condition(absolute_value_sum(d, b, lambda), exact_value(d, b, lambda));
}

double error_multiplier(int n, int K) {
  checks::interval_degree(n);
  check_precision(K);
  return n == 0 ? 0.0 : multiplier(n, K, 3.0, 5.0);
}

double triangle_error_multiplier(int n, int K) {
  checks::triangle_degree(n);
  check_precision(K);
  return n == 0 ? 0.0 : multiplier(n, K, 4.0, 9.0);
}

double compensated_error_bound(std::span<const double> b, double s, int K) {
  check_precision(K);
  const double value = evaluate_certified(b, s).value;
  return error_bound(value, error_multiplier(static_cast<int>(b.size()) - 1, K),
                     absolute_value_sum(b, s), K);
}

double compensated_error_bound(int d, std::span<const double> b, const Lambda& lambda, int K) {
  check_precision(K);
  const double absolute = absolute_value_sum(d, b, lambda);
  return error_bound(exact_value(d, b, lambda), triangle_error_multiplier(d, K), absolute, K);
}

FlopCount compensated_flops(int n, int K) {
  checks::interval_degree(n);
  check_precision(K);
  if (n < 1 || K < 2)
    throw InputError("operations for degree " + std::to_string(n) + " and K = " +
                     std::to_string(K) + ", expected a degree of at least 1 and K of at least 2");
  const double t = 0.5 * n * (n + 1), k = K;
  const double tail = 6 * k * k - 11 * k + 11;
  const double dekker = (15 * k * k + 11 * k - 34) * t + tail, two_prods = (3 * k - 4) * t;
  return {dekker - 15 * two_prods, dekker, two_prods};
}

#define BEZEL_INSTANTIATE(Value)                                                        \
  template Value evaluate_compensated(std::span<const Value>, double, int);             \
  template Value evaluate_derivative_compensated(std::span<const Value>, double, int);  \
  template Value evaluate_compensated(int, std::span<const Value>, const Lambda&, int); \
  template Value evaluate_compensated(int, std::span<const Value>, double, double, int);
BEZEL_INSTANTIATE(double)
BEZEL_INSTANTIATE(Vec2)
BEZEL_INSTANTIATE(Vec3)
#undef BEZEL_INSTANTIATE

}  // namespace bezel::bernstein
