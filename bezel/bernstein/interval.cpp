#include "bezel/bernstein/interval.hpp"

#include <cstddef>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/components.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::bernstein {

template <class Value>
Value evaluate(std::span<const Value> b, double s) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  return kernel::evaluate_unchecked(d, b.data(), s);
}

template <class Value>
Value evaluate_derivative(std::span<const Value> b, double s) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  return kernel::evaluate_derivative_unchecked(d, b.data(), s).derivative;
}

template <class Value>
std::vector<Value> differentiate(std::span<const Value> b) {
  const int d = checks::interval(b);
  std::vector<Value> out(d == 0 ? 1 : b.size() - 1);
  kernel::differentiate<Value, double>(d, b.data(), out.data());
  return out;
}

template <class Value>
std::pair<std::vector<Value>, std::vector<Value>> subdivide(std::span<const Value> b, double t) {
  const int d = checks::interval(b);
  checks::finite(t, "parameter");
  std::pair<std::vector<Value>, std::vector<Value>> out{std::vector<Value>(b.size()),
                                                        std::vector<Value>(b.size())};
  kernel::subdivide(d, b.data(), t, out.first.data(), out.second.data());
  return out;
}

template <class Value>
std::vector<Value> specialize(std::span<const Value> b, double t0, double t1) {
  const int d = checks::interval(b);
  checks::finite(t0, "parameter");
  checks::finite(t1, "parameter");
  std::vector<Value> out(b.size());
  kernel::specialize(d, b.data(), t0, t1, out.data());
  return out;
}

template <class Value>
std::vector<Value> elevate(std::span<const Value> b, int by) {
  const int d = checks::interval(b);
  checks::elevation(d, by, max_interval_degree, "interval");
  std::vector<Value> c(b.begin(), b.end()), next;
  for (int m = d; m < d + by; ++m) {
    next.resize(c.size() + 1);
    kernel::elevate<Value, double>(m, c.data(), next.data());
    c.swap(next);
  }
  return c;
}

template <class Value>
std::vector<Value> reduce(std::span<const Value> b, int by) {
  const int d = checks::interval(b);
  checks::reduction(d, by);
  std::vector<Value> c(b.begin(), b.end()), next;
  for (int m = d; m > d - by; --m) {
    next.resize(c.size() - 1);
    kernel::reduce<Value, double>(m, c.data(), next.data());
    c.swap(next);
  }
  return c;
}

std::vector<double> antiderivative(std::span<const double> b) {
  const int d = checks::interval(b);
  checks::interval_degree(d + 1);
  return in_double_double(b, b.size() + 1, [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::antiderivative<DoubleDouble, DoubleDouble>(d, in, out);
  });
}

double integral(std::span<const double> b) {
  const int d = checks::interval(b);
  return sum(b) / (d + 1.0);
}

std::vector<double> multiply(std::span<const double> a, std::span<const double> b) {
  const int da = checks::interval(a), db = checks::interval(b);
  checks::interval_degree(da + db);
  std::vector<double> out(static_cast<std::size_t>(da + db + 1));
  kernel::multiply(da, a.data(), db, b.data(), out.data());
  return out;
}

std::vector<double> to_monomial(std::span<const double> b) {
  const int d = checks::interval(b);
  return in_double_double(b, b.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::to_monomial(d, in, out);
  });
}

std::vector<double> from_monomial(std::span<const double> a) {
  const int d = checks::interval(a);
  return in_double_double(a, a.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::from_monomial(d, in, out);
  });
}

template <class Value>
std::vector<Value> to_lagrange(std::span<const Value> b) {
  const int d = checks::interval(b);
  return in_double_double(b, b.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::to_lagrange(d, in, out);
  });
}

template <class Value>
std::vector<Value> from_lagrange(std::span<const Value> values) {
  const int d = checks::interval(values);
  return in_double_double(values, values.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::from_lagrange(d, in, out);
  });
}

void basis(int d, double s, std::span<double> out) {
  checks::interval_degree(d);
  checks::finite(s, "parameter");
  checks::size(out.size(), static_cast<std::size_t>(d + 1), "places for basis values");
  kernel::basis(d, s, out.data());
}

#define BEZEL_INSTANTIATE(Value)                                                               \
  template Value evaluate(std::span<const Value>, double);                                     \
  template Value evaluate_derivative(std::span<const Value>, double);                          \
  template std::vector<Value> differentiate(std::span<const Value>);                           \
  template std::pair<std::vector<Value>, std::vector<Value>> subdivide(std::span<const Value>, \
                                                                       double);                \
  template std::vector<Value> specialize(std::span<const Value>, double, double);              \
  template std::vector<Value> elevate(std::span<const Value>, int);                            \
  template std::vector<Value> reduce(std::span<const Value>, int);                             \
  template std::vector<Value> to_lagrange(std::span<const Value>);                             \
  template std::vector<Value> from_lagrange(std::span<const Value>);
BEZEL_INSTANTIATE(double)
BEZEL_INSTANTIATE(Vec2)
BEZEL_INSTANTIATE(Vec3)
#undef BEZEL_INSTANTIATE

}  // namespace bezel::bernstein
