#pragma once
// Spaces of piecewise polynomials on a mesh.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel {

/// In which coordinates an element's polynomial lives.
enum class Basis {
  reference,  ///< mapped, isoparametric ("pre-image basis"): polynomial in the reference triangle's
              ///< coordinates
  physical  ///< "global-coordinates basis": polynomial in x and y, Bernstein form on the element's
            ///< Frame
};
enum class Continuity { discontinuous, continuous };

/// The affine triangle on which a physical-basis element's Bernstein polynomial is written:
/// lambda_k(x) = 1/3 + gradient[k] . (x - centre), gradient[0] + gradient[1] + gradient[2] = 0.
struct Frame {
  Vec2 centre;
  std::array<Vec2, 3> gradient;
  /// Barycentric coordinates of a point; negative outside the frame. The first is 1 minus the
  /// others, so that they sum to 1 within u even on razor-thin frames, where rounding in the
  /// products would scale a polynomial's value.
  std::array<double, 3> lambda(const Vec2& x) const {
    const Vec2 r = x - centre;
    const double l1 = 1.0 / 3.0 + dot(gradient[1], r), l2 = 1.0 / 3.0 + dot(gradient[2], r);
    return {1.0 - l1 - l2, l1, l2};
  }
  /// The point with the given barycentric coordinates (sum 1): the inverse of lambda().
  Vec2 point(const std::array<double, 3>& lambda) const;
  /// The three corners, counter-clockwise for a frame made by element_frame().
  std::array<Vec2, 3> corners() const;
  friend bool operator==(const Frame&, const Frame&) = default;
};

/// The frame a physical basis uses for an element: a triangle that fits it closely and holds its
/// control points.
///
/// An affine map gives the control points covariance 1; there the frame is the smallest equilateral
/// triangle around them whose three corners point along their third moment, corner 0 nearest to the
/// first control point. So it is the element itself when that is straight, varies continuously with
/// the control points, commutes with affine maps, and needs no corner triangle (which may be
/// degenerate on a curved element). Bernstein polynomials on it are as well conditioned as the
/// reference ones: a frame twice too large costs a factor 4^degree in the mass matrix.
///
/// @param control  control points of the element, finite, not all equal
/// @throws InputError when control is empty, a value is not finite, or all points coincide
/// @accuracy barycentrics of the control points lie within -1e-14 .. 1 + 1e-14 at moderate size and
/// distance from the
///           origin; rounding adds 4u |x| / (smallest height of the element)
Frame element_frame(std::span<const Vec2> control);

/// Basis, degree per element, continuity and the map coefficients = A * dofs. Immutable; cheap to
/// share.
///
/// Elements are numbered as in the mesh; element e owns coefficients offset(e) .. offset(e) +
/// triangle_size(degree(e)).
class Space {
 public:
  static constexpr int max_degree = 10;

  /// Discontinuous, the same degree on every element.
  /// @param degree  0..max_degree
  /// @throws InputError for a null mesh, a bad degree, or (physical basis) an element without
  /// extent
  static std::shared_ptr<const Space> discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                    int degree, Basis basis = Basis::reference,
                                                    int threads = 0);
  /// Discontinuous, a degree per element.
  /// @param degrees  one per element, each 0..max_degree
  /// @throws InputError as above, naming the triangle; or when the number of degrees is wrong
  static std::shared_ptr<const Space> discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                    std::vector<int> degrees,
                                                    Basis basis = Basis::reference);
  /// Discontinuous physical basis with the frames given (the native file format restores them
  /// exactly).
  /// @param frames  one per element: finite, gradients that add up to zero and are not parallel
  /// @throws InputError as above, naming the triangle
  static std::shared_ptr<const Space> discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                    std::vector<int> degrees,
                                                    std::vector<Frame> frames);
  /// Continuous (C0) space. Dofs are the Bernstein coefficients that elements share: those of the
  /// vertices by ascending NodeId, then degree-1 per edge in the edge's canonical direction, then
  /// the interior ones by element.
  /// @param degree  1..max_degree
  /// @param basis   Basis::reference; a polynomial of degree p in x and y has degree p g along a
  /// curved edge, which
  ///                the p+1 coefficients of the edge do not determine
  /// @throws InputError for a null mesh, a bad degree, the physical basis, or hanging vertices
  static std::shared_ptr<const Space> continuous(std::shared_ptr<const TriangleMesh> mesh,
                                                 int degree, Basis basis = Basis::reference);

  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
  Basis basis() const { return basis_; }
  Continuity continuity() const { return continuity_; }
  int degree(ElementId e) const {
    return uniform_degree_ >= 0 ? uniform_degree_ : degrees_[e.index()];
  }
  int uniform_degree() const { return uniform_degree_; }  ///< -1 when it varies
  int highest_degree() const { return highest_degree_; }
  /// Position of the element's first coefficient; element e holds triangle_size(degree(e)) of them.
  std::size_t offset(ElementId e) const;
  std::size_t coefficient_count() const { return coefficient_count_; }
  /// Number of degrees of freedom (equals coefficient_count() when discontinuous).
  std::size_t dof_count() const { return dof_count_; }
  /// Global dof of each coefficient of an element (size triangle_size(degree); empty when
  /// discontinuous).
  std::span<const std::int32_t> dofs(ElementId e) const;
  const Frame& frame(ElementId e) const { return frames_[e.index()]; }  ///< physical basis only
  std::span<const Frame> frames() const { return frames_; }
  /// Whether the element is straight and its frame is the element itself, up to the rounding of
  /// barycentric coordinates at its place in the plane (physical basis; else false).
  bool is_own_frame(ElementId e) const {
    return own_frames_ || (!own_frame_.empty() && own_frame_[e.index()] != 0);
  }
  /// Whether that is so for all elements.
  bool has_own_frames() const { return own_frames_; }

  /// Element coefficients from dofs, components interleaved (a copy when discontinuous).
  /// @param dofs  shape (dof_count(), components)
  /// @return      shape (coefficient_count(), components)
  /// @throws InputError when the size is wrong or components < 1
  std::vector<double> expand(std::span<const double> dofs, int components = 1) const;

 private:
  Space() = default;
  static std::shared_ptr<Space> uniform(std::shared_ptr<const TriangleMesh> mesh, int degree);
  static std::shared_ptr<Space> by_element(std::shared_ptr<const TriangleMesh> mesh,
                                           std::vector<int> degrees);
  void make_frames(int threads);
  void compare_frames(int threads);

  std::shared_ptr<const TriangleMesh> mesh_;
  Basis basis_ = Basis::reference;
  Continuity continuity_ = Continuity::discontinuous;
  int uniform_degree_ = -1;
  int highest_degree_ = 0;
  std::vector<int> degrees_;
  std::vector<std::size_t> offsets_;
  std::size_t coefficient_count_ = 0, dof_count_ = 0;
  std::vector<std::int32_t> dofs_;
  std::vector<Frame> frames_;
  bool own_frames_ = false;
  std::vector<std::uint8_t> own_frame_;  // by element where some are and some are not
};

}  // namespace bezel
