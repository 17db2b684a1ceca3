#pragma once
// Points and vectors of a fixed small dimension.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bezel {

/// A point or vector with `dim` coordinates.
template <int dim, class Scalar = double>
struct Vec {
  std::array<Scalar, static_cast<std::size_t>(dim)> c{};

  constexpr Scalar& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
  constexpr const Scalar& operator[](int i) const { return c[static_cast<std::size_t>(i)]; }
  constexpr const Scalar& x() const { return c[0]; }
  constexpr const Scalar& y() const { return c[1]; }
  friend constexpr bool operator==(const Vec&, const Vec&) = default;

  constexpr Vec& operator+=(const Vec& b) {
    for (int i = 0; i < dim; ++i) (*this)[i] += b[i];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& b) {
    for (int i = 0; i < dim; ++i) (*this)[i] -= b[i];
    return *this;
  }
  constexpr Vec& operator*=(const Scalar& s) {
    for (int i = 0; i < dim; ++i) (*this)[i] *= s;
    return *this;
  }
  friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
  friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
  friend constexpr Vec operator-(Vec a) { return a *= Scalar(-1); }
  friend constexpr Vec operator*(Vec a, const Scalar& s) { return a *= s; }
  friend constexpr Vec operator*(const Scalar& s, Vec a) { return a *= s; }
};

using Vec2 = Vec<2>;
using Vec3 = Vec<3>;

template <int dim, class Scalar>
constexpr Scalar dot(const Vec<dim, Scalar>& a, const Vec<dim, Scalar>& b) {
  Scalar sum = a[0] * b[0];
  for (int i = 1; i < dim; ++i) sum += a[i] * b[i];
  return sum;
}
/// a x b in the plane: a1 b2 - a2 b1, positive when b is counter-clockwise of a.
template <class Scalar>
constexpr Scalar cross(const Vec<2, Scalar>& a, const Vec<2, Scalar>& b) {
  return a[0] * b[1] - a[1] * b[0];
}
template <int dim>
double norm(const Vec<dim>& a) {
  return std::sqrt(dot(a, a));
}

/// An axis-parallel box; empty (lo > hi) when default constructed.
template <int dim>
struct Box {
  Vec<dim> lo, hi;

  constexpr Box() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (int i = 0; i < dim; ++i) {
      lo[i] = infinity;
      hi[i] = -infinity;
    }
  }
  constexpr bool empty() const { return !(lo[0] <= hi[0]); }
  constexpr void include(const Vec<dim>& p) {
    for (int i = 0; i < dim; ++i) {
      if (p[i] < lo[i]) lo[i] = p[i];
      if (p[i] > hi[i]) hi[i] = p[i];
    }
  }
  constexpr void include(const Box& b) {
    include(b.lo);
    include(b.hi);
  }
  constexpr bool overlaps(const Box& b) const {
    for (int i = 0; i < dim; ++i)
      if (!(lo[i] <= b.hi[i] && b.lo[i] <= hi[i])) return false;
    return true;
  }
  constexpr bool contains(const Vec<dim>& p) const {
    for (int i = 0; i < dim; ++i)
      if (!(lo[i] <= p[i] && p[i] <= hi[i])) return false;
    return true;
  }
  constexpr Vec<dim> centre() const { return 0.5 * (lo + hi); }
  double diameter() const { return empty() ? 0.0 : norm(hi - lo); }
};
using Box2 = Box<2>;

}  // namespace bezel
