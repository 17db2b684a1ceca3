#pragma once
// Polynomial curves that interpolate a given curve: where on the curve the nodes go.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

constexpr int max_curve_degree = 30;

/// How the nodes g(t_0), ..., g(t_N) are placed. g is the curve, xi_j the Gauss-Lobatto points.
enum class CurveMethod {
  standard,             ///< x(t_j) affine in xi_j: the graph over x
  chord,                ///< projection onto the chord affine in xi_j
  arc_length,           ///< arc length affine in xi_j
  l2,                   ///< least error (4) over x: needs a graph
  equal_tangent,        ///< tangents of curve and interpolant parallel at the inner nodes
  orthogonal_distance,  ///< least mean square normal distance
  best,                 ///< the better of the two before, searched from several starts
};
/// "standard", "chord", "arc-length", "l2", "equal-tangent", "orthogonal-distance", "best".
std::string_view name(CurveMethod method);

enum class CurveStatus {
  ok,
  not_a_graph,      ///< standard, l2: x is not strictly monotone along the curve
  not_a_chord_map,  ///< chord: the projection onto the chord is not strictly monotone
  closed,           ///< chord: the end points coincide (standard, l2 then say not_a_graph)
  not_converged,    ///< equal tangent: no root found within 50 times the least distance seen; the
                    ///< nodes are those of that least distance
};
std::string_view name(CurveStatus status);

/// What kind of point of the search the nodes are.
enum class CurveKind {
  placed,               ///< by formula or by least error (4)
  equal_tangent,        ///< a root of the equal-tangent equations, to rounding
  orthogonal_distance,  ///< a (nearly) least mean square distance
};
std::string_view name(CurveKind kind);

/// How far an interpolant p is from the curve g. All are measured, none is a bound.
struct CurveErrors {
  double distance_l2 = 0.0;   ///< sqrt(int d^2 |p'| dxi), d = distance to the curve, 200 points
  double distance_max = 0.0;  ///< largest d of the same points
  double l2 = 0.0;  ///< error (4): sqrt(int (y - y_N)^2 dx), 3N+1 points; -1 when g is no graph
  double arc_length = 0.0;  ///< |length of g - length of p|
  double min_speed = 0.0;   ///< smallest |p'| / (length of g / 2) of the 200 points
  bool monotone = false;    ///< x_N is strictly monotone; otherwise l2 takes the nearest root
};

/// Parameters of the nodes, without control points and errors.
struct CurveNodes {
  CurveStatus status = CurveStatus::ok;
  CurveKind kind = CurveKind::placed;
  std::vector<double> t;        ///< -1 = t_0 < ... < t_N = 1; empty when nothing was found
  int newton_iterations = 0;    ///< of all degrees on the way, equal tangent
  int distance_iterations = 0;  ///< of all degrees on the way, least squares (l2 too)
  double residual = 0.0;        ///< largest |2 / L p' x tau| at an inner node, tau the unit tangent
};

template <int dim>
struct CurveInterpolant {
  CurveNodes nodes;
  std::vector<Vec<dim>> nodal;    ///< g(t_j), the values at the Gauss-Lobatto points
  std::vector<Vec<dim>> control;  ///< the same polynomial's Bezier control points on [0, 1]
  CurveErrors errors;
  bool ok() const { return nodes.status == CurveStatus::ok; }
  int degree() const { return static_cast<int>(nodal.size()) - 1; }
};

/// Tables for one largest degree, made once and used for many curves. Immutable after construction;
/// safe to use from several threads at once.
class CurveInterpolator {
 public:
  /// @throws   InputError unless 1 <= max_degree <= 30
  /// @cost     25 us for degree 5, 0.2 ms for degree 10, 5 ms for degree 30
  explicit CurveInterpolator(int max_degree = max_curve_degree);
  ~CurveInterpolator();
  CurveInterpolator(CurveInterpolator&&) noexcept;
  CurveInterpolator& operator=(CurveInterpolator&&) noexcept;
  CurveInterpolator(const CurveInterpolator&) = delete;
  CurveInterpolator& operator=(const CurveInterpolator&) = delete;
  int max_degree() const;

  /// Where the nodes go.
  ///
  /// @param degree  1..max_degree(); 1 has no choice
  /// @return   t empty when the status says that the method does not apply. The same curve gives
  ///           the same bits
  /// @throws   InputError when degree is out of range
  /// @accuracy standard, chord, arc_length: to rounding. equal_tangent: residual <= 1e-10. The
  ///           others are the best of a search, no proven minimum
  /// @cost     degrees 10 and 15: equal_tangent 15 and 40 us on smooth curves that are resolved,
  ///           best 20 to 60 us; 0.5 ms where it has to search, on curves of low regularity up to
  ///           10 ms (50 ms where it never gets exact), for a curve that takes 20 ns an evaluation.
  ///           Bounded: some 3000 Newton and as many least-squares steps
  /// @limits   one smooth part: breakpoints count for the length only (interpolate_pieces splits
  ///           there). Equal tangent in space is a least-squares solution, its residual not zero
  /// @source   [bjontegaard2009]; docs/methods/curves.md
  template <int dim>
  CurveNodes place(const SmoothCurve<dim>& curve, int degree, CurveMethod method) const;

  /// The interpolant with control points and errors; without them when the status is neither ok nor
  /// not_converged.
  template <int dim>
  CurveInterpolant<dim> interpolate(const SmoothCurve<dim>& curve, int degree,
                                    CurveMethod method = CurveMethod::best) const;

  /// Errors of the polynomial with these values at the Gauss-Lobatto points. The end points should
  /// be those of the curve; inner values may be anywhere near it.
  ///
  /// @param nodal  d + 1 points, 1 <= d <= max_degree(), finite
  /// @throws   InputError otherwise
  /// @accuracy distances: the nearer of the foot that continues from the point before and the foot
  ///           beside the nearest of the curve's samples; quadrature errors are seen where the
  ///           interpolant swings
  /// @cost     0.1 ms at degree 5, 0.3 ms at degree 30; the first for a degree 1 ms more
  template <int dim>
  CurveErrors errors(const SmoothCurve<dim>& curve, std::span<const Vec<dim>> nodal) const;

  /// Only the largest distance, of 8 d + 24 points: within 2 percent of what `errors` finds for
  /// good interpolants, at a fraction of the cost.
  template <int dim>
  double largest_distance(const SmoothCurve<dim>& curve, std::span<const Vec<dim>> nodal) const;

  struct Tables;

 private:
  std::unique_ptr<const Tables> tables_;
};

/// One interpolant, with its own tables. @param degree 1..30
///
/// @throws   InputError when degree is out of range
template <int dim>
CurveInterpolant<dim> interpolate_curve(const SmoothCurve<dim>& curve, int degree,
                                        CurveMethod method = CurveMethod::best);

/// A part of a curve and its interpolant.
template <int dim>
struct CurvePiece {
  double t0, t1;  ///< of the whole curve
  CurveInterpolant<dim> interpolant;
};

/// One interpolant per smooth part: the curve is split at its breakpoints.
///
/// @return   in ascending parameter; ends of neighbours are equal bit for bit
/// @throws   InputError as interpolate
template <int dim>
std::vector<CurvePiece<dim>> interpolate_pieces(const SmoothCurve<dim>& curve, int degree,
                                                CurveMethod method = CurveMethod::best);

struct AdaptiveCurveOptions {
  double tolerance = 1e-6;  ///< largest distance to the curve, in its length unit
  int max_pieces = 1000;    ///< but at least one per smooth part
};
template <int dim>
struct AdaptiveCurve {
  std::vector<CurvePiece<dim>> pieces;
  double distance_max = 0.0;  ///< largest of all pieces
  bool reached = false;       ///< distance_max <= tolerance
};
/// Few pieces within a distance: the curve is split at its breakpoints; each smooth part into the
/// longest pieces that keep the tolerance, from the left; then the tolerance is lowered as far as
/// the same number of pieces allows, which spreads the error.
///
/// @return   ascending, ends of neighbours equal bit for bit. Not `reached` when the pieces did not
///           suffice or the tolerance is below rounding (1e-15 of the length)
/// @throws   InputError as interpolate, and unless tolerance > 0 and max_pieces >= 1
template <int dim>
AdaptiveCurve<dim> interpolate_adaptive(const SmoothCurve<dim>& curve, int degree,
                                        const AdaptiveCurveOptions& options,
                                        CurveMethod method = CurveMethod::best);

}  // namespace bezel
