#include "bezel/geometry/curved_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {
namespace {

constexpr int max_gauss_points = 200;

void check_not_empty(const CurvedPolygon& polygon) {
  if (polygon.size() == 0)
    throw InputError("the curved polygon has no edges, expected at least one");
}

}  // namespace

CurvedPolygon::CurvedPolygon(std::vector<CurvedVertex> vertices, std::vector<CurvedEdge> edges,
                             std::vector<Vec2> control, std::vector<std::size_t> first)
    : vertices_(std::move(vertices)),
      edges_(std::move(edges)),
      control_(std::move(control)),
      first_(std::move(first)) {
  const auto fail = [](const std::string& what) { throw InputError("curved polygon: " + what); };
  if (first_.size() != edges_.size() + 1 || first_.front() != 0 || first_.back() != control_.size())
    fail("the edges' control points do not fill the " + std::to_string(control_.size()) + " given");
  for (const CurvedVertex& v : vertices_)
    if (!std::isfinite(v.point.x()) || !std::isfinite(v.point.y())) fail("a joint is not finite");
  for (std::size_t i = 0; i < edges_.size(); ++i)
    if (edges_[i].vertex < 0 || static_cast<std::size_t>(edges_[i].vertex) >= vertices_.size())
      fail("edge " + std::to_string(i) + " begins at joint " + std::to_string(edges_[i].vertex) +
           ", there are " + std::to_string(vertices_.size()));
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (first_[i + 1] < first_[i] + 2 || first_[i + 1] > control_.size())
      fail("edge " + std::to_string(i) + " has fewer than two control points");
    geometry_kernel::checked_degree(this->control(i));
    const auto joint = [&](std::size_t edge) {
      return vertices_[static_cast<std::size_t>(edges_[edge].vertex)].point;
    };
    if (!(this->control(i).front() == joint(i)) ||
        !(this->control(i).back() == joint(i + 1 < size() ? i + 1 : 0)))
      fail("edge " + std::to_string(i) + " does not begin and end at its joints");
  }
}

Box2 CurvedPolygon::box() const {
  Box2 box;
  for (const Vec2& p : control_) box.include(p);
  return box;
}

double area(const CurvedPolygon& polygon) {
  check_not_empty(polygon);
  // As for a triangle: 1/2 closed integral of x dy - y dx by the Bernstein product formula,
  // relative to the first joint.
  const Vec2 origin = polygon.control(0).front();
  double sum = 0.0;
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const std::span<const Vec2> c = polygon.control(e);
    const int d = static_cast<int>(c.size()) - 1;
    for (int i = 0; i <= d; ++i) {
      const Vec2 p = c[static_cast<std::size_t>(i)] - origin;
      for (int j = 0; j < d; ++j) {
        const auto k = static_cast<std::size_t>(j);
        const double weight = binomial(d, i) * binomial(d - 1, j) / binomial(2 * d - 1, i + j);
        sum += weight * cross(p, c[k + 1] - c[k]);
      }
    }
  }
  return 0.25 * sum;
}

Vec2 centroid(const CurvedPolygon& polygon) {
  check_not_empty(polygon);
  const Vec2 origin = polygon.control(0).front();
  double twice = 0.0, size = 0.0;
  Vec2 moment;
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const std::span<const Vec2> c = polygon.control(e);
    const int d = static_cast<int>(c.size()) - 1;
    // 2 area = integral of cross(c, c'), 3 moment = integral of c cross(c, c'), degree 3 d - 1.
    const IntervalRule rule = gauss_legendre((3 * d + 1) / 2);
    for (int k = 0; k < rule.size(); ++k) {
      const auto q = static_cast<std::size_t>(k);
      const auto at = geometry_kernel::curve_point(d, c.data(), rule.node[q], origin);
      const double swept = rule.weight[q] * cross(at.value, at.derivative);
      twice += swept;
      size += std::fabs(swept);
      moment += swept * at.value;
    }
  }
  if (!(std::fabs(twice) > 0x1p-48 * size))
    throw InputError("the curved polygon's area is zero to rounding, it has no centroid");
  return origin + (2.0 / (3.0 * twice)) * moment;
}

double moment(const CurvedPolygon& polygon, int a, int b) {
  check_not_empty(polygon);
  std::size_t points = 0;
  for (std::size_t e = 0; e < polygon.size(); ++e)
    points = std::max(points, polygon.control(e).size());
  const int degree = static_cast<int>(points) - 1;
  if (a < 0 || b < 0 || a > 400 || b > 400 || (a + b + 2) * degree > 2 * max_gauss_points)
    throw InputError("the moment's exponents are " + std::to_string(a) + " and " +
                     std::to_string(b) + ", expected a, b >= 0 and (a + b + 2) times the degree " +
                     std::to_string(degree) + " at most " + std::to_string(2 * max_gauss_points));
  // Green: integral of x^a y^b = closed integral of x^(a+1) y^b / (a+1) dy.
  double sum = 0.0;
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const std::span<const Vec2> c = polygon.control(e);
    const int d = static_cast<int>(c.size()) - 1;
    const IntervalRule rule = gauss_legendre(((a + b + 2) * d + 1) / 2);
    for (int k = 0; k < rule.size(); ++k) {
      const auto q = static_cast<std::size_t>(k);
      const auto at = geometry_kernel::curve_point(d, c.data(), rule.node[q]);
      double value = at.value.x() / (a + 1);
      for (int i = 0; i < a; ++i) value *= at.value.x();
      for (int i = 0; i < b; ++i) value *= at.value.y();
      sum += rule.weight[q] * value * at.derivative.y();
    }
  }
  return sum;
}

PointInPolygon contains(const CurvedPolygon& polygon, const Vec2& p) {
  check_not_empty(polygon);
  geometry_kernel::check_point(p);
  int turns = 0;
  bool undecided = false;
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const auto found = geometry_kernel::point_on_curve(polygon.control(e), p);
    for (const auto& incidence : found.incidences)
      if (incidence.proven) return PointInPolygon::boundary;
    undecided = undecided || !found.incidences.empty();
    turns += found.ray_crossings;
  }
  if (undecided) return PointInPolygon::undecided;
  return turns != 0 ? PointInPolygon::inside : PointInPolygon::outside;
}

}  // namespace bezel
