#pragma once
// Transfinite maps of quadrilaterals with four curved sides.

#include <span>
#include <string>
#include <vector>

#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/mesh/quad_mesh.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// The four sides of a quadrilateral by their values at the Gauss-Lobatto points (lobatto.hpp):
/// bottom and top from left to right, left and right from bottom to top.
struct QuadSides {
  std::vector<Vec2> bottom, right, top, left;
};

/// Where the Jacobian determinant is smallest and largest on a grid.
struct JacobianRange {
  double min = 0.0, max = 0.0;
  double xi = 0.0, eta = 0.0;  ///< of the smallest
  Vec2 point;                  ///< of the smallest
};
/// The range on a tensor grid of Gauss-Lobatto points of degree 3N (at most 180), for a map given
/// by its values at the nodes of a basis of degree N, xi running fastest. A check, not a proof: see
/// check_quad_validity for that.
JacobianRange jacobian_range(const LobattoBasis& basis, std::span<const Vec2> nodes);
/// @throws InputError when the smallest value is not positive: how large, and where.
///         @param element  named in the message; -1: none
void require_positive(const JacobianRange& range, ElementId element = {});

/// The map of Gordon and Hall from [-1, 1]^2 to the region inside four polynomial sides: linear
/// blending of opposite sides minus the bilinear map of the corners. A polynomial of the sides'
/// degree in each direction, kept by its values at the Gauss-Lobatto points.
class GordonHall {
 public:
  static constexpr int max_degree = 60;

  /// @param sides  2 to 61 points each, finite; sides of lower degree than the highest are raised
  /// @throws   InputError for a bad number of points, a value that is not finite, and corners that
  ///           do not meet within 1e-12 of the diameter of the points' box (the message says how
  ///           far apart they are). Folded maps are NOT refused here (see require_valid)
  /// @accuracy nodes within 12 u of the largest coordinate
  /// @cost     O(N^2)
  /// @source   [gordon1973]
  explicit GordonHall(const QuadSides& sides);

  int degree() const { return basis_.degree(); }
  const LobattoBasis& basis() const { return basis_; }
  /// (N+1)^2 points at (xi_i, eta_j): rows of constant eta, xi running fastest.
  std::span<const Vec2> nodes() const { return nodes_; }

  /// The point at (xi, eta), dimensionless; outside [-1, 1] it extrapolates.
  Vec2 operator()(double xi, double eta) const;
  /// x_xi y_eta - x_eta y_xi.
  /// @accuracy within 32 N^2 u r^2, r the largest coordinate: differentiating amplifies rounding
  double jacobian(double xi, double eta) const;

  /// bezel::jacobian_range of the map.
  JacobianRange jacobian_range() const { return bezel::jacobian_range(basis_, nodes_); }
  /// @throws InputError when the Jacobian determinant is not positive there: how large, and where
  void require_valid() const { require_positive(jacobian_range()); }

  /// Integral of the Jacobian determinant by the Gauss-Lobatto rule of degree N, exact up to
  /// rounding: the determinant has degree 2N-1 in each direction.
  double area() const;

  /// Bernstein control points (geometry/quadrilateral.hpp), with s = (1 + xi) / 2.
  /// @throws InputError above degree max_quad_degree
  std::vector<Vec2> control() const;

 private:
  LobattoBasis basis_;
  std::vector<Vec2> nodes_;
};

/// The four sides of a quadrilateral as curves: bottom and top from left to right, left and right
/// from bottom to top.
struct QuadCurves {
  PlaneCurve bottom, right, top, left;
};

/// The map whose sides interpolate four curves.
///
/// @param degree  of the sides and the map, 1..interpolator.max_degree()
/// @param method  standard and l2 take a side that is no graph over x as one over y
/// @throws   InputError as GordonHall, and when the method gives no interpolant of a side (naming
///           side and reason)
/// @limits   splitting at breakpoints is left to the caller: a side with a corner has several maps
GordonHall gordon_hall(const QuadCurves& curves, int degree, CurveMethod method,
                       const CurveInterpolator& interpolator);
/// The same with tables of its own.
GordonHall gordon_hall(const QuadCurves& curves, int degree,
                       CurveMethod method = CurveMethod::best);

/// One mesh of several maps. Corners within 1e-12 of the diameter become one node; sides between
/// the same corners whose control points agree within 1e-10 of it become one edge, with the control
/// points of the first. Maps of lower degree than the highest are raised.
///
/// @throws   InputError when there are no maps, a degree is above max_quad_degree, or a map is
///           folded on the grid of jacobian_range (naming the element)
QuadMesh join(std::span<const GordonHall> maps);

/// A QuadMesh element by its values at the Gauss-Lobatto points of its degree, ordered as
/// GordonHall::nodes().
std::vector<Vec2> lobatto_nodes(const QuadMesh& mesh, ElementId e, const LobattoBasis& basis);

}  // namespace bezel
