#pragma once
// Internal: integrals of many fields of one space; what depends on the elements only is done once.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::field_detail {

/// An element's map at the points of a rule: the map's basis functions are tabulated once.
class MapTable {
 public:
  MapTable() = default;
  MapTable(int degree, std::span<const Lambda> points);
  std::size_t size() const { return points_; }

  /// Images of the points and Jacobian determinants there, size() each.
  void operator()(std::span<const Vec2> control, std::span<double> x, std::span<double> y,
                  std::span<double> det) const;

 private:
  std::size_t points_ = 0;
  std::vector<double> value_, du_, dv_;  // [node][point]
};

/// A rule's points, filled up to whole vectors with points of weight 0, and the map there.
struct MapRule {
  MapRule() = default;
  MapRule(int map_degree, const TriangleRule& rule);
  std::vector<double> u, v, weight;
  MapTable map;
};

/// Integral of each basis function over its element, in the order of the coefficients.
/// @accuracy each within about 20 u of itself, and of the largest where a frame does not hold its
///           element
/// @cost     in a physical basis on curved elements a quadrature along the sides, measured 0.4 us
/// an
///           element of degree 3 with functions of degree 3; else less
std::vector<double> basis_integrals(const Space& space, int threads = 0);

/// How many components some fields have together. Below, those of several fields of one space are
/// numbered one field after the other.
std::size_t component_count(std::span<const Field* const> fields);

/// integral() of each component, from the integrals over elements, shape (elements, components).
std::vector<double> integral(std::span<const double> element_integrals, std::size_t components);

/// Integrals of |f| over the elements of one space.
class AbsIntegral {
 public:
  explicit AbsIntegral(std::shared_ptr<const Space> space, int threads = 0);

  /// Of one component on an element.
  /// @param c            its coefficients, `stride` apart
  /// @param least, most  of them
  /// @param integral     of f
  /// @param scratch      room() numbers
  double operator()(std::size_t e, const double* c, std::size_t stride, double least, double most,
                    double integral, std::span<double> scratch) const {
    if ((least >= 0.0 || most <= 0.0) && shape(e) != Shape::beyond_frame) return std::abs(integral);
    return of_both_signs(e, c, stride, integral, scratch);
  }
  std::size_t room() const;

 private:
  double of_both_signs(std::size_t e, const double* c, std::size_t stride, double integral,
                       std::span<double> scratch) const;

  /// Whether coefficients of one sign say that of f (not where an element reaches out of a frame
  /// given by the caller), and whether f is a polynomial in a straight triangle's own coordinates.
  enum class Shape : std::uint8_t { beyond_frame, inside_frame, straight };
  Shape shape(std::size_t e) const { return shape_.empty() ? plain_ : shape_[e]; }

  std::shared_ptr<const Space> space_;
  std::vector<MapRule> pieces_;  // the rule on all pieces of an element, by degree
  Shape plain_;                  // of all elements in reference coordinates
  std::vector<Shape> shape_;     // in a physical basis, by element
};

}  // namespace bezel::field_detail
