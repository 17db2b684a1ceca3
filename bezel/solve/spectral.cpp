#include "bezel/solve/spectral.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/fit/jacobian_grid.hpp"
#include "bezel/fit/tensor_grid.hpp"
#include "bezel/solve/function_value.hpp"

namespace bezel {
namespace {

using Index = Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// One quadrilateral: all of its boundary is the boundary.
QuadTopology single_topology() {
  return {{{{0, 1, 2, 3}, {0, 1, 2, 3}, {false, false, false, false}}},
          4,
          4,
          {true, true, true, true},
          {true, true, true, true}};
}

QuadTopology mesh_topology(const QuadMesh& mesh) {
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> vertex(mesh.node_count(), none);
  QuadTopology out;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto edges = mesh.edges(ElementId(e));
    QuadTopology::Element element{};
    for (std::size_t side = 0; side < 4; ++side) {
      std::size_t& number = vertex[mesh.corner(ElementId(e), static_cast<int>(side)).index()];
      if (number == none) number = out.vertices++;
      element.vertex[side] = number;
      element.edge[side] = edges[side].edge.index();
      element.reversed[side] = edges[side].reversed;
    }
    out.elements.push_back(element);
  }
  out.edges = mesh.edge_count();
  out.boundary_vertex.assign(out.vertices, false);
  out.boundary_edge.assign(out.edges, false);
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto adjacent = mesh.adjacent(EdgeId(e));
    if (adjacent.size() > 2)
      throw InputError(
          fmt::format("edge {} has {} elements, expected one or two", e, adjacent.size()));
    if (adjacent.size() == 2) continue;
    const auto nodes = mesh.edge_nodes(EdgeId(e));
    out.boundary_edge[e] = true;
    out.boundary_vertex[vertex[nodes.front().index()]] = true;
    out.boundary_vertex[vertex[nodes.back().index()]] = true;
  }
  return out;
}

/// Numbers of the nodes on vertices and edges, and which of them are on the boundary.
struct Skeleton {
  std::size_t size = 0;
  std::vector<std::size_t> global;  ///< per element: its boundary nodes, side by side, 4 N
  std::vector<bool> fixed;          ///< per number
};

Skeleton make_skeleton(const QuadTopology& topology, int degree) {
  Skeleton out;
  out.size = topology.skeleton_size(degree);
  for (std::size_t e = 0; e < topology.elements.size(); ++e)
    for (int side = 0; side < 4; ++side)
      for (int k = 0; k < degree; ++k)
        out.global.push_back(topology.skeleton_node(e, side, k, degree));
  out.fixed = topology.boundary_vertex;
  for (const bool boundary : topology.boundary_edge)
    out.fixed.insert(out.fixed.end(), static_cast<std::size_t>(degree) - 1, boundary);
  return out;
}

/// An element's matrix and load, its inner (i) and boundary (b) unknowns apart.
struct ElementSystem {
  Matrix ii, ib, bb;
  Vector load_i, load_b;
};

/// What is left of an element when its inner unknowns are eliminated: u_i = inner - lift u_b.
struct Condensed {
  Matrix lift, schur;
  Vector inner, load;
};

/// The nodes of an element, and their places among its inner or boundary nodes.
struct LocalNodes {
  std::size_t n;                      ///< per direction
  std::vector<Index> place;           ///< per node
  std::vector<bool> on_boundary;      ///< per node
  std::vector<std::size_t> boundary;  ///< nodes, side by side
  std::vector<std::size_t> inner;
};
LocalNodes local_nodes(int degree) {
  LocalNodes out;
  out.n = static_cast<std::size_t>(degree) + 1;
  out.place.assign(out.n * out.n, 0);
  out.on_boundary.assign(out.n * out.n, false);
  for (int side = 0; side < 4; ++side)
    for (int m = 0; m < degree; ++m) {
      const auto node = static_cast<std::size_t>(quad_side_index(degree, side, m));
      out.place[node] = static_cast<Index>(out.boundary.size());
      out.on_boundary[node] = true;
      out.boundary.push_back(node);
    }
  for (std::size_t node = 0; node < out.place.size(); ++node)
    if (!out.on_boundary[node]) {
      out.place[node] = static_cast<Index>(out.inner.size());
      out.inner.push_back(node);
    }
  return out;
}

double value_at(const PlaneFunction& function, const Vec2& p, const char* what) {
  return solve_detail::finite(function(p.x(), p.y()), p, what);
}

/// w a g11, w a g12, w a g22 at the nodes, w the weight of the rule, and w f J.
struct Coefficients {
  std::vector<double> g11, g12, g22, load;
};

Coefficients coefficients(const LobattoBasis& basis, const fit_detail::GridValues<Vec2>& x,
                          const PoissonProblem& problem, ElementId e) {
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  Coefficients out;
  for (std::size_t q = 0; q < n * n; ++q) {
    const Vec2 &dx = x.d_xi[q], &dy = x.d_eta[q], &p = x.value[q];
    const double det = cross(dx, dy);
    require_positive({det, det, basis.nodes()[q % n], basis.nodes()[q / n], p}, e);
    const double weight = basis.weights()[q % n] * basis.weights()[q / n];
    double a = 1.0;
    if (problem.coefficient) {
      a = value_at(problem.coefficient, p, "the coefficient");
      if (!(a > 0.0))
        throw InputError(fmt::format("the coefficient is {} at {}, expected above 0", a,
                                     solve_detail::place(p)));
    }
    out.g11.push_back(weight * a * dot(dy, dy) / det);
    out.g12.push_back(-weight * a * dot(dx, dy) / det);
    out.g22.push_back(weight * a * dot(dx, dx) / det);
    out.load.push_back(problem.source ? weight * det * value_at(problem.source, p, "the source")
                                      : 0.0);
  }
  return out;
}

/// The matrix of sum w (g11 u_xi v_xi + g12 (u_xi v_eta + u_eta v_xi) + g22 u_eta v_eta); with the
/// Lagrange polynomials at the nodes of the rule, sums over two indices collapse.
ElementSystem assemble(const LobattoBasis& basis, const LocalNodes& local, const Coefficients& c) {
  const std::size_t n = local.n;
  const auto inner = static_cast<Index>(local.inner.size());
  const auto boundary = static_cast<Index>(local.boundary.size());
  ElementSystem out{Matrix::Zero(inner, inner), Matrix::Zero(inner, boundary),
                    Matrix::Zero(boundary, boundary), Vector(inner), Vector(boundary)};
  const auto entry = [&](std::size_t v, std::size_t u) -> double* {
    const Index row = local.place[v], column = local.place[u];
    if (local.on_boundary[v]) return local.on_boundary[u] ? &out.bb(row, column) : nullptr;
    return local.on_boundary[u] ? &out.ib(row, column) : &out.ii(row, column);
  };
  const auto d = [&](std::size_t i, std::size_t k) {
    return basis.derivative(static_cast<int>(i), static_cast<int>(k));
  };
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t v = j * n + i;
      for (std::size_t k = 0; k < n; ++k) {
        double row = 0.0, column = 0.0;
        for (std::size_t p = 0; p < n; ++p) {
          row += c.g11[j * n + p] * d(p, i) * d(p, k);
          column += c.g22[p * n + i] * d(p, j) * d(p, k);
        }
        if (double* at = entry(v, j * n + k)) *at += row;
        if (double* at = entry(v, k * n + i)) *at += column;
      }
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t k = 0; k < n; ++k)
          if (double* at = entry(v, l * n + k))
            *at += c.g12[l * n + i] * d(i, k) * d(l, j) + c.g12[j * n + k] * d(k, i) * d(j, l);
      (local.on_boundary[v] ? out.load_b : out.load_i)(local.place[v]) = c.load[v];
    }
  return out;
}

/// Eliminates the inner unknowns. With `known` boundary values there is no need for more than them.
Condensed condense(const ElementSystem& system, const Vector* known) {
  const Eigen::LLT<Matrix> factor(system.ii);
  if (factor.info() != Eigen::Success)
    throw NumericsError("an element's matrix is not positive definite to rounding");
  Condensed out;
  if (known != nullptr) {
    out.inner = factor.solve(system.load_i - system.ib * *known);
    return out;
  }
  out.lift = factor.solve(system.ib);
  out.inner = factor.solve(system.load_i);
  out.schur = system.bb - system.ib.transpose() * out.lift;
  out.load = system.load_b - system.ib.transpose() * out.inner;
  return out;
}

/// Solves for the free values of the skeleton; `value` holds the fixed ones.
void solve_skeleton(const Skeleton& skeleton, const std::vector<Condensed>& elements,
                    std::size_t per_element, std::vector<double>& value) {
  std::vector<Index> unknown(skeleton.size, -1);
  Index count = 0;
  for (std::size_t k = 0; k < skeleton.size; ++k)
    if (!skeleton.fixed[k]) unknown[k] = count++;
  if (count == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Vector load = Vector::Zero(count);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Condensed& element = elements[e];
    if (element.schur.size() == 0) continue;  // all of it is fixed
    const std::size_t* global = skeleton.global.data() + e * per_element;
    for (std::size_t r = 0; r < per_element; ++r) {
      const Index row = unknown[global[r]];
      if (row < 0) continue;
      const auto at = static_cast<Index>(r);
      load(row) += element.load(at);
      for (std::size_t c = 0; c < per_element; ++c) {
        const double s = element.schur(at, static_cast<Index>(c));
        const Index column = unknown[global[c]];
        if (column < 0)
          load(row) -= s * value[global[c]];
        else if (column <= row)
          entries.emplace_back(row, column, s);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success)
    throw NumericsError("the matrix of the edges is not positive definite to rounding");
  const Vector solution = factor.solve(load);
  for (std::size_t k = 0; k < skeleton.size; ++k)
    if (unknown[k] >= 0) value[k] = solution(unknown[k]);
}

int checked_degree(int degree) {
  if (degree < 1 || degree > SpectralSolution::max_degree)
    throw InputError(fmt::format("a solution of degree {}, expected 1 to {}", degree,
                                 SpectralSolution::max_degree));
  return degree;
}

}  // namespace

class SpectralSolver {
 public:
  /// @param nodes  per element, of the map
  /// @param single  one map, which messages do not number
  static SpectralSolution solve(LobattoBasis map, std::vector<std::vector<Vec2>> nodes,
                                QuadTopology topology, bool single, const PoissonProblem& problem,
                                const SpectralOptions& options) {
    SpectralSolution out(LobattoBasis(options.degree), std::move(map));
    out.nodes_ = std::move(nodes);
    out.topology_ = std::move(topology);
    const Skeleton skeleton = make_skeleton(out.topology_, options.degree);
    const std::size_t count = out.nodes_.size();
    out.values_.resize(count);
    const LocalNodes local = local_nodes(options.degree);
    const std::size_t per_element = local.boundary.size();
    const fit_detail::LobattoSample at = options.degree == out.map_.degree()
                                             ? fit_detail::sample_at_nodes(out.map_)
                                             : fit_detail::sample(out.map_, out.basis_.nodes());

    std::vector<double> value(skeleton.size, 0.0);
    for (std::size_t e = 0; e < count; ++e) {
      const std::vector<Vec2> points = out.points(ElementId(e));
      for (std::size_t k = 0; k < per_element; ++k) {
        const std::size_t global = skeleton.global[e * per_element + k];
        if (skeleton.fixed[global])
          value[global] =
              value_at(problem.boundary, points[local.boundary[k]], "the boundary value");
      }
    }
    const auto on_boundary = [&](std::size_t e) {
      Vector known(static_cast<Index>(per_element));
      for (std::size_t k = 0; k < per_element; ++k)
        known(static_cast<Index>(k)) = value[skeleton.global[e * per_element + k]];
      return known;
    };

    const fit_detail::JacobianGrid grid(out.map_);
    std::vector<Condensed> elements(count);
    parallel_for(
        count,
        [&](std::size_t e) {
          const std::span<const Vec2> map_nodes(out.nodes_[e]);
          const ElementId id = single ? ElementId{} : ElementId(e);
          require_positive(grid.range(map_nodes), id);
          const auto x = fit_detail::evaluate_grid(at, map_nodes);
          const ElementSystem system =
              assemble(out.basis_, local, coefficients(out.basis_, x, problem, id));
          bool all_fixed = true;
          for (std::size_t k = 0; k < per_element; ++k)
            all_fixed = all_fixed && skeleton.fixed[skeleton.global[e * per_element + k]];
          const Vector known = on_boundary(e);
          elements[e] = condense(system, all_fixed ? &known : nullptr);
        },
        options.threads);
    solve_skeleton(skeleton, elements, per_element, value);

    out.unknowns_ = count * local.inner.size();
    for (std::size_t k = 0; k < skeleton.size; ++k) out.unknowns_ += skeleton.fixed[k] ? 0 : 1;
    for (std::size_t e = 0; e < count; ++e) {
      const Vector known = on_boundary(e);
      const Condensed& element = elements[e];
      const Vector inner =
          element.schur.size() == 0 ? element.inner : Vector(element.inner - element.lift * known);
      out.values_[e].resize(local.n * local.n);
      for (std::size_t node = 0; node < out.values_[e].size(); ++node)
        out.values_[e][node] = (local.on_boundary[node] ? known : inner)(local.place[node]);
    }
    return out;
  }
};

SpectralSolution solve_poisson(const GordonHall& map, const PoissonProblem& problem,
                               const SpectralOptions& options) {
  if (!problem.boundary) throw InputError("the boundary values are empty, expected a function");
  SpectralOptions chosen = options;
  chosen.degree = checked_degree(options.degree == 0 ? map.degree() : options.degree);
  return SpectralSolver::solve(map.basis(), {{map.nodes().begin(), map.nodes().end()}},
                               single_topology(), true, problem, chosen);
}

SpectralSolution solve_poisson(const QuadMesh& mesh, const PoissonProblem& problem,
                               const SpectralOptions& options) {
  if (!problem.boundary) throw InputError("the boundary values are empty, expected a function");
  if (mesh.element_count() == 0)
    throw InputError("the mesh has no elements, expected at least one");
  SpectralOptions chosen = options;
  chosen.degree = checked_degree(options.degree == 0 ? mesh.degree() : options.degree);
  const LobattoBasis map(mesh.degree());
  std::vector<std::vector<Vec2>> nodes;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    nodes.push_back(lobatto_nodes(mesh, ElementId(e), map));
  return SpectralSolver::solve(map, std::move(nodes), mesh_topology(mesh), false, problem, chosen);
}

}  // namespace bezel
