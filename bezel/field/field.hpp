#pragma once
// A field: a space and Bernstein coefficients per element.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/formula/formula.hpp"
#include "bezel/geometry/triangle.hpp"

namespace bezel {

/// A piecewise polynomial function on a mesh, with 1..9 components. Immutable.
///
/// Coefficient i of component c on element e: coefficients()[(space().offset(e) + i) * components()
/// + c].
class Field {
 public:
  static constexpr int max_components = 9;

  /// @throws InputError when the size is not coefficient_count()*components, a value is not finite
  /// (naming the
  ///         triangle), the name is empty, the space is null, or components is not 1..9
  Field(std::string name, std::shared_ptr<const Space> space, std::vector<double> coefficients,
        int components = 1);

  const std::string& name() const { return name_; }
  const Space& space() const { return *space_; }
  const std::shared_ptr<const Space>& space_ptr() const { return space_; }
  const TriangleMesh& mesh() const { return *space_->mesh(); }
  int components() const { return components_; }
  std::span<const double> coefficients() const { return coefficients_; }
  /// The element's coefficients, components interleaved.
  std::span<const double> coefficients(ElementId e) const;
  /// Value of every component at reference point lambda of element e (a physical basis maps the
  /// point itself).
  /// @param lambda  barycentric, sums to 1; outside the triangle it extrapolates
  /// @param out     components() values
  /// @throws InputError when the element does not exist or out has the wrong size
  /// @cost   O(d^2 + g^3) for the physical basis, O(d^2) for the reference basis; no allocation of
  /// its own
  void evaluate(ElementId e, const Lambda& lambda, std::span<double> out) const;
  /// Many points of one element, vectorised: out has shape (points, components).
  void evaluate(ElementId e, std::span<const Lambda> lambda, std::span<double> out) const;
  /// Gradient (d/dx, d/dy) of every component: out has 2*components values, zero for degree 0.
  /// @limits a reference basis divides by the Jacobian: infinite or NaN where the element is
  /// degenerate
  void gradient(ElementId e, const Lambda& lambda, std::span<double> out) const;
  Field renamed(std::string name) const;

 private:
  std::string name_;
  std::shared_ptr<const Space> space_;
  std::vector<double> coefficients_;
  int components_;
};

/// Nodal interpolant of formulas of x and y (one per component).
///
/// The nodes are the equally spaced ones of each reference triangle (the centroid for degree 0). A
/// reference basis interpolates in reference coordinates, a physical basis by the polynomial in x
/// and y through the nodes' images.
///
/// @param components  1..9 formulas of two variables
/// @param threads     0: all; the bits do not depend on it
/// @throws InputError naming triangle and point where a formula is not finite; NumericsError when
/// the images of the
///         nodes do not determine a polynomial in x and y (strongly curved elements)
Field sample(std::string name, std::shared_ptr<const Space> space,
             std::span<const Formula> components, int threads = 0);

/// L2 projection of formulas, with quadrature exact for polynomials of degree 2*degree+extra in the
/// space's own coordinates (times the Jacobian).
///
/// @param extra    0..60
/// @param threads  0: all; the bits do not depend on it
/// @throws InputError as sample(), and for an inverted or flat triangle
/// @accuracy polynomials of the space come back within about 1e-14 of their largest value
/// (docs/methods/field.md)
/// @cost     a small Cholesky per element; continuous: one sparse Cholesky, conjugate gradients
/// above 300000 dofs
Field project(std::string name, std::shared_ptr<const Space> space,
              std::span<const Formula> components, int extra = 6, int threads = 0);

/// Integral of each component over the mesh, exact up to rounding: a compensated sum of element
/// integrals.
std::vector<double> integral(const Field& field, int threads = 0);
/// Integral of |f| of each component: exact up to rounding on elements whose coefficients have one
/// sign and where f is linear on a straight triangle, elsewhere by quadrature on 16 pieces of the
/// element (relative error about 1e-3 of such an element's share).
std::vector<double> integral_abs(const Field& field, int threads = 0);
/// Integral of each component over each element, shape (elements, components), exact up to
/// rounding.
std::vector<double> element_integrals(const Field& field, int threads = 0);
/// Square root of the integral of the sum of squares of all components, exact up to rounding.
double l2_norm(const Field& field, int threads = 0);

/// An element's polynomial in reference coordinates.
struct ReferencePolynomial {
  int degree;
  std::vector<double> c;  ///< Bernstein coefficients, triangle_size(degree)
  double error_bound;     ///< on each coefficient, for the rounding of the composition; 0 for a
                          ///< reference basis
};
/// One component of a field on one element as a polynomial in reference coordinates: the
/// coefficients themselves for a reference basis, of degree d g for a physical basis (composition
/// with the element's map by de Casteljau).
/// @throws InputError when the element or component does not exist, or d g >
/// bernstein::max_triangle_degree
ReferencePolynomial reference_polynomial(const Field& field, ElementId e, int component);

/// Certified range of one component over the mesh: contains every value of the field.
/// @param rel_tol  each end lies within rel_tol (of the width of the coefficients' range) of the
/// true one (and not
///                 below the rounding of the values); 0: the coefficients' range. Where d g > 40 in
///                 a physical basis the search stops at 2^-12 of an element
/// @throws InputError for a component that does not exist or rel_tol outside [0, 1]
bernstein::Range value_range(const Field& field, int component, double rel_tol = 1e-3);

/// Norms of the error field - exact; several components count as one vector.
struct ErrorNorms {
  double l2;           ///< square root of the integral of the squared error
  double l2_relative;  ///< l2 / L2 norm of exact; 0 when both vanish, infinite when only the latter
                       ///< does
  double max;  ///< largest |error| of a component at quadrature and lattice points (a lower bound)
  double h1_semi;   ///< L2 norm of the gradient of the error, element by element
  double integral;  ///< integral of the sum of the components of the error
};
/// Error of a field against formulas (one per component), by quadrature exact for degree
/// 2*degree+extra.
/// @throws InputError when the number of formulas is not components(), or a formula or its gradient
/// is not finite
ErrorNorms error_norms(const Field& field, std::span<const Formula> exact, int extra = 8,
                       int threads = 0);

/// Evaluates a field at points of the plane (point location by a tree over the elements).
class FieldEvaluator {
 public:
  explicit FieldEvaluator(Field field);
  FieldEvaluator(FieldEvaluator&&) noexcept;
  FieldEvaluator& operator=(FieldEvaluator&&) noexcept;
  ~FieldEvaluator();

  const Field& field() const;

  /// The element that holds p and the reference point; element invalid when outside.
  struct Place {
    ElementId element;
    Lambda lambda;
  };
  /// The element of smallest number that holds p (up to 1e-12 in barycentrics), invalid when p is
  /// outside or not finite. A point on a common edge belongs to the neighbour with the smaller
  /// number.
  Place locate(const Vec2& p) const;
  /// Values at points: out has shape (points, components); NaN outside the mesh or at points that
  /// are not finite.
  /// @throws InputError when out has the wrong size
  void evaluate(std::span<const Vec2> points, std::span<double> out, int threads = 0) const;
  /// Gradients at points: out has shape (points, components, 2); NaN as above.
  void gradient(std::span<const Vec2> points, std::span<double> out, int threads = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bezel
