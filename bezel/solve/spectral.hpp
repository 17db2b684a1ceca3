#pragma once
// Elliptic equations on curved quadrilaterals by spectral elements at Gauss-Lobatto points.

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/fit/gordon_hall.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/mesh/quad_mesh.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A function of x and y, such as a Formula of these two variables. Called from several threads at
/// once.
using PlaneFunction = std::function<double(double, double)>;
/// A vector field in the plane: (x, y) -> (d/dx, d/dy).
using PlaneGradient = std::function<Vec2(double, double)>;

/// -div(a grad u) = f inside, u given on the boundary.
struct PoissonProblem {
  PlaneFunction boundary;          ///< u on the boundary
  PlaneFunction source = {};       ///< f; empty: 0
  PlaneFunction coefficient = {};  ///< a > 0; empty: 1
};

struct SpectralOptions {
  int degree = 0;   ///< of the solution, 1..SpectralSolution::max_degree; 0: that of the map
  int threads = 0;  ///< 0: all; the bits do not depend on it
};

/// Errors against a known solution, over the mapped region.
struct SpectralErrors {
  double energy = 0.0;  ///< sqrt of the integral of |grad (u - u_N)|^2
  double l2 = 0.0;      ///< sqrt of the integral of (u - u_N)^2
  double max = 0.0;     ///< largest |u - u_N| at the points used
};

/// Value of a solution at a place.
struct SpectralValue {
  Vec2 point;
  double value;
  Vec2 gradient;  ///< with respect to x and y
};

/// The vertices and edges of quadrilaterals, as a solver numbers them.
struct QuadTopology {
  struct Element {
    std::array<std::size_t, 4> vertex, edge;  ///< corner 0..3, side 0..3
    std::array<bool, 4> reversed;             ///< the side runs against its edge
  };
  std::vector<Element> elements;
  std::size_t vertices = 0, edges = 0;
  std::vector<bool> boundary_vertex, boundary_edge;

  /// Number of nodes on vertices and edges when an edge has m intervals.
  std::size_t skeleton_size(int m) const {
    return vertices + edges * static_cast<std::size_t>(m - 1);
  }
  /// Number of the k-th node (0..m) of an element's side.
  std::size_t skeleton_node(std::size_t element, int side, int k, int m) const;
};

/// A continuous piecewise polynomial on mapped quadrilaterals, by its values at the Gauss-Lobatto
/// points of each element (ordered as GordonHall::nodes()).
class SpectralSolution {
 public:
  static constexpr int max_degree = 60;

  int degree() const { return basis_.degree(); }
  std::size_t element_count() const { return values_.size(); }
  /// Number of unknowns: nodes that are not on the boundary.
  std::size_t unknown_count() const { return unknowns_; }
  /// (N+1)^2 values. @throws InputError when the element does not exist (as all functions here)
  std::span<const double> values(ElementId e) const;
  /// (N+1)^2 points of the same nodes.
  std::vector<Vec2> points(ElementId e) const;
  const QuadTopology& topology() const { return topology_; }
  /// Value and gradient at (xi, eta) of an element, dimensionless; outside [-1, 1] it extrapolates.
  /// @cost O(N^2)
  SpectralValue evaluate(ElementId e, double xi, double eta) const;

  /// Errors by Gauss-Lobatto quadrature on each element.
  ///
  /// @param degree  of the rule's points, 1..180; 0: three times that of the solution
  /// @throws   InputError when a function is empty or not finite at a point (saying where)
  SpectralErrors errors(const PlaneFunction& exact, const PlaneGradient& exact_gradient,
                        int degree = 0) const;

  /// The solution as a field on curved triangles, for files, pictures and transfer: every element
  /// is cut into cells x cells squares and these into two triangles each, on which map and solution
  /// are interpolated at equally spaced points of the reference square.
  ///
  /// @param cells   >= 1, at most 1e6 triangles in all
  /// @param degree  of triangles and field, 1..10
  /// @return   a continuous field on a conforming mesh (neighbours share control points); at most
  ///           as accurate as its degree, not proven to be valid (see check_validity)
  /// @accuracy the error of interpolation; rounding is magnified by up to 2^degree
  Field field(const std::string& name, int cells, int degree) const;

 private:
  friend class SpectralSolver;
  SpectralSolution(LobattoBasis basis, LobattoBasis map)
      : basis_(std::move(basis)), map_(std::move(map)) {}
  std::size_t checked(ElementId e) const;

  LobattoBasis basis_, map_;                 // of the values and of the elements' maps
  std::vector<std::vector<Vec2>> nodes_;     // per element, of the map
  std::vector<std::vector<double>> values_;  // per element
  QuadTopology topology_;
  std::size_t unknowns_ = 0;
};

/// Solves the Dirichlet problem on one mapped quadrilateral.
///
/// Galerkin's method with polynomials of degree N in each direction of the reference square and
/// Gauss-Lobatto quadrature of the same degree; the boundary values are those of `boundary` at the
/// mapped boundary nodes.
///
/// @throws   InputError for an empty boundary function, a bad degree, functions that are not finite
///           at a node or a coefficient that is not positive (saying where), and a map whose
///           Jacobian determinant is not positive on the grid of GordonHall::jacobian_range;
///           NumericsError when the system is not positive definite to rounding
/// @accuracy e^x sin y on [-1, 1]^2: energy error 3.4e-7 at N = 8, 1.8e-12 at N = 12
/// @cost     a dense Cholesky factorisation of the (N-1)^2 unknowns: 0.25 ms at N = 8, 2.6 ms at
///           N = 16, 13 ms at N = 24, 2 s at N = 48
/// @source   [bjontegaard2009, sec. 3]
SpectralSolution solve_poisson(const GordonHall& map, const PoissonProblem& problem,
                               const SpectralOptions& options = {});

/// The same on a mesh of several quadrilaterals, continuous across edges. The inner unknowns of
/// each element are eliminated first; what remains on the edges is solved by a sparse Cholesky
/// factorisation.
///
/// @throws   InputError also when an edge has more than two elements
/// @limits   the mesh is conforming: a vertex inside another element's side is on the boundary
SpectralSolution solve_poisson(const QuadMesh& mesh, const PoissonProblem& problem,
                               const SpectralOptions& options = {});

}  // namespace bezel
