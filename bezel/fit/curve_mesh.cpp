#include "bezel/fit/curve_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/fit/boundary_match.hpp"
#include "bezel/fit/lattice_relaxation.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/bend.hpp"
#include "bezel/mesh/edge_finder.hpp"
#include "bezel/mesh/raised_nodes.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::at;

std::string place_of(const Vec2& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ")";
}

class Curving {
 public:
  Curving(const TriangleMesh& straight, std::span<const SmoothCurve<2>> curves,
          const CurveMeshOptions& options)
      : straight_(straight),
        curves_(curves),
        options_(options),
        g_(options.degree),
        interpolator_(options.degree),
        basis_(options.degree),
        vertex_(straight.control().begin(), straight.control().end()),
        bend_(straight.edge_count() * at(g_ - 1)),
        nodes_(straight, options.degree),
        elements_(nodes_.elements()) {}

  CurvedMesh run() {
    match();
    move_vertices();
    for (std::size_t i = 0; i < parts_.size(); ++i) bend_edge(i);
    std::vector<Vec2> control = blended();
    std::vector<ElementId> invalid = invalid_elements(control);
    int used = 0;
    for (const int steps : {1, 4, 16}) {
      if (invalid.empty()) break;
      std::vector<Vec2> relaxed = relax(control, steps);
      std::vector<ElementId> left = invalid_elements(relaxed);
      if (left.size() >= invalid.size()) continue;
      control = std::move(relaxed);
      invalid = std::move(left);
      used = steps;
    }
    CurvedMesh out{.mesh = TriangleMesh(g_, std::move(control), std::move(elements_), tags()),
                   .edges = {},
                   .relaxation_steps = used,
                   .invalid = std::move(invalid)};
    out.straight_edges = straight_edges_;
    out.largest_move = largest_move_;
    double squares = 0.0;
    for (const FittedEdge& edge : edges_) {
      out.distance_max = std::max(out.distance_max, edge.errors.distance_max);
      squares += edge.errors.distance_l2 * edge.errors.distance_l2;
    }
    out.distance_l2 = std::sqrt(squares);
    out.edges = std::move(edges_);
    return out;
  }

 private:
  struct EdgePart {
    EdgeId edge;
    fit::CurvePart part;
  };

  /// The curve of every boundary edge.
  void match() {
    const double tolerance = options_.tolerance * straight_.box().diameter();
    std::vector<fit::CurveFeet> feet;
    feet.reserve(curves_.size());
    for (const SmoothCurve<2>& curve : curves_) feet.emplace_back(curve);
    for (std::size_t e = 0; e < straight_.edge_count(); ++e) {
      const EdgeId edge(e);
      if (!straight_.is_boundary(edge)) continue;
      const auto nodes = straight_.edge_nodes(edge);
      const auto part =
          fit::find_part(feet, vertex_[nodes[0].index()], vertex_[nodes[1].index()], tolerance);
      if (part) {
        parts_.push_back({edge, *part});
      } else {
        ++straight_edges_;
      }
    }
    if (parts_.empty())
      throw InputError("none of " + std::to_string(straight_edges_) +
                       " boundary edges lies on a curve, expected the vertices of some within " +
                       std::to_string(options_.tolerance) + " of the mesh's diagonal of one");
  }

  /// Vertices onto their curves; where two curves meet they must agree.
  void move_vertices() {
    const double diameter = straight_.box().diameter();
    std::vector<int> mover(vertex_.size(), -1);
    std::vector<Vec2> target = vertex_;
    for (const EdgePart& p : parts_) {
      const auto nodes = straight_.edge_nodes(p.edge);
      const SmoothCurve<2>& curve = curves_[p.part.curve];
      for (const int end : {0, 1}) {
        const std::size_t v = nodes[at(end)].index();
        const Vec2 place = curve((end == 0) == p.part.reversed ? p.part.t1 : p.part.t0).x;
        if (mover[v] < 0) {
          mover[v] = static_cast<int>(p.part.curve);
          target[v] = place;
          largest_move_ = std::max(largest_move_, norm(place - vertex_[v]));
        } else if (const double gap = norm(place - target[v]); gap > 1e-9 * diameter) {
          throw InputError("vertex " + std::to_string(v) + " at " + place_of(vertex_[v]) +
                           ": curves " + std::to_string(mover[v]) + " and " +
                           std::to_string(p.part.curve) + " pass it " + std::to_string(gap) +
                           " apart, expected curves that meet");
        }
      }
    }
    vertex_ = std::move(target);
  }

  /// Displacements of an edge's inner control points from its chord.
  void bend_edge(std::size_t i) {
    const auto& [edge, part] = parts_[i];
    const SmoothCurve<2> curve = fit::cut(curves_[part.curve], part);
    std::vector<Vec2> control;
    CurveErrors errors;
    if (options_.equal_parameter) {
      std::vector<Vec2> nodes;
      for (int m = 0; m <= g_; ++m) nodes.push_back(curve(-1.0 + 2.0 * m / g_).x);
      control = bernstein::from_lagrange<Vec2>(nodes);
      std::vector<Vec2> nodal;
      for (const double xi : basis_.nodes())
        nodal.push_back(bernstein::evaluate<Vec2>(control, 0.5 * (1.0 + xi)));
      errors = interpolator_.errors<2>(curve, nodal);
    } else {
      CurveInterpolant<2> found = interpolator_.interpolate(curve, g_, options_.method);
      if (found.control.empty()) {
        const auto nodes = straight_.edge_nodes(edge);
        throw InputError("edge from " + place_of(vertex_[nodes[0].index()]) + " to " +
                         place_of(vertex_[nodes[1].index()]) + " on curve " +
                         std::to_string(part.curve) + ": " + std::string(name(found.nodes.status)) +
                         ", which the method " + std::string(name(options_.method)) + " cannot do");
      }
      control = std::move(found.control);
      errors = found.errors;
    }
    if (part.reversed) std::reverse(control.begin(), control.end());
    const auto nodes = straight_.edge_nodes(edge);
    const Vec2 a = vertex_[nodes[0].index()], b = vertex_[nodes[1].index()];
    for (int m = 1; m < g_; ++m)
      bend(edge)[m - 1] = control[at(m)] - (a + (static_cast<double>(m) / g_) * (b - a));
    edges_.push_back({edge, part.curve, part.t0, part.t1, errors});
  }

  Vec2* bend(EdgeId edge) { return bend_.data() + edge.index() * at(g_ - 1); }
  bool bent(EdgeId edge) {
    return std::any_of(bend(edge), bend(edge) + (g_ - 1),
                       [](const Vec2& d) { return d != Vec2{}; });
  }

  /// Control points of the straight mesh, whose vertices are given, raised to degree g.
  std::vector<Vec2> raised(std::span<const Vec2> vertices) const {
    const std::size_t size = at(bernstein::triangle_size(g_));
    std::vector<Vec2> control(nodes_.count());
    std::copy(vertices.begin(), vertices.end(), control.begin());
    for (std::size_t e = 0; e < straight_.element_count(); ++e) {
      const auto corner = straight_.nodes(ElementId(e));
      const Vec2 &a = vertices[corner[0].index()], &b = vertices[corner[1].index()],
                 &c = vertices[corner[2].index()];
      for (int k = 0; k <= g_; ++k)
        for (int j = 0; j <= g_ - k; ++j) {
          const int n = bernstein::triangle_index(g_, j, k);
          const std::size_t node = elements_[e * size + at(n)].index();
          if (node >= vertices.size())
            control[node] = (1.0 / g_) * (static_cast<double>(g_ - j - k) * a +
                                          static_cast<double>(j) * b + static_cast<double>(k) * c);
        }
    }
    return control;
  }

  /// Bent edges, and inner points that follow them.
  std::vector<Vec2> blended() {
    const std::size_t size = at(bernstein::triangle_size(g_));
    std::vector<Vec2> control = raised(vertex_), local(size);
    std::array<Vec2, TriangleMesh::max_degree> side_bend;
    for (std::size_t e = 0; e < straight_.element_count(); ++e) {
      const NodeId* nodes = elements_.data() + e * size;
      const auto sides = straight_.edges(ElementId(e));
      for (std::size_t n = 0; n < size; ++n) local[n] = control[nodes[n].index()];
      bool changed = false;
      for (int s = 0; s < 3; ++s) {
        const auto& [edge, reversed] = sides[at(s)];
        if (!straight_.is_boundary(edge) || !bent(edge)) continue;
        changed = true;
        for (int m = 1; m < g_; ++m) {
          side_bend[at(m - 1)] = bend(edge)[(reversed ? g_ - m : m) - 1];
          local[at(bernstein::triangle_side_index(g_, s, m))] += side_bend[at(m - 1)];
        }
        planar::extend_bend(g_, s, std::span(side_bend).first(at(g_ - 1)), local);
      }
      if (changed)
        for (std::size_t n = 0; n < size; ++n) control[nodes[n].index()] = local[n];
    }
    return control;
  }

  std::vector<ElementId> invalid_elements(const std::vector<Vec2>& control) const {
    const std::size_t size = at(bernstein::triangle_size(g_));
    std::vector<Vec2> local(size);
    std::vector<ElementId> out;
    for (std::size_t e = 0; e < straight_.element_count(); ++e) {
      for (std::size_t n = 0; n < size; ++n) local[n] = control[elements_[e * size + n].index()];
      if (check_validity(g_, local).status != Validity::valid) out.emplace_back(e);
    }
    return out;
  }

  /// All inner points follow the boundary of `control` from the straight mesh as an elastic body.
  std::vector<Vec2> relax(const std::vector<Vec2>& control, int steps) const {
    const std::size_t size = at(bernstein::triangle_size(g_));
    std::vector<char> fixed(nodes_.count(), 0);
    std::vector<char> used(nodes_.count(), 0);
    for (std::size_t e = 0; e < straight_.element_count(); ++e) {
      const auto sides = straight_.edges(ElementId(e));
      for (std::size_t n = 0; n < size; ++n) used[elements_[e * size + n].index()] = 1;
      for (int s = 0; s < 3; ++s)
        if (straight_.is_boundary(sides[at(s)].edge))
          for (int m = 0; m <= g_; ++m)
            fixed[elements_[e * size + at(bernstein::triangle_side_index(g_, s, m))].index()] = 1;
    }
    for (std::size_t n = 0; n < nodes_.count(); ++n)
      if (used[n] == 0) fixed[n] = 1;
    return fit::relax_lattice(g_, elements_, raised(straight_.control()), fixed, control, steps);
  }

  Tags tags() const {
    Tags tags = straight_.tags();
    const EdgeFinder finder(straight_);
    std::erase_if(tags.edges,
                  [&](const TaggedEdge& edge) { return !finder.find(edge.nodes).edge.valid(); });
    for (TaggedEdge& edge : tags.edges) {
      const SideEdge found = finder.find(edge.nodes);
      std::vector<NodeId> nodes = {edge.nodes[0]};
      for (int m = 1; m < g_; ++m) nodes.push_back(nodes_.edge(found, m));
      nodes.push_back(edge.nodes[1]);
      edge.nodes = std::move(nodes);
    }
    return tags;
  }

  const TriangleMesh& straight_;
  std::span<const SmoothCurve<2>> curves_;
  const CurveMeshOptions& options_;
  int g_;
  CurveInterpolator interpolator_;
  LobattoBasis basis_;
  std::vector<Vec2> vertex_;
  std::vector<Vec2> bend_;  // g - 1 per edge, in its canonical direction
  std::vector<EdgePart> parts_;
  std::vector<FittedEdge> edges_;
  RaisedNodes nodes_;
  std::vector<NodeId> elements_;
  std::size_t straight_edges_ = 0;
  double largest_move_ = 0.0;
};

}  // namespace

CurvedMesh curve_mesh(const TriangleMesh& straight, std::span<const SmoothCurve<2>> curves,
                      const CurveMeshOptions& options) {
  if (straight.degree() != 1)
    throw InputError("found a mesh of degree " + std::to_string(straight.degree()) +
                     ", expected a straight one (degree 1)");
  if (options.degree < 1 || options.degree > TriangleMesh::max_degree)
    throw InputError("found geometric degree " + std::to_string(options.degree) +
                     ", expected 1 to " + std::to_string(TriangleMesh::max_degree));
  if (!(options.tolerance > 0.0 && options.tolerance < 0.1))
    throw InputError("found a tolerance of " + std::to_string(options.tolerance) +
                     " of the diagonal, expected above 0 and below 0.1");
  if (curves.empty()) throw InputError("found no curves, expected at least one");
  return Curving(straight, curves, options).run();
}

}  // namespace bezel
