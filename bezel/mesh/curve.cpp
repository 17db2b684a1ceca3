// From straight-sided triangulations to curved meshes.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/bend.hpp"
#include "bezel/mesh/planar.hpp"
#include "bezel/mesh/raised_nodes.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::planar {
namespace {

using short_names::at;

/// Interpolation at Gauss-Lobatto points of displacements that vanish at both ends.
class Interpolation {
 public:
  explicit Interpolation(int g)
      : n_(g - 1), node_(gauss_lobatto(g + 1).node), inverse_(at(n_ * n_)) {
    // Gauss-Jordan on [basis | identity]; the matrix is totally positive, so pivoting is not
    // needed.
    std::vector<double> a(at(n_ * n_));
    for (int q = 0; q < n_; ++q)
      for (int m = 0; m < n_; ++m) {
        const double s = node_[at(q + 1)];
        a[at(q * n_ + m)] = binomial(g, m + 1) * std::pow(s, m + 1) * std::pow(1 - s, g - m - 1);
        inverse_[at(q * n_ + m)] = q == m ? 1.0 : 0.0;
      }
    for (int k = 0; k < n_; ++k) {
      const double pivot = a[at(k * n_ + k)];
      for (int m = 0; m < n_; ++m) a[at(k * n_ + m)] /= pivot, inverse_[at(k * n_ + m)] /= pivot;
      for (int q = 0; q < n_; ++q) {
        const double factor = a[at(q * n_ + k)];
        if (q == k || factor == 0) continue;
        for (int m = 0; m < n_; ++m) {
          a[at(q * n_ + m)] -= factor * a[at(k * n_ + m)];
          inverse_[at(q * n_ + m)] -= factor * inverse_[at(k * n_ + m)];
        }
      }
    }
  }

  /// Bernstein coefficients 1..g-1 of the displacement of an arc from its chord a, b.
  void arc(const Curve& circle, const Vec2& a, const Vec2& b, Vec2* out) const {
    const Vec2 ra = a - circle.centre, rb = b - circle.centre;
    const double start = std::atan2(ra[1], ra[0]);
    const double turn = std::atan2(cross(ra, rb), dot(ra, rb));
    for (int m = 0; m < n_; ++m) out[m] = Vec2{};
    for (int q = 0; q < n_; ++q) {
      const double s = node_[at(q + 1)], angle = start + s * turn;
      const Vec2 r{{circle.radius * std::cos(angle), circle.radius * std::sin(angle)}};
      const Vec2 d = r - ((1 - s) * ra + s * rb);
      for (int m = 0; m < n_; ++m) out[m] += inverse_[at(m * n_ + q)] * d;
    }
  }

 private:
  int n_;
  std::vector<double> node_, inverse_;
};

class Curving {
 public:
  Curving(const Triangulation& t, int degree)
      : t_(t),
        g_(degree),
        straight_(1, t.points, corners(t)),
        shift_(straight_.edge_count() * at(g_ - 1)),
        segment_(straight_.edge_count(), -1) {
    // The segment of every boundary edge, by the edge's corners.
    std::vector<std::pair<std::pair<int, int>, int>> sorted;
    for (std::size_t s = 0; s < t.segments.size(); ++s)
      sorted.push_back({std::minmax(t.segments[s].a, t.segments[s].b), static_cast<int>(s)});
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t e = 0; e < segment_.size(); ++e) {
      if (!straight_.is_boundary(EdgeId(e))) continue;
      const auto nodes = straight_.edge_nodes(EdgeId(e));
      const std::pair<int, int> key{nodes[0].value, nodes[1].value};
      const auto found = std::lower_bound(sorted.begin(), sorted.end(), std::pair{key, -1});
      if (found != sorted.end() && found->first == key) segment_[e] = found->second;
    }
  }

  /// Displaces boundary edges onto their arcs.
  void bend_boundary() {
    if (g_ < 2) return;
    const Interpolation interpolation(g_);
    for (std::size_t e = 0; e < segment_.size(); ++e) {
      if (segment_[e] < 0) continue;
      const Curve& curve = t_.curves[at(t_.segments[at(segment_[e])].curve)];
      if (curve.radius <= 0) continue;
      const auto nodes = straight_.edge_nodes(EdgeId(e));
      interpolation.arc(curve, t_.points[nodes[0].index()], t_.points[nodes[1].index()], shift(e));
    }
  }

  /// Displaces inner edges at random, across their direction, by at most jitter times their length.
  void bend_inside(double jitter, RandomStream& random) {
    for (std::size_t e = 0; e < segment_.size(); ++e) {
      if (straight_.is_boundary(EdgeId(e))) continue;
      const auto nodes = straight_.edge_nodes(EdgeId(e));
      const Vec2 along = t_.points[nodes[1].index()] - t_.points[nodes[0].index()];
      const Vec2 across{{-along[1], along[0]}};
      // s (1 - s) eta(s) with |eta| <= 4 jitter |edge|.
      for (int m = 1; m < g_; ++m) {
        const double eta = 4 * jitter * random.uniform(-1, 1);
        shift(e)[m - 1] = (m * (g_ - m) / (g_ * (g_ - 1.0)) * eta) * across;
      }
    }
  }

  /// Halves the bulges of inner edges around invalid elements; false when that cannot help.
  bool make_valid() {
    constexpr int rounds = 12;
    std::vector<int> halved(segment_.size(), 0);
    std::vector<char> dirty(straight_.element_count(), 1);
    std::vector<Vec2> control(at(bernstein::triangle_size(g_)));
    for (bool again = true; again;) {
      again = false;
      std::vector<char> halve(segment_.size(), 0);
      for (std::size_t e = 0; e < dirty.size(); ++e) {
        if (dirty[e] == 0) continue;
        dirty[e] = 0;
        if (valid(ElementId(e), control)) continue;
        bool helps = false;
        for (const SideEdge& side : straight_.edges(ElementId(e)))
          if (!straight_.is_boundary(side.edge) && bent(side.edge.index()))
            halve[side.edge.index()] = 1, helps = true;
        if (!helps) return false;
        again = true;
      }
      for (std::size_t e = 0; e < halve.size(); ++e) {
        if (halve[e] == 0) continue;
        const double factor = ++halved[e] > rounds ? 0.0 : 0.5;
        for (int m = 0; m < g_ - 1; ++m) shift(e)[m] *= factor;
        for (const ElementSide& side : straight_.adjacent(EdgeId(e)))
          dirty[side.element.index()] = 1;
      }
    }
    return true;
  }

  TriangleMesh mesh() const {
    const RaisedNodes numbers(straight_, g_);
    std::vector<NodeId> elements = numbers.elements();
    std::vector<Vec2> control(numbers.count());
    std::copy(t_.points.begin(), t_.points.end(), control.begin());
    for (std::size_t e = 0; e < segment_.size(); ++e)
      for (int m = 1; m < g_; ++m)
        control[numbers.edge({EdgeId(e), false}, m).index()] = edge_point(e, m);
    const std::size_t size = at(bernstein::triangle_size(g_));
    std::vector<Vec2> local(size);
    for (std::size_t e = 0; e < straight_.element_count() && g_ >= 3; ++e) {
      gather(ElementId(e), local);
      for (std::size_t n = 0; n < size; ++n) {
        const std::size_t node = elements[e * size + n].index();
        if (node >= numbers.inner(ElementId(e))) control[node] = local[n];
      }
    }
    Tags found = tags(elements);
    return TriangleMesh(g_, std::move(control), std::move(elements), std::move(found));
  }

 private:
  static std::vector<NodeId> corners(const Triangulation& t) {
    std::vector<NodeId> out;
    out.reserve(3 * t.triangles.size());
    for (const auto& triangle : t.triangles)
      for (const int v : triangle) out.emplace_back(v);
    return out;
  }

  Vec2* shift(std::size_t edge) { return shift_.data() + edge * at(g_ - 1); }
  const Vec2* shift(std::size_t edge) const { return shift_.data() + edge * at(g_ - 1); }
  bool bent(std::size_t edge) const {
    for (int m = 0; m < g_ - 1; ++m)
      if (shift(edge)[m] != Vec2{}) return true;
    return false;
  }

  Vec2 edge_point(std::size_t edge, int m) const {
    const auto nodes = straight_.edge_nodes(EdgeId(edge));
    const Vec2 &a = t_.points[nodes[0].index()], &b = t_.points[nodes[1].index()];
    return a + (b - a) * (static_cast<double>(m) / g_) + shift(edge)[m - 1];
  }

  /// All control points of an element: edges as stored; inner points affine plus the extension of
  /// every bent side.
  void gather(ElementId e, std::vector<Vec2>& out) const {
    const auto corner = straight_.nodes(e);
    const auto sides = straight_.edges(e);
    const Vec2 &p0 = t_.points[corner[0].index()], &p1 = t_.points[corner[1].index()],
               &p2 = t_.points[corner[2].index()];
    for (int k = 0; k <= g_; ++k)
      for (int j = 0; j <= g_ - k; ++j)
        out[at(bernstein::triangle_index(g_, j, k))] = p0 +
                                                       (p1 - p0) * (static_cast<double>(j) / g_) +
                                                       (p2 - p0) * (static_cast<double>(k) / g_);
    for (int c = 0; c < 3; ++c)
      out[at(bernstein::triangle_corner(g_, c))] = t_.points[corner[at(c)].index()];
    std::array<Vec2, TriangleMesh::max_degree> bend;
    for (int s = 0; s < 3; ++s) {
      const std::size_t edge = sides[at(s)].edge.index();
      for (int m = 1; m < g_; ++m)
        out[at(bernstein::triangle_side_index(g_, s, m))] =
            edge_point(edge, sides[at(s)].reversed ? g_ - m : m);
      if (g_ < 3 || !bent(edge)) continue;
      for (int m = 1; m < g_; ++m)
        bend[at(m - 1)] = shift(edge)[(sides[at(s)].reversed ? g_ - m : m) - 1];
      extend_bend(g_, s, std::span(bend).first(at(g_ - 1)), out);
    }
  }

  bool valid(ElementId e, std::vector<Vec2>& control) const {
    bool any = false;
    for (const SideEdge& side : straight_.edges(e)) any = any || bent(side.edge.index());
    if (any) {
      gather(e, control);
      return check_validity(g_, control).status == Validity::valid;
    }
    const auto corner = straight_.nodes(e);
    const Vec2& p = t_.points[corner[0].index()];
    return cross(t_.points[corner[1].index()] - p, t_.points[corner[2].index()] - p) > 0;
  }

  /// Surface 1 in group "domain", curve 1, 2, … in the groups of their names.
  Tags tags(const std::vector<NodeId>& elements) const {
    Tags tags;
    const auto curve_count = static_cast<int>(t_.curves.size());
    tags.groups.push_back({2, 1, "domain"});
    for (int c = 0; c < curve_count; ++c) {
      tags.groups.push_back({1, c + 2, t_.curves[at(c)].name});
      tags.entities.push_back({1, c + 1, {c + 2}});
    }
    tags.entities.push_back({2, 1, {1}});
    tags.element_entity.assign(straight_.element_count(), 1);
    std::vector<std::size_t> edge_of(t_.segments.size());
    for (std::size_t e = 0; e < segment_.size(); ++e)
      if (segment_[e] >= 0) edge_of[at(segment_[e])] = e;
    const std::size_t size = at(bernstein::triangle_size(g_));
    for (std::size_t s = 0; s < edge_of.size(); ++s) {
      const ElementSide& side = straight_.adjacent(EdgeId(edge_of[s]))[0];
      TaggedEdge edge;
      for (int m = 0; m <= g_; ++m)
        edge.nodes.push_back(elements[side.element.index() * size +
                                      at(bernstein::triangle_side_index(g_, side.side, m))]);
      edge.entity = t_.segments[s].curve + 1;
      tags.edges.push_back(std::move(edge));
    }
    return tags;
  }

  const Triangulation& t_;
  int g_;
  TriangleMesh straight_;
  std::vector<Vec2>
      shift_;  // g-1 per edge: Bernstein coefficients of its displacement, canonical direction
  std::vector<int> segment_;  // per edge, -1 inside
};

}  // namespace

std::optional<TriangleMesh> curve(const Triangulation& t, int degree, double jitter,
                                  RandomStream& random) {
  Curving curving(t, degree);
  curving.bend_boundary();
  if (degree >= 2 && jitter > 0) {
    Curving plain = curving;
    if (!plain.make_valid()) return std::nullopt;
    curving.bend_inside(jitter, random);
  }
  if (!curving.make_valid()) return std::nullopt;
  return curving.mesh();
}

}  // namespace bezel::planar
