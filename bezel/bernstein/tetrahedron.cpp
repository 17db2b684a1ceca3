#include "bezel/bernstein/tetrahedron.hpp"

#include <cstddef>
#include <string>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/components.hpp"
#include "bezel/bernstein/tetrahedron_kernel.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::bernstein::tetrahedron {
namespace {

std::size_t size_of(int d) {
  return static_cast<std::size_t>(tetrahedron_size(d));
}

void check_point(const Lambda& lambda) {
  for (const double l : lambda) checks::finite(l, "barycentric coordinate");
}

}  // namespace

template <class Value>
Value evaluate(int d, std::span<const Value> b, const Lambda& lambda) {
  checks::tetrahedron(d, b);
  check_point(lambda);
  return kernel::evaluate_unchecked(d, b.data(), lambda);
}

template <class Value>
ValueAndGradient<Value> evaluate_gradient(int d, std::span<const Value> b, const Lambda& lambda) {
  checks::tetrahedron(d, b);
  check_point(lambda);
  return kernel::evaluate_gradient_unchecked(d, b.data(), lambda);
}

template <class Value>
std::array<std::vector<Value>, 3> differentiate(int d, std::span<const Value> b) {
  checks::tetrahedron(d, b);
  const std::vector<Value> empty(size_of(d == 0 ? 0 : d - 1));
  std::array<std::vector<Value>, 3> out{empty, empty, empty};
  kernel::differentiate<Value, double>(d, b.data(), out[0].data(), out[1].data(), out[2].data());
  return out;
}

template <class Value>
std::vector<Value> specialize(int d, std::span<const Value> b,
                              const std::array<Lambda, 4>& corner) {
  checks::tetrahedron(d, b);
  for (const Lambda& lambda : corner) check_point(lambda);
  std::vector<Value> out(b.size());
  kernel::specialize(d, b.data(), corner, {0, 1, 2, 3}, out.data());
  return out;
}

template <class Value>
std::array<std::vector<Value>, 8> subdivide(int d, std::span<const Value> b) {
  checks::tetrahedron(d, b);
  std::array<std::vector<Value>, 8> out;
  std::array<Value*, 8> place{};
  for (std::size_t child = 0; child < 8; ++child) {
    out[child].resize(b.size());
    place[child] = out[child].data();
  }
  kernel::subdivide<Value, double>(d, b.data(), place);
  return out;
}

template <class Value>
std::vector<Value> elevate(int d, std::span<const Value> b, int by) {
  checks::tetrahedron(d, b);
  checks::elevation(d, by, max_tetrahedron_degree, "tetrahedron");
  std::vector<Value> c(b.begin(), b.end()), next;
  for (int m = d; m < d + by; ++m) {
    next.resize(size_of(m + 1));
    kernel::elevate<Value, double>(m, c.data(), next.data());
    c.swap(next);
  }
  return c;
}

std::vector<double> multiply(int da, std::span<const double> a, int db, std::span<const double> b) {
  checks::tetrahedron(da, a);
  checks::tetrahedron(db, b);
  checks::tetrahedron_degree(da + db);
  std::vector<double> out(size_of(da + db));
  kernel::multiply(da, a.data(), db, b.data(), out.data());
  return out;
}

double integral(int d, std::span<const double> b) {
  checks::tetrahedron(d, b);
  return sum(b) / ((d + 1.0) * (d + 2.0) * (d + 3.0));
}

template <class Value>
std::vector<Value> face(int d, std::span<const Value> b, int face) {
  checks::tetrahedron(d, b);
  if (face < 0 || face > 3)
    throw InputError("face " + std::to_string(face) + " of a tetrahedron, expected 0 to 3");
  std::vector<Value> out;
  out.reserve(static_cast<std::size_t>(triangle_size(d)));
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j)
      out.push_back(b[static_cast<std::size_t>(tetrahedron_face_index(d, face, j, k))]);
  return out;
}

template <class Value>
std::vector<Value> to_lagrange(int d, std::span<const Value> b) {
  checks::tetrahedron(d, b);
  return in_double_double(b, b.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::to_lagrange(d, in, out);
  });
}

template <class Value>
std::vector<Value> from_lagrange(int d, std::span<const Value> values) {
  checks::tetrahedron(d, values);
  return in_double_double(values, values.size(), [d](const DoubleDouble* in, DoubleDouble* out) {
    kernel::from_lagrange(d, in, out);
  });
}

void basis(int d, const Lambda& lambda, std::span<double> out) {
  checks::tetrahedron_degree(d);
  check_point(lambda);
  checks::size(out.size(), size_of(d), "places for basis values");
  kernel::basis(d, lambda, out.data());
}

#define BEZEL_INSTANTIATE(Value)                                                                  \
  template Value evaluate(int, std::span<const Value>, const Lambda&);                            \
  template ValueAndGradient<Value> evaluate_gradient(int, std::span<const Value>, const Lambda&); \
  template std::array<std::vector<Value>, 3> differentiate(int, std::span<const Value>);          \
  template std::vector<Value> specialize(int, std::span<const Value>,                             \
                                         const std::array<Lambda, 4>&);                           \
  template std::array<std::vector<Value>, 8> subdivide(int, std::span<const Value>);              \
  template std::vector<Value> elevate(int, std::span<const Value>, int);                          \
  template std::vector<Value> face(int, std::span<const Value>, int);                             \
  template std::vector<Value> to_lagrange(int, std::span<const Value>);                           \
  template std::vector<Value> from_lagrange(int, std::span<const Value>);
BEZEL_INSTANTIATE(double)
BEZEL_INSTANTIATE(Vec2)
BEZEL_INSTANTIATE(Vec3)
#undef BEZEL_INSTANTIATE

}  // namespace bezel::bernstein::tetrahedron
