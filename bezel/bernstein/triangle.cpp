#include "bezel/bernstein/triangle.hpp"

#include <cstddef>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/components.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::bernstein {
namespace {

std::size_t size_of(int d) {
  return static_cast<std::size_t>(triangle_size(d));
}

void check_point(const Lambda& lambda) {
  for (const double l : lambda) checks::finite(l, "barycentric coordinate");
}

}  // namespace

template <class Value>
Value evaluate(int d, std::span<const Value> b, const Lambda& lambda) {
  checks::triangle(d, b);
  check_point(lambda);
  return kernel::evaluate_unchecked(d, b.data(), lambda);
}

template <class Value>
ValueAndGradient<Value> evaluate_gradient(int d, std::span<const Value> b, const Lambda& lambda) {
  checks::triangle(d, b);
  check_point(lambda);
  return kernel::evaluate_gradient_unchecked(d, b.data(), lambda);
}

template <class Value>
std::array<std::vector<Value>, 2> differentiate(int d, std::span<const Value> b) {
  checks::triangle(d, b);
  const std::size_t size = size_of(d == 0 ? 0 : d - 1);
  std::array<std::vector<Value>, 2> out{std::vector<Value>(size), std::vector<Value>(size)};
  kernel::differentiate_triangle<Value, double>(d, b.data(), out[0].data(), out[1].data());
  return out;
}

template <class Value>
std::vector<Value> specialize(int d, std::span<const Value> b,
                              const std::array<Lambda, 3>& corner) {
  checks::triangle(d, b);
  for (const Lambda& lambda : corner) check_point(lambda);
  std::vector<Value> out(b.size());
  kernel::specialize_triangle(d, b.data(), corner, {0, 1, 2}, out.data());
  return out;
}

template <class Value>
std::array<std::vector<Value>, 4> subdivide(int d, std::span<const Value> b) {
  checks::triangle(d, b);
  std::array<std::vector<Value>, 4> out;
  std::array<Value*, 4> place{};
  for (std::size_t child = 0; child < 4; ++child) {
    out[child].resize(b.size());
    place[child] = out[child].data();
  }
  kernel::subdivide_triangle<Value, double>(d, b.data(), place);
  return out;
}

template <class Value>
std::vector<Value> elevate(int d, std::span<const Value> b, int by) {
  checks::triangle(d, b);
  checks::elevation(d, by, max_triangle_degree, "triangle");
  std::vector<Value> c(b.begin(), b.end()), next;
  for (int m = d; m < d + by; ++m) {
    next.resize(size_of(m + 1));
    kernel::elevate_triangle<Value, double>(m, c.data(), next.data());
    c.swap(next);
  }
  return c;
}

template <class Value>
std::vector<Value> reduce(int d, std::span<const Value> b, int by) {
  checks::triangle(d, b);
  checks::reduction(d, by);
  std::vector<Value> c(b.begin(), b.end()), next;
  for (int m = d; m > d - by; --m) {
    next.resize(size_of(m - 1));
    kernel::reduce_triangle<Value, double>(m, c.data(), next.data());
    c.swap(next);
  }
  return c;
}

std::vector<double> multiply(int da, std::span<const double> a, int db, std::span<const double> b) {
  checks::triangle(da, a);
  checks::triangle(db, b);
  checks::triangle_degree(da + db);
  std::vector<double> out(size_of(da + db));
  kernel::multiply_triangle(da, a.data(), db, b.data(), out.data());
  return out;
}

double integral(int d, std::span<const double> b) {
  checks::triangle(d, b);
  return sum(b) / ((d + 1.0) * (d + 2.0));
}

template <class Value>
std::vector<Value> side(int d, std::span<const Value> b, int side) {
  checks::triangle(d, b);
  if (side < 0 || side > 2)
    throw InputError("side " + std::to_string(side) + " of a triangle, expected 0, 1 or 2");
  std::vector<Value> out;
  for (int m = 0; m <= d; ++m)
    out.push_back(b[static_cast<std::size_t>(triangle_side_index(d, side, m))]);
  return out;
}

template <class Value>
std::vector<Value> to_lagrange(int d, std::span<const Value> b) {
  checks::triangle(d, b);
  return in_double_double(b, b.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::to_lagrange_triangle(d, in, out);
  });
}

template <class Value>
std::vector<Value> from_lagrange(int d, std::span<const Value> values) {
  checks::triangle(d, values);
  return in_double_double(values, values.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::from_lagrange_triangle(d, in, out);
  });
}

void basis(int d, const Lambda& lambda, std::span<double> out) {
  checks::triangle_degree(d);
  check_point(lambda);
  checks::size(out.size(), size_of(d), "places for basis values");
  kernel::basis_triangle(d, lambda, out.data());
}

std::vector<double> mass_matrix(int d) {
  checks::triangle_degree(d);
  std::vector<double> out(size_of(d) * size_of(d));
  kernel::mass_matrix(d, out.data());
  return out;
}

#define BEZEL_INSTANTIATE(Value)                                                                  \
  template Value evaluate(int, std::span<const Value>, const Lambda&);                            \
  template ValueAndGradient<Value> evaluate_gradient(int, std::span<const Value>, const Lambda&); \
  template std::array<std::vector<Value>, 2> differentiate(int, std::span<const Value>);          \
  template std::vector<Value> specialize(int, std::span<const Value>,                             \
                                         const std::array<Lambda, 3>&);                           \
  template std::array<std::vector<Value>, 4> subdivide(int, std::span<const Value>);              \
  template std::vector<Value> elevate(int, std::span<const Value>, int);                          \
  template std::vector<Value> reduce(int, std::span<const Value>, int);                           \
  template std::vector<Value> side(int, std::span<const Value>, int);                             \
  template std::vector<Value> to_lagrange(int, std::span<const Value>);                           \
  template std::vector<Value> from_lagrange(int, std::span<const Value>);
BEZEL_INSTANTIATE(double)
BEZEL_INSTANTIATE(Vec2)
BEZEL_INSTANTIATE(Vec3)
#undef BEZEL_INSTANTIATE

}  // namespace bezel::bernstein
