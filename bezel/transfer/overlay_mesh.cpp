#include "bezel/transfer/overlay_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/morton.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/thin_region.hpp"

namespace bezel::detail {
namespace {

constexpr std::size_t block = 1024;
/// Twice a straight triangle's area over the squares of two sides, above which its rounding is
/// below 8 u of it.
constexpr double well_shaped = 0.1;
/// Steps from element to element before a search goes on in the tree.
constexpr int longest_walk = 64;
/// Where steps are short: across the whole mesh if need be.
std::size_t longest_way(const OverlayMesh& mesh) {
  return static_cast<std::size_t>(longest_walk) + mesh.element_count() / 64;
}

/// Where a walk over the triangles of the corners ends: in the one around p, or at the boundary.
std::int32_t walk_towards(const OverlayMesh& mesh, const Vec2& p, std::int32_t from) {
  std::int32_t at = from;
  const std::size_t longest = longest_way(mesh);
  for (std::size_t step = 0; step < longest; ++step) {
    const std::array<Vec2, 3> c = mesh.corners(at);
    const std::array<double, 3> left = {cross(c[1] - c[0], p - c[0]), cross(c[2] - c[1], p - c[1]),
                                        cross(c[0] - c[2], p - c[2])};
    const auto least = std::min_element(left.begin(), left.end());
    if (*least >= 0.0) break;
    const auto side = static_cast<std::size_t>(least - left.begin());
    const std::int32_t next =
        mesh.across(at, mesh.element_edges[static_cast<std::size_t>(at)][side].edge.value);
    if (next == exterior) break;
    at = next;
  }
  return at;
}

}  // namespace

OverlayMesh::OverlayMesh(std::shared_ptr<const TriangleMesh> source, const std::string& what,
                         int threads)
    : mesh(std::move(source)),
      degree(mesh->degree()),
      element_size(static_cast<std::size_t>(mesh->nodes_per_element())) {
  lay_out_edges(what, threads);
  lay_out_elements(what, threads);
}

void OverlayMesh::lay_out_edges(const std::string& what, int threads) {
  const std::size_t edges = mesh->edge_count();
  const auto edge_size = static_cast<std::size_t>(degree + 1);
  edge_control.resize(edges * edge_size);
  edge_sides.resize(edges);
  edge_vertex.resize(edges);
  if (degree > 1) edge_cache_.resize(edges);
  const auto lay_out = [&](std::size_t e) {
    const std::span<Vec2> control(edge_control.data() + e * edge_size, edge_size);
    const auto nodes = mesh->edge_nodes(EdgeId(e));
    for (std::size_t k = 0; k < edge_size; ++k) control[k] = mesh->control(nodes[k]);
    if (degree > 1) edge_cache_[e] = cache_curve(control);
    edge_vertex[e] = {nodes.front().value, nodes.back().value};
    std::array<std::int32_t, 2> sides = {exterior, exterior};
    for (const ElementSide& side : mesh->adjacent(EdgeId(e))) {
      std::int32_t& place = sides[side.reversed ? 1 : 0];
      if (place != exterior) {
        throw InputError({"", 0, "triangle", side.element.value},
                         what + " mesh: lies on the same side of an edge as triangle " +
                             std::to_string(place) +
                             ", expected at most one triangle on each side");
      }
      place = side.element.value;
    }
    edge_sides[e] = sides;
  };
  parallel_for((edges + block - 1) / block,
               [&](std::size_t b) {
                 for (std::size_t e = b * block; e < std::min(edges, (b + 1) * block); ++e)
                   lay_out(e);
               },
               threads);
}

void OverlayMesh::lay_out_elements(const std::string& what, int threads) {
  const std::size_t elements = mesh->element_count();
  element_edges.resize(elements);
  element_control.resize(elements * element_size);
  element_box.resize(elements);
  element_area.resize(elements);
  element_diameter.resize(elements);
  const auto lay_out = [&](std::size_t e) {
    element_edges[e] = mesh->edges(ElementId(e));
    const std::span<Vec2> control(element_control.data() + e * element_size, element_size);
    const auto nodes = mesh->nodes(ElementId(e));
    Box2 around;
    for (std::size_t k = 0; k < element_size; ++k) {
      control[k] = mesh->control(nodes[k]);
      around.include(control[k]);
    }
    element_box[e] = around;
    element_diameter[e] = around.diameter();
    if (degree == 1) {
      const Vec2 a = control[1] - control[0], b = control[2] - control[0];
      const double det = cross(a, b);
      element_area[e] = 0.5 * det;
      if (det > well_shaped * (dot(a, a) + dot(b, b))) return;
    }
    const ValidityResult validity = check_validity(degree, control);
    if (validity.status == Validity::inverted) {
      throw InputError({"", 0, "triangle", static_cast<std::int64_t>(e)},
                       what + " mesh: the element is inverted (its Jacobian is " +
                           std::to_string(validity.det) +
                           " at one place), expected it positive everywhere");
    }
    element_area[e] = degree == 1 ? 0.5 * validity.det : area(degree, control);
  };
  parallel_for((elements + block - 1) / block,
               [&](std::size_t b) {
                 for (std::size_t e = b * block; e < std::min(elements, (b + 1) * block); ++e)
                   lay_out(e);
               },
               threads);
  for (const Box2& b : element_box) box.include(b);
}

Box2 OverlayMesh::edge_box(std::int32_t e) const {
  if (degree > 1) return edge_cache_[static_cast<std::size_t>(e)].box;
  Box2 around;
  for (const Vec2& p : edge(e)) around.include(p);
  return around;
}

void OverlayMesh::came_from(std::vector<Vec2> control, double with_rounding) {
  given_control = std::move(control);
  rounding = with_rounding;
  if (given_control.empty() || degree == 1) return;
  for (std::size_t e = 0; e < element_area.size(); ++e) {
    const auto number = static_cast<std::int32_t>(e);
    if (is_flat(*this, number) && is_bent(*this, number))
      element_area[e] = area(degree, given_element(*this, number));
  }
}

double OverlayMesh::edge_width(std::int32_t e) const {
  double width = edge_box(e).diameter();
  for (const std::int32_t side : edge_sides[static_cast<std::size_t>(e)])
    if (side != exterior) width = std::min(width, element_width(side));
  return width;
}

std::array<Vec2, 3> OverlayMesh::corners(std::int32_t e) const {
  const auto control = element(e);
  return {control[0], control[static_cast<std::size_t>(degree)], control[element_size - 1]};
}

std::vector<std::int32_t> OverlayMesh::spatial_order() const {
  std::vector<Vec2> centres(element_count());
  for (std::size_t e = 0; e < centres.size(); ++e) centres[e] = element_box[e].centre();
  return morton_order(centres);
}

FrontSearch::FrontSearch(const OverlayMesh& mesh) : mesh_(mesh) {
  collect_edges_at_vertices();
  if (mesh.degree == 1) straight_ = straight_elements(mesh);
}

FrontSearch::FrontSearch(const OverlayMesh& part, bool connected) : FrontSearch(part) {
  connected_ = connected;
}

const Bvh& FrontSearch::tree() const {
  std::call_once(tree_made_, [&] { tree_ = std::make_unique<const Bvh>(mesh_.element_box); });
  return *tree_;
}

void FrontSearch::collect_edges_at_vertices() {
  const std::size_t vertices = mesh_.mesh->node_count();
  vertex_offset_.assign(vertices + 1, 0);
  for (const auto& ends : mesh_.edge_vertex) {
    for (const std::int32_t v : ends) ++vertex_offset_[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) vertex_offset_[v + 1] += vertex_offset_[v];
  vertex_edges_.resize(2 * mesh_.edge_vertex.size());
  std::vector<std::uint32_t> next(vertex_offset_.begin(), vertex_offset_.end() - 1);
  for (std::size_t e = 0; e < mesh_.edge_vertex.size(); ++e) {
    for (const std::int32_t v : mesh_.edge_vertex[e])
      vertex_edges_[next[static_cast<std::size_t>(v)]++] = static_cast<std::int32_t>(e);
  }

  if (mesh_.edge_vertex.empty()) return;
  // All that can be reached from the first vertex, and whether that is every vertex.
  std::vector<std::uint8_t> reached(vertices, 0);
  std::vector<std::int32_t> front = {mesh_.edge_vertex.front()[0]};
  reached[static_cast<std::size_t>(front.front())] = 1;
  std::size_t count = 1;
  while (!front.empty()) {
    const std::int32_t v = front.back();
    front.pop_back();
    for (const std::int32_t e : edges_at(v)) {
      const auto& ends = mesh_.edge_vertex[static_cast<std::size_t>(e)];
      const std::int32_t other = ends[0] == v ? ends[1] : ends[0];
      std::uint8_t& seen = reached[static_cast<std::size_t>(other)];
      count += seen == 0 ? 1 : 0;
      if (seen == 0) front.push_back(other);
      seen = 1;
    }
  }
  connected_ = count == mesh_.mesh->vertex_count();
}

std::int32_t FrontSearch::containing(const Vec2& p, std::int32_t start, Memory& memory) const {
  // Any element is a start: the way from it costs less than a tree over all of them.
  if (start == exterior && mesh_.element_count() > 0) start = 0;
  const std::size_t longest = longest_way(mesh_);
  if (!straight_.empty()) {
    // Towards the side that p is farthest beyond; across the whole mesh if need be, for these steps
    // are short.
    for (std::size_t step = 0; start >= 0 && step < longest; ++step) {
      const StraightPlace place = place_in(straight_[static_cast<std::size_t>(start)], p);
      if (place.inside) return place.clear ? start : exterior;
      start = place.beyond >> 2;  // -1 stays negative
    }
    start = exterior;
  }
  const auto margin_of = [&](std::int32_t e, std::array<double, 3>& lambda) {
    return (mesh_.degree == 1 || mesh_.element_box[static_cast<std::size_t>(e)].contains(p)) &&
           invert_map(mesh_.degree, mesh_.element(e), p, lambda, false);
  };
  std::int32_t at = start;
  std::array<double, 3> lambda{};
  int inverted = 0;
  for (std::size_t step = 0; at != exterior && step < longest && inverted < longest_walk; ++step) {
    const bool known = margin_of(at, lambda);
    inverted += known ? 1 : 0;
    // Far from a curved element the triangle of its corners shows the way.
    if (!known) lambda = affine_frame(mesh_.corners(at)).lambda(p);
    const auto smallest = std::min_element(lambda.begin(), lambda.end());
    if (known && *smallest >= 0.0) return *smallest > clear_of_edges ? at : exterior;
    const auto side = static_cast<std::size_t>(smallest - lambda.begin() + 1) % 3;
    at = mesh_.across(at, mesh_.element_edges[static_cast<std::size_t>(at)][side].edge.value);
  }
  Box2 point;
  point.include(p);
  memory.found.clear();
  tree().query(point, memory.found);
  for (const std::int32_t e : memory.found) {
    if (margin_of(e, lambda) && *std::min_element(lambda.begin(), lambda.end()) > clear_of_edges)
      return e;
  }
  return exterior;
}

void FrontSearch::query(const Box2& box, std::span<const std::int32_t> near, Memory& memory,
                        std::vector<std::int32_t>& out) const {
  const auto& boxes = mesh_.element_box;
  // The walk must start in an element that truly meets the box (a corner in it, or around its
  // centre): from one whose bounding box only overlaps it, the elements in the box need not be
  // reachable through elements near the box.
  const auto meets = [&](std::int32_t e) {
    if (!boxes[static_cast<std::size_t>(e)].overlaps(box)) return false;
    const auto corners = mesh_.corners(e);
    return box.contains(corners[0]) || box.contains(corners[1]) || box.contains(corners[2]) ||
           inside_margin(mesh_, e, box.centre()) >= 0.0;
  };
  const auto found = std::find_if(near.begin(), near.end(), meets);
  std::int32_t seed = found != near.end() ? *found : exterior;
  if (seed == exterior && !near.empty()) {
    const std::int32_t e = walk_towards(mesh_, box.centre(), near.front());
    if (meets(e)) seed = e;
  }
  out.clear();
  bool complete = seed != exterior;
  if (complete) {
    if (memory.stamp.size() != boxes.size()) {
      memory.stamp.assign(boxes.size(), 0);
      memory.now = 0;
    }
    if (++memory.now == 0) {
      std::fill(memory.stamp.begin(), memory.stamp.end(), 0U);
      memory.now = 1;
    }
    memory.stamp[static_cast<std::size_t>(seed)] = memory.now;
    out.push_back(seed);
    for (std::size_t i = 0; complete && i < out.size(); ++i) {
      for (const SideEdge& side : mesh_.element_edges[static_cast<std::size_t>(out[i])]) {
        const std::int32_t next = mesh_.across(out[i], side.edge.value);
        if (next == exterior) {
          // Beyond the boundary (a hole, a bay) there may be elements that the walk cannot reach.
          if (mesh_.edge_box(side.edge.value).overlaps(box)) {
            complete = false;
            break;
          }
          continue;
        }
        std::uint32_t& stamp = memory.stamp[static_cast<std::size_t>(next)];
        if (stamp == memory.now) continue;
        stamp = memory.now;
        if (boxes[static_cast<std::size_t>(next)].overlaps(box)) out.push_back(next);
      }
    }
  }
  if (!complete) {
    out.clear();
    tree().query(box, out);
  }
  std::sort(out.begin(), out.end());
}

std::int32_t FrontSearch::towards(const Vec2& p) const {
  return mesh_.element_count() > 0 ? walk_towards(mesh_, p, 0) : exterior;
}

std::int32_t FrontSearch::nearest(const Vec2& p) const {
  return tree().nearest(p, [&](std::int32_t e) {
    // Distance to the polygon through the corners and side control points is enough to pick a
    // neighbour.
    double best = std::numeric_limits<double>::infinity();
    if (inside_margin(mesh_, e, p) >= 0.0) return 0.0;
    for (const SideEdge& side : mesh_.element_edges[static_cast<std::size_t>(e)]) {
      const auto control = mesh_.edge(side.edge.value);
      for (std::size_t i = 0; i + 1 < control.size(); ++i) {
        const Vec2 d = control[i + 1] - control[i];
        const double length_squared = dot(d, d);
        const double t = length_squared > 0
                             ? std::clamp(dot(p - control[i], d) / length_squared, 0.0, 1.0)
                             : 0.0;
        best = std::min(best, norm(p - (control[i] + d * t)));
      }
    }
    // The box distance never exceeds this value's true counterpart; keep the promise under
    // rounding.
    const Box2& b = mesh_.element_box[static_cast<std::size_t>(e)];
    const double dx = std::max({b.lo[0] - p[0], 0.0, p[0] - b.hi[0]});
    const double dy = std::max({b.lo[1] - p[1], 0.0, p[1] - b.hi[1]});
    return std::max(best, std::sqrt(dx * dx + dy * dy));
  });
}

bool invert_map(int degree, std::span<const Vec2> control, const Vec2& p,
                std::array<double, 3>& lambda, bool warm) {
  const Vec2 c0 = control[0];
  const Vec2 c1 = control[static_cast<std::size_t>(degree)];
  const Vec2 c2 = control[control.size() - 1];
  const Vec2 a = c1 - c0;
  const Vec2 b = c2 - c0;
  const double det = cross(a, b);
  if (degree == 1 || (!warm && det > 0.0)) {
    const double l1 = cross(p - c0, b) / det;
    const double l2 = cross(a, p - c0) / det;
    lambda = {1.0 - l1 - l2, l1, l2};
    if (degree == 1) return std::isfinite(l1) && std::isfinite(l2);
  } else if (!warm) {
    lambda = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  }
  const InverseResult result = invert(degree, control, p, lambda);
  if (result.converged) {
    lambda = result.lambda;
    return true;
  }
  const LocateResult located = locate(degree, control, p, 1e-9);
  if (located.status == Location::inside) {
    lambda = located.lambda;
    return true;
  }
  return false;
}

double inside_margin(const OverlayMesh& mesh, std::int32_t element, const Vec2& p) {
  constexpr double outside = -std::numeric_limits<double>::infinity();
  if (!mesh.element_box[static_cast<std::size_t>(element)].contains(p)) return outside;
  std::array<double, 3> lambda{};
  bool found = false;
  if (is_flat(mesh, element)) {
    // Where it is round none of the three is blurred by the rounding of another.
    const RoundControl round(mesh.element(element));
    found = invert_map(mesh.degree, round.points(), round.map()(p), lambda, false);
  } else {
    found = invert_map(mesh.degree, mesh.element(element), p, lambda, false);
  }
  return found ? std::min({lambda[0], lambda[1], lambda[2]}) : outside;
}

}  // namespace bezel::detail
