#pragma once
// The L2 projection onto one target element, slowly and apart from the transfer: regions by polygon
// clipping or by the kernel for two triangles, points of rules placed one by one, sums and systems
// in long double.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/field/field.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::test {

using Real = long double;

struct RealPoint {
  Real x = 0, y = 0;
  friend RealPoint operator+(RealPoint a, RealPoint b) { return {a.x + b.x, a.y + b.y}; }
  friend RealPoint operator-(RealPoint a, RealPoint b) { return {a.x - b.x, a.y - b.y}; }
  friend RealPoint operator*(Real s, RealPoint a) { return {s * a.x, s * a.y}; }
};
inline RealPoint real(const Vec2& p) {
  return {p[0], p[1]};
}
inline Real cross(RealPoint a, RealPoint b) {
  return a.x * b.y - a.y * b.x;
}
inline Real length(RealPoint a) {
  return std::hypot(a.x, a.y);
}

/// Bernstein polynomials of the triangle at barycentrics (1-u-v, u, v), by powers.
inline void slow_basis(int degree, Real u, Real v, std::vector<Real>& out) {
  std::array<std::array<Real, 11>, 3> power{};
  const std::array<Real, 3> l = {1 - u - v, u, v};
  for (std::size_t k = 0; k < 3; ++k) {
    power[k][0] = 1;
    for (std::size_t e = 1; e <= static_cast<std::size_t>(degree); ++e)
      power[k][e] = power[k][e - 1] * l[k];
  }
  static const std::array<Real, 11> factorial = {1,   1,    2,     6,      24,     120,
                                                 720, 5040, 40320, 362880, 3628800};
  out.clear();
  const auto d = static_cast<std::size_t>(degree);
  for (std::size_t k = 0; k <= d; ++k) {
    for (std::size_t j = 0; j + k <= d; ++j) {
      const std::size_t i = d - j - k;
      out.push_back(factorial[d] / (factorial[i] * factorial[j] * factorial[k]) * power[0][i] *
                    power[1][j] * power[2][k]);
    }
  }
}

/// An element: its map, and the triangle of a polynomial in x and y on it.
class SlowElement {
 public:
  SlowElement(const Space& space, ElementId e)
      : degree_(space.mesh()->degree()),
        mapped_(space.basis() == Basis::reference && degree_ > 1),
        diameter_(space.mesh()->box(e).diameter()) {
    for (const Vec2& p : space.mesh()->gather(e)) control_.push_back(real(p));
    if (space.basis() == Basis::physical) {
      const Frame& frame = space.frame(e);
      centre_ = real(frame.centre);
      first_ = real(frame.gradient[1]);
      second_ = real(frame.gradient[2]);
    } else if (degree_ == 1) {
      const RealPoint a = control_[1] - control_[0], b = control_[2] - control_[0];
      const Real det = cross(a, b);
      first_ = {b.y / det, -b.x / det};
      second_ = {-a.y / det, a.x / det};
      centre_ = control_[0] + (Real(1) / 3) * (a + b);
    }
  }
  bool mapped() const { return mapped_; }
  int degree() const { return degree_; }

  struct At {
    RealPoint x, du, dv;
  };
  /// By de Casteljau's algorithm.
  At map(Real u, Real v) const {
    std::array<RealPoint, 66> b;
    std::copy(control_.begin(), control_.end(), b.begin());
    const auto at = [&](int d, int j, int k) -> RealPoint& {
      return b[static_cast<std::size_t>(bernstein::triangle_index(d, j, k))];
    };
    for (int d = degree_; d > 1; --d) {
      for (int k = 0; k < d; ++k)
        for (int j = 0; j + k < d; ++j)
          at(d - 1, j, k) = (1 - u - v) * at(d, j, k) + u * at(d, j + 1, k) + v * at(d, j, k + 1);
    }
    return {(1 - u - v) * b[0] + u * b[1] + v * b[2], Real(degree_) * (b[1] - b[0]),
            Real(degree_) * (b[2] - b[0])};
  }

  /// Barycentrics 1 and 2 for the polynomial at x; of a mapped one by Newton's method from `place`.
  /// @return false when it finds none in or near the element
  bool find(RealPoint x, std::array<Real, 2>& place) const {
    if (!mapped_) {
      const RealPoint r = x - centre_;
      place = {Real(1) / 3 + first_.x * r.x + first_.y * r.y,
               Real(1) / 3 + second_.x * r.x + second_.y * r.y};
      return true;
    }
    for (int step = 0; step < 60; ++step) {
      const At at = map(place[0], place[1]);
      const RealPoint miss = x - at.x;
      const Real det = cross(at.du, at.dv);
      if (!(det > 0)) return false;
      std::array<Real, 2> by = {cross(miss, at.dv) / det, cross(at.du, miss) / det};
      const Real size = std::max(std::abs(by[0]), std::abs(by[1]));
      const Real most = 0.25;
      if (size > most)
        for (Real& s : by) s *= most / size;
      place[0] += by[0];
      place[1] += by[1];
      if (!(std::abs(place[0]) < 3 && std::abs(place[1]) < 3)) return false;
      if (size < 1e-15L) return length(miss) <= 1e-13L * diameter_;
    }
    return false;
  }

 private:
  int degree_;
  bool mapped_;
  Real diameter_;
  std::vector<RealPoint> control_;
  RealPoint centre_, first_, second_;  // of the triangle of a polynomial in x and y
};

/// A piece of a region's boundary: the curve of these control points from s0 to s1.
struct SlowPiece {
  std::vector<RealPoint> control;
  Real s0 = 0, s1 = 1;
  std::array<RealPoint, 2> at(Real s) const {  // and the derivative
    std::vector<RealPoint> b = control;
    for (std::size_t n = b.size(); n > 2; --n)
      for (std::size_t i = 0; i + 1 < n; ++i) b[i] = (1 - s) * b[i] + s * b[i + 1];
    return {(1 - s) * b[0] + s * b[1], Real(control.size() - 1) * (b[1] - b[0])};
  }
};
using SlowRegion = std::vector<SlowPiece>;

/// A straight triangle cut by another.
inline SlowRegion clipped(std::span<const Vec2> a, std::span<const Vec2> b) {
  std::vector<RealPoint> polygon;
  for (const Vec2& p : a) polygon.push_back(real(p));
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    const RealPoint from = real(b[k]), along = real(b[(k + 1) % 3]) - from;
    std::vector<RealPoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const RealPoint p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const Real dp = cross(along, p - from), dq = cross(along, q - from);
      if (dp >= 0) kept.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + (dp / (dp - dq)) * (q - p));
    }
    polygon = std::move(kept);
  }
  SlowRegion region;
  for (std::size_t i = 0; i < polygon.size() && polygon.size() > 2; ++i)
    region.push_back({{polygon[i], polygon[(i + 1) % polygon.size()]}});
  return region;
}

/// The regions that two elements share; false when the kernel leaves that undecided.
inline bool common_regions(TriangleIntersector& kernel, const TriangleMesh& target, ElementId t,
                           const TriangleMesh& donor, ElementId d,
                           std::vector<SlowRegion>& regions) {
  regions.clear();
  const auto a = target.gather(t), b = donor.gather(d);
  if (target.degree() == 1 && donor.degree() == 1) {
    regions.push_back(clipped(a, b));
    if (regions.back().empty()) regions.clear();
    return true;
  }
  TriangleIntersections found;
  kernel.intersect(target.degree(), a, donor.degree(), b, found);
  if (found.relation == TriangleRelation::unresolved) return false;
  for (const CurvedPolygon& polygon : found.polygons) {
    SlowRegion region;
    for (const CurvedEdge& edge : polygon.edges()) {
      const bool first = edge.triangle == 0;
      SlowPiece piece;
      for (const Vec2& p : bernstein::side<Vec2>(first ? target.degree() : donor.degree(),
                                                 first ? a : b, edge.edge))
        piece.control.push_back(real(p));
      piece.s0 = edge.s0;
      piece.s1 = edge.s1;
      region.push_back(std::move(piece));
    }
    regions.push_back(std::move(region));
  }
  return true;
}

inline const IntervalRule& line_rule(int points) {
  static std::map<int, IntervalRule> rules;
  auto& rule = rules[points];
  if (rule.node.empty()) rule = gauss_legendre(points);
  return rule;
}

/// A point of a rule on a region and its places for both polynomials.
struct SlowPoint {
  Real weight;
  std::array<Real, 2> target, donor;
};

/// A fan of rays from a point of the middle to Gauss points of the boundary: in the plane, exactly,
/// when neither polynomial is mapped; else in the reference triangle of a mapped one.
/// @param degree  of the product of both polynomials in their coordinates
/// @param extra   Gauss points more than a polynomial would need along curves that are pulled back
/// @return false where a point is not found
inline bool fan(const SlowRegion& region, const SlowElement& target, const SlowElement& donor,
                int target_degree, int donor_degree, int extra, std::vector<SlowPoint>& out) {
  const SlowElement* const in = target.mapped()  ? &target
                                : donor.mapped() ? &donor
                                                 : nullptr;  // whose reference triangle
  const int tg = target.degree(), dg = donor.degree();
  const int map = in == nullptr ? 1 : in->degree();
  const int degree = in == nullptr ? target_degree + donor_degree
                     : in == &target
                         ? target_degree + donor_degree * (donor.mapped() ? 1 : tg) + 2 * (tg - 1)
                         : donor_degree + target_degree * dg + 2 * (dg - 1);
  const IntervalRule& radial = line_rule(degree / 2 + 2 + (target.mapped() ? extra / 2 : 0));
  struct Node {
    RealPoint q, dq;
  };
  std::vector<Node> nodes;
  RealPoint centre;
  std::array<Real, 2> place = {Real(1) / 3, Real(1) / 3};
  for (const SlowPiece& piece : region) {
    const int curve = static_cast<int>(piece.control.size()) - 1;
    const IntervalRule& line =
        line_rule((degree + 2) * (in == nullptr ? curve : 1) / 2 + 1 +
                  (in == nullptr ? 0 : extra * (map > 1 || curve > 1 ? 1 : 0)));
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      const auto [x, dx] = piece.at(piece.s0 + (piece.s1 - piece.s0) * Real(line.node[i]));
      const Real w = (piece.s1 - piece.s0) * Real(line.weight[i]);
      if (in == nullptr) {
        nodes.push_back({x, w * dx});
      } else {
        if (!in->find(x, place)) return false;
        if (std::min({place[0], place[1], 1 - place[0] - place[1]}) < -1e-7L) return false;
        const auto at = in->map(place[0], place[1]);
        const Real det = cross(at.du, at.dv);
        nodes.push_back(
            {{place[0], place[1]}, {w * cross(dx, at.dv) / det, w * cross(at.du, dx) / det}});
      }
      centre = centre + nodes.back().q;
    }
  }
  centre = (Real(1) / Real(nodes.size())) * centre;
  std::array<Real, 2> target_place = {Real(1) / 3, Real(1) / 3}, donor_place = target_place;
  for (const Node& node : nodes) {
    const RealPoint arm = node.q - centre;
    for (std::size_t i = 0; i < radial.node.size(); ++i) {
      const Real tau = radial.node[i];
      const RealPoint q = centre + tau * arm;
      Real w = Real(radial.weight[i]) * tau * cross(arm, node.dq);
      RealPoint x = q;
      if (in != nullptr) {
        const auto at = in->map(q.x, q.y);
        x = at.x;
        w *= cross(at.du, at.dv);
        (in == &target ? target_place : donor_place) = {q.x, q.y};
      }
      if (in != &target && !target.find(x, target_place)) return false;
      if (in != &donor && !donor.find(x, donor_place)) return false;
      out.push_back({w, target_place, donor_place});
    }
  }
  return true;
}

/// The mass matrix of a target element, factorised, and how much it magnifies errors.
struct SlowSystem {
  SlowSystem(const Space& space, ElementId e) {
    const int p = space.degree(e), g = space.mesh()->degree();
    const SlowElement element(space, e);
    const TriangleRule rule = triangle_rule(2 * p * (element.mapped() ? 1 : g) + 2 * (g - 1));
    size = static_cast<std::size_t>(bernstein::triangle_size(p));
    lower.assign(size * size, 0);
    std::vector<Real> phi, integral(size, 0);
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto at = element.map(rule.lambda[q][1], rule.lambda[q][2]);
      const Real w = Real(rule.weight[q]) * cross(at.du, at.dv);
      std::array<Real, 2> place = {rule.lambda[q][1], rule.lambda[q][2]};
      if (!element.mapped()) element.find(at.x, place);
      slow_basis(p, place[0], place[1], phi);
      area += w;
      for (std::size_t i = 0; i < size; ++i) {
        integral[i] += w * phi[i];
        for (std::size_t j = 0; j <= i; ++j) lower[i * size + j] += w * phi[i] * phi[j];
      }
    }
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t i = j; i < size; ++i) {
        Real sum = lower[i * size + j];
        for (std::size_t k = 0; k < j; ++k) sum -= lower[i * size + k] * lower[j * size + k];
        lower[i * size + j] = i == j ? std::sqrt(sum) : sum / lower[j * size + j];
      }
    }
    Real rows = 0;
    std::vector<Real> sum(size, 0);
    for (std::size_t k = 0; k < size; ++k) {
      std::vector<Real> column(size, 0);
      column[k] = 1;
      solve(column);
      for (std::size_t i = 0; i < size; ++i) {
        sum[i] += std::abs(column[i]) * integral[k];
        local_magnification =
            std::max(local_magnification, static_cast<double>(area * std::abs(column[i])));
      }
    }
    for (const Real s : sum) rows = std::max(rows, s);
    magnification = static_cast<double>(rows);
  }
  void solve(std::vector<Real>& b) const {
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i] -= lower[i * size + k] * b[k];
      b[i] /= lower[i * size + i];
    }
    for (std::size_t i = size; i-- > 0;) {
      for (std::size_t k = i + 1; k < size; ++k) b[i] -= lower[k * size + i] * b[k];
      b[i] /= lower[i * size + i];
    }
  }
  std::size_t size = 0;
  Real area = 0;
  std::vector<Real> lower;
  /// Integrals off by the fraction e of the basis functions' own may change coefficients by e times
  /// this: the largest row of |M^-1| times the integrals.
  double magnification = 0;
  /// A value off by one on the fraction e of the area, anywhere, may change coefficients by e times
  /// this: the largest entry of M^-1 times the area.
  double local_magnification = 0;
};

/// What one donor element gives to one target element.
struct SlowPair {
  Real area = 0;
  std::vector<Real> integrals;  ///< [function][component] of a field
};

/// @param extra  as for fan()
/// @return false where a point is not found
inline bool slow_pair(const std::vector<SlowRegion>& regions, const Space& target_space,
                      ElementId t, const Field& field, ElementId d, int extra, SlowPair& out) {
  const SlowElement target(target_space, t), donor(field.space(), d);
  const int pt = target_space.degree(t), pd = field.space().degree(d);
  const auto nc = static_cast<std::size_t>(field.components());
  const auto c = field.coefficients(d);
  std::vector<SlowPoint> points;
  for (const SlowRegion& region : regions)
    if (!fan(region, target, donor, pt, pd, extra, points)) return false;
  out.area = 0;
  out.integrals.assign(static_cast<std::size_t>(bernstein::triangle_size(pt)) * nc, 0);
  std::vector<Real> phi, psi, value(nc);
  for (const SlowPoint& point : points) {
    slow_basis(pt, point.target[0], point.target[1], phi);
    slow_basis(pd, point.donor[0], point.donor[1], psi);
    std::fill(value.begin(), value.end(), Real(0));
    for (std::size_t n = 0; n < psi.size(); ++n)
      for (std::size_t k = 0; k < nc; ++k) value[k] += psi[n] * Real(c[n * nc + k]);
    out.area += point.weight;
    for (std::size_t n = 0; n < phi.size(); ++n)
      for (std::size_t k = 0; k < nc; ++k)
        out.integrals[n * nc + k] += point.weight * phi[n] * value[k];
  }
  return true;
}

}  // namespace bezel::test
