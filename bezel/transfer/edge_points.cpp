#include "bezel/transfer/edge_points.hpp"

#include <array>

#include "bezel/numeric/quadrature.hpp"

namespace bezel::detail {
namespace {

/// A point of a curve in an element may lie this much outside it, in barycentrics.
constexpr double outside = 1e-6;

}  // namespace

const EdgePoints::Rule& EdgePoints::rule(int points) {
  const auto n = static_cast<std::size_t>(points);
  if (rules_.size() <= n) rules_.resize(n + 1);
  Rule& made = rules_[n];
  if (made.count == 0) {
    const IntervalRule gauss = gauss_legendre(points);
    made.count = n;
    made.blocks = padded_to_lanes(n) / lanes;
    made.node.assign(gauss.node.begin(), gauss.node.end());
    made.weight.assign(gauss.weight.begin(), gauss.weight.end());
    made.node.resize(padded_to_lanes(n), gauss.node.back());
    made.weight.resize(padded_to_lanes(n), 0.0);
  }
  return made;
}

void EdgePoints::append_side(const OverlayMesh& mesh, std::int32_t element, const Part& part,
                             int points, CurvePoints& to) {
  static constexpr std::array<std::array<double, 2>, 3> corner = {
      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};
  const auto& sides = mesh.element_edges[static_cast<std::size_t>(element)];
  std::size_t side = 0;
  while (side < 2 && sides[side].edge.value != part.edge) ++side;
  const bool reversed = sides[side].reversed;
  const auto &a = corner[side], &b = corner[(side + 1) % 3];
  const double ax = b[0] - a[0], ay = b[1] - a[1];
  const double step = part.to - part.from;
  const double slope = reversed ? -step : step;
  const Rule& line = rule(points);
  const std::size_t first = to.append(line.count);
  for (std::size_t i = 0; i < line.count; ++i) {
    const double t = part.from + step * line.node[i];
    const double m = reversed ? 1.0 - t : t;
    to.x[first + i] = a[0] + m * ax;
    to.y[first + i] = a[1] + m * ay;
    to.dx[first + i] = ax * slope * line.weight[i];
    to.dy[first + i] = ay * slope * line.weight[i];
  }
}

std::size_t EdgePoints::append_curve(std::span<const Vec2> control, const Part& part,
                                     const Vec2& origin, int points, CurvePoints& to) {
  const Rule& line = rule(points);
  const std::size_t first = to.append(line.count);
  to.append(line.blocks * lanes - line.count);  // written, then given back
  to.count = first + line.count;
  fit_curve(control, origin, part.from, part.to - part.from, line.blocks, line.node.data(),
            line.weight.data(), to.x.data() + first, to.y.data() + first, to.dx.data() + first,
            to.dy.data() + first);
  return first;
}

void pad(CurvePoints& points) {
  const std::size_t count = points.count, whole = padded_to_lanes(count);
  for (std::size_t i = count; i < whole; ++i) {
    points.x[i] = points.x[count - 1];
    points.y[i] = points.y[count - 1];
    points.dx[i] = points.dy[i] = 0.0;
  }
}

bool in_reference_triangle(const CurvePoints& points) {
  bool all = true;
  for (std::size_t i = 0; i < points.count; ++i)
    all = all && points.x[i] >= -outside && points.y[i] >= -outside &&
          points.x[i] + points.y[i] <= 1.0 + outside;
  return all;
}

}  // namespace bezel::detail
