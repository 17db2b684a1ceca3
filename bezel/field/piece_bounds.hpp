#pragma once
// Internal: bounds of an element's polynomial from coefficients on the element or its pieces.

#include <span>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel::field_detail {

/// @throws InputError when the component does not exist
void check_component(const Field& field, int component);
/// Coefficients of one component. @throws InputError when the element does not exist
std::vector<double> component_of(const Field& field, ElementId e, int component);
/// The largest magnitude; 0 when there is none.
double largest(std::span<const double> c);
/// Whether the polynomial in reference coordinates has a degree that is supported.
bool composable(const Field& field, ElementId e);

/// What is known of the values on one element.
struct Known {
  double lo, hi;                    // no value lies outside
  double attained_lo, attained_hi;  // values at corners, within `slack`
  double slack;
};
Known known_from(std::span<const double> c, int d, double slack);

/// Bounds of a polynomial in x and y on a piece of an element: its coefficients on the smallest
/// triangle with sides parallel to the frame's that holds the piece's control points. Used where
/// the composition's degree is too high, and for a first look.
class PieceBounds {
 public:
  /// @param g  degree of the element's map
  /// @param c  coefficients of degree d on the frame
  PieceBounds(const Frame& frame, int g, int d, std::vector<double> c);

  Known operator()(std::span<const Vec2> control) const;

  /// Both ends within tol where 2^-12 of the element suffices.
  bernstein::Range range(const std::vector<Vec2>& control, double tol) const;

 private:
  Frame frame_;
  int g_, d_;
  std::vector<double> c_;
  double scale_;
};

PieceBounds piece_bounds(const Field& field, ElementId e, int component);

}  // namespace bezel::field_detail
