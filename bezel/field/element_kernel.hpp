#pragma once
// Shared by the .cpp files of this module: an element with its polynomial, quadrature, sums,
// chunked loops.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/space.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/bent.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::field_detail {

inline constexpr int largest_size = bernstein::triangle_size(TriangleMesh::max_degree);
static_assert(TriangleMesh::max_degree >= Space::max_degree);

/// The map of an element at a point: x and the derivatives d/du, d/dv.
struct MapPoint {
  Vec2 x, du, dv;
  double det() const { return cross(du, dv); }
};

/// Gradient (d/dx, d/dy) from (d/du, d/dv).
inline Vec2 to_physical(const MapPoint& map, double du, double dv) {
  const double det = map.det();
  return {(du * map.dv.y() - dv * map.du.y()) / det, (dv * map.du.x() - du * map.dv.x()) / det};
}

/// An element's control points on the stack, and its map.
class ElementMap {
 public:
  ElementMap(const TriangleMesh& mesh, ElementId e) : degree_(mesh.degree()) {
    size_ = static_cast<std::size_t>(mesh.nodes_per_element());
    mesh.gather(e, {control_.data(), size_});
  }
  /// Moves the element to where it is round: integrals over it are the same there, and have all
  /// their digits.
  AreaMap make_round() {
    const AreaMap map = round_map(control());
    if (!map.identity)
      for (Vec2& p : std::span(control_).first(size_)) p = map(p);
    return map;
  }
  /// The same, and det() has all its digits on elements that no plane makes round, too.
  AreaMap make_round_for_det() {
    const auto given = control_;
    const AreaMap map = make_round();
    bent_jacobian_ = jacobian_if_bent(degree_, std::span(given).first(size_), control());
    return map;
  }
  int degree() const { return degree_; }
  std::span<const Vec2> control() const { return {control_.data(), size_}; }
  Vec2 operator()(const Lambda& lambda) const {
    return bernstein::evaluate<Vec2>(degree_, control(), lambda);
  }
  /// The Jacobian's determinant.
  double det(const Lambda& lambda) const {
    if (bent_jacobian_.empty()) return derivatives(lambda).det();
    return bernstein::evaluate<double>(2 * (degree_ - 1), bent_jacobian_, lambda);
  }
  MapPoint derivatives(const Lambda& lambda) const {
    const auto v = bernstein::evaluate_gradient<Vec2>(degree_, control(), lambda);
    return {v.value, v.du, v.dv};
  }

 private:
  int degree_;
  std::size_t size_;
  std::array<Vec2, static_cast<std::size_t>(largest_size)> control_;
  std::vector<double> bent_jacobian_;  // of an element that is bent, else empty
};

/// Where an element's polynomial is evaluated: the reference point itself, or the frame's
/// coordinates of its image.
inline Lambda own_lambda(const Space& space, ElementId e, const ElementMap& map,
                         const Lambda& lambda) {
  return space.basis() == Basis::reference ? lambda : space.frame(e).lambda(map(lambda));
}

/// Degree in reference coordinates of a polynomial of degree d in the space's own coordinates,
/// times the Jacobian.
inline int integrand_degree(const Space& space, int d) {
  const int g = space.mesh()->degree();
  return (space.basis() == Basis::physical ? d * g : d) + 2 * (g - 1);
}

/// A rule exact to `degree`: triangle_rule up to its limit 80, above it the product of Gauss rules
/// collapsed to the triangle (positive weights, interior points; n points per direction are exact
/// to degree 2n-2).
TriangleRule rule_of_degree(int degree);

/// Rules by degree, made once for the degrees that a space needs.
class RuleTable {
 public:
  /// One rule for each distinct element degree p: exact to degree_of(p).
  RuleTable(const Space& space, const std::function<int(int)>& degree_of);
  const TriangleRule& operator()(int p) const { return rule_[static_cast<std::size_t>(p)]; }

 private:
  std::array<TriangleRule, static_cast<std::size_t>(Space::max_degree) + 1> rule_;
};

/// Which degrees a space's elements have, ascending.
std::vector<int> degrees_of(const Space& space);

/// The corners of a straight triangle.
inline std::array<Vec2, 3> corners(const TriangleMesh& mesh, ElementId e) {
  const auto n = mesh.nodes(e);
  return {mesh.control(n[0]), mesh.control(n[1]), mesh.control(n[2])};
}

/// A frame of the same polynomial in another plane.
inline Frame moved(const AreaMap& map, const Frame& frame) {
  Frame there;
  there.centre = map(frame.centre);
  // The first says nothing that the others do not, and its rounding need not be small there.
  for (std::size_t k = 1; k < 3; ++k) there.gradient[k] = map.gradient(frame.gradient[k]);
  there.gradient[0] = -(there.gradient[1] + there.gradient[2]);
  return there;
}

/// Barycentrics 1 and 2 of points of the plane, in place.
inline void to_frame(const Frame& frame, std::span<double> x, std::span<double> y) {
  for (std::size_t q = 0; q < x.size(); ++q) {
    const double rx = x[q] - frame.centre.x(), ry = y[q] - frame.centre.y();
    x[q] = 1.0 / 3.0 + (frame.gradient[1].x() * rx + frame.gradient[1].y() * ry);
    y[q] = 1.0 / 3.0 + (frame.gradient[2].x() * rx + frame.gradient[2].y() * ry);
  }
}

/// Calls body(from, to) for chunks of n elements; small enough that every thread gets some.
inline void for_chunks(std::size_t n, int threads,
                       const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t chunk = 512;
  parallel_for((n + chunk - 1) / chunk,
               [&](std::size_t c) { body(c * chunk, std::min(n, (c + 1) * chunk)); }, threads);
}

/// Calls body(element) for all elements, 32 to a task.
inline void for_elements(const TriangleMesh& mesh, const std::function<void(ElementId)>& body,
                         int threads = 0) {
  constexpr std::size_t chunk = 32;
  const std::size_t n = mesh.element_count();
  parallel_for((n + chunk - 1) / chunk,
               [&](std::size_t c) {
                 for (std::size_t e = c * chunk; e < std::min(n, (c + 1) * chunk); ++e)
                   body(ElementId(e));
               },
               threads);
}

/// Equally spaced node n of degree d; the centroid for degree 0.
inline Lambda lattice_point(int d, int n) {
  if (d == 0) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  const std::array<int, 3> ijk = bernstein::triangle_multi_index(d, n);
  const double s = static_cast<double>(d);
  return {ijk[0] / s, ijk[1] / s, ijk[2] / s};
}

}  // namespace bezel::field_detail
