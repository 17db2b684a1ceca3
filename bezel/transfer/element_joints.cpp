// Where the pieces around a region do not quite meet, and what is taken for wrong.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {
namespace {

/// Along a strip between edges that nearly coincide: its area is rounding, a few digits will do.
constexpr int strip_points = 6;

/// The largest area between a step and an edge of the element, over the element's diameter.
double joint_width(const OverlayMesh& mesh, std::int32_t e, const Vec2& step) {
  const auto corners = mesh.corners(e);
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max(largest, std::abs(cross(step, corners[(k + 1) % 3] - corners[k])));
  return largest / mesh.element_diameter[static_cast<std::size_t>(e)];
}

}  // namespace

// Where curves nearly coincide the pieces meet only to within the coincidence distance. Each end is
// joined to the nearest start. Neighbouring regions join the same points, so their bridges cancel
// in every sum over an element of either mesh, and closed regions have areas and masses that do not
// depend on where rays start.
double ElementTransfer::bridge_joints(RegionShape& shape) {
  piece_starts_.clear();
  piece_ends_.clear();
  const Vec2* p = shape.control.data();
  double extent = 0.0;
  for (const int degree : shape.degree) {
    piece_starts_.push_back(p[0]);
    piece_ends_.push_back(p[degree]);
    extent = std::max({extent, std::abs(p[0].x()), std::abs(p[0].y())});
    p += degree + 1;
  }
  const auto before = [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(piece_starts_.begin(), piece_starts_.end(), before);
  std::sort(piece_ends_.begin(), piece_ends_.end(), before);
  // The starts are sorted by x: the search goes outwards until x alone is too far.
  const auto take_nearest = [&](const Vec2& end, double limit) {
    const auto middle = std::lower_bound(piece_starts_.begin(), piece_starts_.end(), end, before);
    auto best = piece_starts_.end();
    for (auto i = middle; i != piece_starts_.end() && i->x() - end.x() <= limit; ++i) {
      const double distance = norm(*i - end);
      if (distance > limit) continue;
      limit = distance;
      best = i;
      if (distance == 0.0) break;
    }
    for (auto i = middle; i != piece_starts_.begin() && limit > 0.0;) {
      --i;
      if (end.x() - i->x() > limit) break;
      const double distance = norm(*i - end);
      if (distance > limit) continue;
      limit = distance;
      best = i;
    }
    return best;
  };
  const double rounding = point_rounding * extent;  // of a point reached along two curves
  std::size_t open = 0;
  for (const Vec2& end : piece_ends_) {
    const auto start = take_nearest(end, rounding);
    if (start == piece_starts_.end()) {
      piece_ends_[open++] = end;
    } else {
      piece_starts_.erase(start);
    }
  }
  piece_ends_.resize(open);
  double widest = 0.0;
  for (const Vec2& end : piece_ends_) {
    const auto start = take_nearest(end, std::numeric_limits<double>::infinity());
    const Vec2 step = *start - end;
    piece_starts_.erase(start);
    shape.bridges.push_back({end, step});
    shape.control.push_back(end);
    shape.control.push_back(end + step);
    shape.degree.push_back(1);
    widest = std::max(widest, norm(step));
  }
  return widest;
}

// Where edges nearly coincide the regions are bounded by the target's edge on either side of it.
// What lies between it and the donor's edge is given back to the donor there, so that each donor
// element gives what it has: to its one owner of the two target elements, or to the books where one
// mesh ends.
void ElementTransfer::give_strips(std::int32_t t, const ElementPieces& own, std::size_t components,
                                  GivenList& given, std::span<double> made, ElementBlocks* blocks) {
  const IntervalRule& line = rule(strip_points);
  const std::size_t pairs = given.donor.size();
  std::size_t entry = pairs;
  for (const std::int32_t d : own.donors) entry -= d == exterior ? 0 : 1;
  std::vector<double> mass(2 * components), values(components);
  for (std::size_t k = 0; k < own.donors.size(); ++k) {
    const std::int32_t near = own.donors[k];
    for (const Segment& segment : run_of(own, k)) {
      const std::int32_t far = segment.across;
      if (far == one_curve || far == near) continue;
      const auto& sides = target_.edge_sides[static_cast<std::size_t>(segment.target.edge)];
      if ((sides[0] != exterior ? sides[0] : sides[1]) != t) continue;
      const bool thin = is_thin_donor(near) || is_thin_donor(far);
      const auto curve = target_.edge(segment.target.edge);
      const auto other = donor_.edge(segment.source.edge);
      const double step = segment.target.to - segment.target.from;
      if (thin) begin_thin_strip(t, is_thin_donor(near) ? near : far, segment);
      std::fill(mass.begin(), mass.end(), 0.0);
      double area = 0.0;
      for (std::size_t q = 0; q < line.node.size(); ++q) {
        const auto [x, slope] = edge_point(curve, segment.target.from + step * line.node[q]);
        // Positive where T reaches beyond the donor's edge.
        const double width =
            thin ? thin_strip_width(line.node[q]) * line.weight[q]
                 : cross(slope, foot_point(other, x).point - x) * (step * line.weight[q]);
        area += width;
        std::size_t c0 = 0;
        for (const Group& g : groups_) {
          const auto nc = static_cast<std::size_t>(g.components);
          for (std::size_t side = 0; side < 2; ++side) {
            const std::int32_t d = side == 0 ? near : far;
            if (d == exterior) continue;
            std::array<double, 3> warm{};
            bool have_warm = false;
            const auto at = thin ? thin_strip_place(g, d, line.node[q])
                                 : detail::donor_place(g, donor_, d, x, warm, have_warm);
            evaluate_scaled(g.donor_space->degree(ElementId(d)), g.components,
                            g.donor_scaled(d).data(), at[0], at[1], values.data());
            for (std::size_t c = 0; c < nc; ++c)
              mass[side * components + c0 + c] += values[c] * width;
          }
          c0 += nc;
        }
      }
      if (near != exterior) {
        given.area[entry] -= area;
        if (element_.regions[k].mass_row >= 0) {
          const auto row = static_cast<std::size_t>(element_.regions[k].mass_row) * components;
          for (std::size_t c = 0; c < components; ++c) given.mass[row + c] -= mass[c];
        }
      }
      if (far != exterior) {
        given.target.push_back(t);
        given.donor.push_back(far);
        given.area.push_back(area);
        if (add_mass_row(given) >= 0)
          given.mass.insert(given.mass.end(),
                            mass.begin() + static_cast<std::ptrdiff_t>(components), mass.end());
      }
      if (blocks != nullptr) {
        // With signs as for the sums over donors below.
        const bool inside = near != exterior && far != exterior;
        const double sign = inside ? 1.0 : -1.0;
        const std::span<const double> both(mass);
        if (near != exterior) blocks->move_mass(near, -sign, both.first(components), !inside);
        if (far != exterior) blocks->move_mass(far, sign, both.last(components), !inside);
        continue;
      }
      for (std::size_t c = 0; c < components; ++c) {
        const double change = mass[components + c] - mass[c];
        if (near != exterior && far != exterior) {
          element_.masses[c] += change;
        } else {
          made[c] -= change;
        }
      }
    }
    entry += near == exterior ? 0 : 1;
  }
}

// The usual case.
bool ElementTransfer::is_closed(std::int32_t t, std::int32_t d, double gap) const {
  const auto closed = [gap](const OverlayMesh& mesh, std::int32_t e) {
    const auto i = static_cast<std::size_t>(e);
    return closes(gap, mesh.element_diameter[i], mesh.element_area[i]);
  };
  return closed(target_, t) && (d == exterior || closed(donor_, d));
}

// Partitions close to the rounding of the coordinates, which is large beside a thin element's
// width.
double ElementTransfer::largest_partition_residual(std::int32_t t) const {
  const Box2& box = target_.element_box[static_cast<std::size_t>(t)];
  return largest_joint_gap +
         coordinate_rounding * geometry_kernel::largest_coordinate(box) / target_.element_width(t);
}

// Nothing is decided better than the coincidence distance allows. An area may be off by that times
// the perimeter. Nearly parallel edges meet at a point that is known to within that distance over
// their angle, so an open joint is measured by the area that it opens along an element's edges: up
// to 142 times the distance in 40000 pairs of thin elements and elements far from the origin.
void ElementTransfer::note_region(std::int32_t t, std::int32_t d, double area, double gap,
                                  std::span<const Bridge> bridges, ElementOutcome& outcome) const {
  const double own_size = target_.element_diameter[static_cast<std::size_t>(t)];
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  double size = own_size, smaller = own_area;
  double donor_size = own_size, donor_area = own_area;
  if (d != exterior) {
    donor_size = donor_.element_diameter[static_cast<std::size_t>(d)];
    donor_area = donor_.element_area[static_cast<std::size_t>(d)];
    size = std::min(size, donor_size);
    smaller = std::min(smaller, donor_area);
  }
  outcome.max_joint_gap = std::max(outcome.max_joint_gap, gap / size);
  if (area >= 0.0 && is_closed(t, d, gap)) return;
  const double width = 2.0 * std::min(own_area / own_size, donor_area / donor_size);
  const double distance = coincidence_distance(
      width, geometry_kernel::largest_coordinate(target_.element_box[static_cast<std::size_t>(t)]));
  if (area < -std::max(largest_joint_gap * smaller, distance * size)) outcome.inconsistent = true;
  const double widest = std::max(largest_joint_gap * width, 256.0 * distance);
  if (gap <= widest) return;
  for (const Bridge& bridge : bridges) {
    double across = joint_width(target_, t, bridge.step);
    if (d != exterior) across = std::min(across, joint_width(donor_, d, bridge.step));
    if (across > widest) outcome.inconsistent = true;
  }
  if (bridges.empty()) outcome.inconsistent = true;
}

}  // namespace bezel::detail
