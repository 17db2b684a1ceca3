#pragma once
// Internal: integrals of many fields of one space; what depends on the elements only is done once.

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
/// @cost     one quadrature per element
std::vector<double> basis_integrals(const Space& space, int threads = 0);

/// element_integrals() from those of the basis functions.
std::vector<double> element_integrals(const Field& field, std::span<const double> basis_integrals,
                                      int threads = 0);

/// integral() from element_integrals().
std::vector<double> integral(const Field& field, std::span<const double> element_integrals);

/// integral_abs() from element_integrals(), of several fields of one space.
class AbsIntegral {
 public:
  explicit AbsIntegral(std::shared_ptr<const Space> space);
  /// @param element_integrals  of a field of that space
  std::vector<double> operator()(const Field& field, std::span<const double> element_integrals,
                                 int threads = 0) const;

 private:
  double on_element(const Field& field, ElementId e, std::size_t component, double integral,
                    std::span<double> scratch) const;

  std::shared_ptr<const Space> space_;
  std::vector<MapRule> pieces_;     // the rule on all pieces of an element, by degree
  std::vector<std::uint8_t> fits_;  // physical: the element lies in its frame, by element
};

}  // namespace bezel::field_detail
