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

/// Nodal interpolant of formulas of x and y (one per component) at the equally spaced nodes of each
/// element.
Field sample(std::string name, std::shared_ptr<const Space> space,
             std::span<const Formula> components);
/// L2 projection, quadrature exact for polynomials of degree 2*degree+extra in the space's own
/// coordinates.
Field project(std::string name, std::shared_ptr<const Space> space,
              std::span<const Formula> components, int extra = 6);

/// Integral of each component over the mesh (exact up to rounding; compensated sum).
std::vector<double> integral(const Field& field);
/// Integral of |f| of each component (quadrature).
std::vector<double> integral_abs(const Field& field);
std::vector<double> element_integrals(const Field& field);  ///< (elements, components)
double l2_norm(const Field& field);
/// Certified range of one component over the mesh, sharpened to rel_tol of the coefficient range.
bernstein::Range value_range(const Field& field, int component, double rel_tol = 1e-3);

struct ErrorNorms {
  double l2, l2_relative, max, h1_semi,
      integral;  ///< integral = integral of (field - exact); max: at quadrature and lattice points
};
/// Error of a field against formulas (one per component).
ErrorNorms error_norms(const Field& field, std::span<const Formula> exact, int extra = 8);

/// Evaluates a field at points of the plane (point location by a BVH over the elements).
class FieldEvaluator {
 public:
  explicit FieldEvaluator(Field field);
  ~FieldEvaluator();
  /// The element that holds p and the reference point; element invalid when outside.
  struct Place {
    ElementId element;
    Lambda lambda;
  };
  Place locate(const Vec2& p) const;
  /// out: (points, components); NaN outside the mesh or at NaN points.
  void evaluate(std::span<const Vec2> points, std::span<double> out) const;
  void gradient(std::span<const Vec2> points, std::span<double> out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bezel
