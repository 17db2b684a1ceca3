#include "bezel/fit/gordon_hall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/fit/jacobian_grid.hpp"
#include "bezel/fit/tensor_grid.hpp"

namespace bezel {
namespace {

using fit_detail::LobattoSample;

constexpr double corner_tolerance = 1e-12;  // of the diameter
constexpr double side_tolerance = 1e-10;    // of the diameter; control points magnify errors

int common_degree(const QuadSides& sides) {
  std::size_t most = 0;
  const auto include = [&](const std::vector<Vec2>& side, const char* which) {
    if (side.size() < 2 || side.size() > static_cast<std::size_t>(GordonHall::max_degree) + 1)
      throw InputError(fmt::format("the {} side has {} points, expected 2 to {}", which,
                                   side.size(), GordonHall::max_degree + 1));
    for (std::size_t i = 0; i < side.size(); ++i)
      if (!bernstein::checks::is_finite(side[i]))
        throw InputError(fmt::format("point {} of the {} side is not finite", i, which));
    most = std::max(most, side.size());
  };
  include(sides.bottom, "bottom");
  include(sides.right, "right");
  include(sides.top, "top");
  include(sides.left, "left");
  return static_cast<int>(most) - 1;
}

/// The same polynomial by its values at the nodes of a higher degree; the ends stay as they are.
std::vector<Vec2> raised(const std::vector<Vec2>& side, const LobattoBasis& basis) {
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  if (side.size() == n) return side;
  const LobattoBasis own(static_cast<int>(side.size()) - 1);
  std::vector<Vec2> out(n);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = own.evaluate(std::span<const Vec2>(side), basis.nodes()[i]);
  out.front() = side.front();
  out.back() = side.back();
  return out;
}

Box2 box_of(std::span<const Vec2> points) {
  Box2 box;
  for (const Vec2& p : points) box.include(p);
  return box;
}

/// Numbers points so that those within a distance share a number, in order of first appearance.
std::vector<std::size_t> number_points(const std::vector<Vec2>& points, double distance) {
  std::vector<std::size_t> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::iota(first.begin(), first.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x() < points[b].x() || (points[a].x() == points[b].x() && a < b);
  });
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t l = k; l-- > 0;) {
      const std::size_t a = order[k], b = order[l];
      if (points[a].x() - points[b].x() > distance) break;
      if (norm(points[a] - points[b]) <= distance) {
        const std::size_t low = std::min(first[a], first[b]), high = std::max(first[a], first[b]);
        std::replace(first.begin(), first.end(), high, low);
      }
    }
  return first;
}

}  // namespace

JacobianRange jacobian_range(const LobattoBasis& basis, std::span<const Vec2> nodes) {
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  bernstein::checks::size(nodes.size(), n * n, "nodes of a map");
  return fit_detail::JacobianGrid(basis).range(nodes);
}

void require_positive(const JacobianRange& range, ElementId element) {
  if (range.min > 0.0) return;
  throw InputError(
      {{}, 0, element.valid() ? "quadrilateral" : "", element.value},
      fmt::format(
          "the jacobian determinant is {:.3g} at xi = {:.4g}, eta = {:.4g} (x = {:.6g}, y = "
          "{:.6g}), expected above 0 (its largest value is {:.3g})",
          range.min, range.xi, range.eta, range.point.x(), range.point.y(), range.max));
}

GordonHall::GordonHall(const QuadSides& sides) : basis_(common_degree(sides)) {
  const std::vector<Vec2> b = raised(sides.bottom, basis_), t = raised(sides.top, basis_);
  const std::vector<Vec2> l = raised(sides.left, basis_), r = raised(sides.right, basis_);
  Box2 box;
  for (const auto* side : {&b, &t, &l, &r}) box.include(box_of(*side));
  const auto meet = [&](const Vec2& p, const Vec2& q, const char* which) {
    const double apart = norm(p - q), allowed = corner_tolerance * box.diameter();
    if (!(apart <= allowed))
      throw InputError(
          fmt::format("the sides at the {} corner end {:.3g} apart, at ({:.17g}, {:.17g}) and "
                      "({:.17g}, {:.17g}), expected at most {:.3g}",
                      which, apart, p.x(), p.y(), q.x(), q.y(), allowed));
  };
  meet(b.front(), l.front(), "bottom left");
  meet(b.back(), r.front(), "bottom right");
  meet(t.back(), r.back(), "top right");
  meet(t.front(), l.back(), "top left");

  const auto n = static_cast<std::size_t>(degree()) + 1;
  const auto xi = basis_.nodes();
  nodes_.resize(n * n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      Vec2& p = nodes_[j * n + i];
      if (j == 0 || j + 1 == n) {
        p = j == 0 ? b[i] : t[i];
      } else if (i == 0 || i + 1 == n) {
        p = i == 0 ? l[j] : r[j];
      } else {
        const double x = 0.5 * (1.0 + xi[i]), y = 0.5 * (1.0 + xi[j]);
        const double x1 = 0.5 * (1.0 - xi[i]), y1 = 0.5 * (1.0 - xi[j]);
        p = y1 * b[i] + y * t[i] + x1 * l[j] + x * r[j] -
            (x1 * (y1 * b.front() + y * t.front()) + x * (y1 * b.back() + y * t.back()));
      }
    }
}

Vec2 GordonHall::operator()(double xi, double eta) const {
  const std::array<double, 1> at_xi{xi}, at_eta{eta};
  const LobattoSample a = fit_detail::sample(basis_, at_xi), b = fit_detail::sample(basis_, at_eta);
  return fit_detail::apply(a, a.value, b.value, nodes())[0];
}

double GordonHall::jacobian(double xi, double eta) const {
  const std::array<double, 1> at_xi{xi}, at_eta{eta};
  const LobattoSample a = fit_detail::sample(basis_, at_xi), b = fit_detail::sample(basis_, at_eta);
  return cross(fit_detail::apply(a, a.derivative, b.value, nodes())[0],
               fit_detail::apply(a, a.value, b.derivative, nodes())[0]);
}

double GordonHall::area() const {
  const auto at = fit_detail::evaluate_grid(fit_detail::sample_at_nodes(basis_), nodes());
  const auto n = static_cast<std::size_t>(degree()) + 1;
  double area = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    double row = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      row += basis_.weights()[i] * cross(at.d_xi[j * n + i], at.d_eta[j * n + i]);
    area += basis_.weights()[j] * row;
  }
  return area;
}

std::vector<Vec2> GordonHall::control() const {
  if (degree() > max_quad_degree)
    throw InputError(fmt::format("found a map of degree {}, expected at most {} for control points",
                                 degree(), max_quad_degree));
  const auto n = static_cast<std::size_t>(degree()) + 1;
  std::vector<Vec2> out(n * n), line(n);
  for (std::size_t j = 0; j < n; ++j) {
    const auto row = basis_.to_bernstein(nodes().subspan(j * n, n));
    std::copy(row.begin(), row.end(), out.begin() + static_cast<std::ptrdiff_t>(j * n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) line[j] = out[j * n + i];
    const auto column = basis_.to_bernstein(std::span<const Vec2>(line));
    for (std::size_t j = 0; j < n; ++j) out[j * n + i] = column[j];
  }
  return out;
}

QuadMesh join(std::span<const GordonHall> maps) {
  if (maps.empty()) throw InputError("found no maps to join, expected at least one");
  int g = 1;
  Box2 box;
  for (std::size_t e = 0; e < maps.size(); ++e) {
    require_positive(maps[e].jacobian_range(), ElementId(e));
    g = std::max(g, maps[e].degree());
    box.include(box_of(maps[e].nodes()));
  }
  const auto size = static_cast<std::size_t>(quad_size(g));
  // Every element with its own nodes first; then corners, then sides find those they coincide with.
  std::vector<Vec2> control;
  for (const GordonHall& map : maps) {
    if (map.degree() == g) {
      const auto own = map.control();
      control.insert(control.end(), own.begin(), own.end());
      continue;
    }
    const auto n = static_cast<std::size_t>(map.degree()) + 1;
    QuadSides sides;
    const auto nodes = map.nodes();
    for (std::size_t i = 0; i < n; ++i) {
      sides.bottom.push_back(nodes[i]);
      sides.top.push_back(nodes[n * (n - 1) + i]);
      sides.left.push_back(nodes[i * n]);
      sides.right.push_back(nodes[i * n + n - 1]);
    }
    const LobattoBasis basis(g);
    sides.bottom = raised(sides.bottom, basis);  // one side of degree g raises the map
    const auto own = GordonHall(sides).control();
    control.insert(control.end(), own.begin(), own.end());
  }
  std::vector<Vec2> corners;
  for (std::size_t e = 0; e < maps.size(); ++e)
    for (int side = 0; side < 4; ++side)
      corners.push_back(control[e * size + static_cast<std::size_t>(quad_side_index(g, side, 0))]);
  const auto corner = number_points(corners, corner_tolerance * box.diameter());

  std::vector<NodeId> elements(control.size());
  for (std::size_t i = 0; i < elements.size(); ++i) elements[i] = NodeId(i);
  const auto at = [&](std::size_t e, int side, int m) -> std::size_t {
    return e * size + static_cast<std::size_t>(quad_side_index(g, side, m));
  };
  struct Side {
    std::size_t low, high, element;
    int side;
    bool reversed;
  };
  std::vector<Side> sides;
  for (std::size_t e = 0; e < maps.size(); ++e)
    for (int side = 0; side < 4; ++side) {
      const std::size_t a = corner[4 * e + static_cast<std::size_t>(side)];
      const std::size_t b = corner[4 * e + static_cast<std::size_t>((side + 1) % 4)];
      elements[at(e, side, 0)] = NodeId(at(a / 4, static_cast<int>(a % 4), 0));
      sides.push_back({std::min(a, b), std::max(a, b), e, side, a > b});
    }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.low < b.low || (a.low == b.low && a.high < b.high);
  });
  for (std::size_t k = 0; k < sides.size(); ++k)
    for (std::size_t l = k; l-- > 0;) {
      const Side &mine = sides[k], &other = sides[l];
      if (mine.low != other.low || mine.high != other.high) break;
      const auto facing = [&](int m) {
        return at(other.element, other.side, mine.reversed == other.reversed ? m : g - m);
      };
      bool same = true;
      for (int m = 1; m < g && same; ++m)
        same = norm(control[at(mine.element, mine.side, m)] - control[facing(m)]) <=
               side_tolerance * box.diameter();
      if (!same) continue;
      for (int m = 1; m < g; ++m) elements[at(mine.element, mine.side, m)] = elements[facing(m)];
      break;
    }
  // Leave out the nodes that were replaced.
  std::vector<std::int32_t> number(control.size(), -1);
  std::vector<Vec2> used;
  for (NodeId& n : elements) {
    std::int32_t& id = number[n.index()];
    if (id < 0) {
      id = static_cast<std::int32_t>(used.size());
      used.push_back(control[n.index()]);
    }
    n = NodeId(id);
  }
  return {g, std::move(used), std::move(elements)};
}

std::vector<Vec2> lobatto_nodes(const QuadMesh& mesh, ElementId e, const LobattoBasis& basis) {
  const int g = mesh.degree();
  const auto m = static_cast<std::size_t>(g) + 1;
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  const std::vector<Vec2> control = mesh.gather(e);
  std::vector<Vec2> half(m * n), line(m), out(n * n);
  using bernstein::kernel::evaluate_unchecked;
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i < n; ++i)
      half[j * n + i] =
          evaluate_unchecked(g, control.data() + j * m, 0.5 * (1.0 + basis.nodes()[i]));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < m; ++j) line[j] = half[j * n + i];
    for (std::size_t j = 0; j < n; ++j)
      out[j * n + i] = evaluate_unchecked(g, line.data(), 0.5 * (1.0 + basis.nodes()[j]));
  }
  return out;
}

}  // namespace bezel
