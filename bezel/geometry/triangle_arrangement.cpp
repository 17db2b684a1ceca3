#include "bezel/geometry/triangle_arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr double u = 0x1p-53;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

bool is_corner(const BoundaryPlace& p) {
  return p.s == 0.0;
}

bool before(const BoundaryPlace& p, const BoundaryPlace& q) {
  return p.edge != q.edge ? p.edge < q.edge : p.s < q.s;
}

/// A parameter with the interval that holds the true one; ends of the side exactly.
struct Parameter {
  double s, lo, hi;
  bool end;
};

bool is_end(double s, double lo, double hi) {
  return lo == hi && (s == 0.0 || s == 1.0);
}

/// The computed parameter is within half the error of the true one, which is in the box, too.
Parameter parameter_of(double s, double lo, double hi, double error) {
  if (is_end(s, lo, hi)) return {s, s, s, true};
  // A true parameter inside (0, 1) that is rounded to an end stays inside.
  s = std::clamp(s, std::numeric_limits<double>::min(), 1.0 - u);
  double least = std::max(0.0, s - error), most = std::min(1.0, s + error);
  if (lo < hi) {
    least = std::max(least, lo);
    most = std::min(most, hi);
  }
  return {s, std::min(least, s), std::max(most, s), false};
}

void set_place(BoundaryJoint& joint, int k, int side, const Parameter& p) {
  const auto i = at(k);
  if (p.end)
    joint.place[i] = {p.s == 0.0 ? side : (side + 1) % 3, 0.0};
  else
    joint.place[i] = {side, p.s};
  joint.lo[i] = p.end ? 0.0 : p.lo;
  joint.hi[i] = p.end ? 0.0 : p.hi;
}

/// 1 when the control points are the same, -1 when in opposite order, 0 otherwise: neighbours in a
/// mesh, or the same triangle. A side of a triangle that does not overlap itself meets itself
/// nowhere else.
int same_curve(std::span<const Vec2> a, std::span<const Vec2> b) {
  if (a.size() != b.size()) return 0;
  if (std::equal(a.begin(), a.end(), b.begin())) return 1;
  return std::equal(a.begin(), a.end(), b.rbegin()) ? -1 : 0;
}

Box2 part_box(const CurveCache& side, double s0, double s1) {
  PointBuffer<max_curve_points> points;
  const int d = static_cast<int>(side.control.size()) - 1;
  restrict_curve(d, side.control.data(), s0, s1, points.data());
  return control_box(d, points.data());
}

}  // namespace

void TriangleSides::assign(int g, std::span<const Vec2> control) {
  const auto n = at(g + 1);
  points_.resize(3 * n);
  box_ = Box2();
  for (int side = 0; side < 3; ++side) {
    const std::size_t first = at(side) * n;
    for (int m = 0; m <= g; ++m)
      points_[first + at(m)] = control[at(bernstein::triangle_side_index(g, side, m))];
    cache_[at(side)] = cache_curve(std::span<const Vec2>(points_).subspan(first, n));
    box_.include(cache_[at(side)].box);
  }
}

bool Arrangement::fail(const char* reason, const Box2& where) {
  reason_ = reason;
  where_ = where;
  return false;
}

bool Arrangement::build(const TriangleSides& a, const TriangleSides& b,
                        double coincidence_distance) {
  sides_ = {&a, &b};
  joints_.clear();
  overlaps_.clear();
  parts_[0].clear();
  parts_[1].clear();
  corner_inside_ = {};
  reason_.clear();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!meet(i, j, coincidence_distance)) return false;
  if (joints_.empty()) {
    // One contains the other, or they are apart; corners decide.
    for (int k = 0; k < 2; ++k) {
      const Place place = place_of(k, 0, 0.0);
      if (place == Place::unknown) {
        Box2 where;
        where.include(sides(k).corner(0));
        return fail("a corner is too near to the other triangle's boundary", where);
      }
      corner_inside_[at(k)] = place == Place::inside;
      if (corner_inside_[at(k)]) break;
    }
    return true;
  }
  return sort_joints() && classify(0) && classify(1);
}

bool Arrangement::meet(int i, int j, double coincidence_distance) {
  const CurveCache &a = sides(0).cache(i), &b = sides(1).cache(j);
  const int same = same_curve(a.control, b.control);
  if (same != 0) {
    found_ = CurveIntersections();
    found_.overlaps.push_back({0.0, 1.0, same > 0 ? 0.0 : 1.0, same > 0 ? 1.0 : 0.0, 0.0});
  } else {
    intersect(a, b, {coincidence_distance}, found_);
  }
  if (!found_.unresolved.empty()) {
    const UnresolvedBox& box = found_.unresolved.front();
    return fail(box.reason.c_str(), part_box(a, box.s_lo, box.s_hi));
  }
  for (const Crossing& c : found_.crossings) {
    // Where a corner lies on a side only that side's speed counts, else the angle as well.
    const bool corner = is_end(c.s, c.s_lo, c.s_hi) || is_end(c.t, c.t_lo, c.t_hi);
    const auto error = [&](const CurveCache& side, double at) {
      double amplification = c.condition;
      if (corner) {
        const int d = static_cast<int>(side.control.size()) - 1;
        amplification = 8.0 * std::max(a.magnitude, b.magnitude) /
                        norm(curve_point(d, side.control.data(), at).derivative);
      }
      return 8.0 * u * std::max(1.0, amplification);
    };
    const Parameter s = parameter_of(c.s, c.s_lo, c.s_hi, error(a, c.s)),
                    t = parameter_of(c.t, c.t_lo, c.t_hi, error(b, c.t));
    BoundaryJoint joint{};
    set_place(joint, 0, i, s);
    set_place(joint, 1, j, t);
    joint.sign = c.certified && !s.end && !t.end ? c.sign : 0;
    // The same bits when the triangles change places.
    joint.point = 0.5 * (c.point_a + c.point_b);
    if (!add_contact(joint)) return false;
  }
  const auto add_place = [&](double s, double t, double slack) {
    BoundaryJoint joint{};
    const auto parameter = [&](double x) {
      const bool end = x == 0.0 || x == 1.0;
      return Parameter{x, end ? x : std::max(0.0, x - slack), end ? x : std::min(1.0, x + slack),
                       end};
    };
    set_place(joint, 0, i, parameter(s));
    set_place(joint, 1, j, parameter(t));
    const auto point_of = [](const CurveCache& c, double x) {
      return curve_point(static_cast<int>(c.control.size()) - 1, c.control.data(), x).value;
    };
    joint.point = 0.5 * (point_of(a, s) + point_of(b, t));
    return add_contact(joint);
  };
  // The parameters of a touching point are known to the root of their rounding.
  for (const Tangency& c : found_.tangencies)
    if (!add_place(c.s, c.t, 0x1p-24)) return false;
  for (const Overlap& o : found_.overlaps) {
    if (!add_place(o.s0, o.t0, 0x1p-48) || !add_place(o.s1, o.t1, 0x1p-48)) return false;
    overlaps_.push_back({{i, j}, o.s0, o.s1, o.t0, o.t1});
  }
  return true;
}

/// A corner is seen from two sides of its own triangle, and perhaps from two of the other: one
/// joint.
bool Arrangement::add_contact(const BoundaryJoint& contact) {
  if (contact.sign != 0) {
    joints_.push_back(contact);
    return true;
  }
  std::size_t first = joints_.size();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    BoundaryJoint& joint = joints_[i];
    if (joint.sign != 0) continue;
    const bool one = joint.place == contact.place ||
                     (is_corner(contact.place[0]) && joint.place[0] == contact.place[0]) ||
                     (is_corner(contact.place[1]) && joint.place[1] == contact.place[1]);
    if (!one) continue;
    if (first == joints_.size()) {
      first = i;
      if (!join(joint, contact)) return false;
    } else {  // two joints seen apart so far turn out to be one
      if (!join(joints_[first], joint)) return false;
      joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(i--));
    }
  }
  if (first == joints_.size()) {
    joints_.push_back(contact);
    BoundaryJoint& joint = joints_.back();
    for (int k = 1; k >= 0; --k)
      if (is_corner(joint.place[at(k)])) joint.point = sides(k).corner(joint.place[at(k)].edge);
  }
  return true;
}

bool Arrangement::join(BoundaryJoint& joint, const BoundaryJoint& contact) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (joint.place[k] == contact.place[k]) continue;
    const bool old_corner = is_corner(joint.place[k]), new_corner = is_corner(contact.place[k]);
    if (old_corner && !new_corner) continue;
    if (!old_corner && new_corner) {
      joint.place[k] = contact.place[k];
      joint.lo[k] = contact.lo[k];
      joint.hi[k] = contact.hi[k];
      if (k == 0 || !is_corner(joint.place[0]))
        joint.point = sides(static_cast<int>(k)).corner(joint.place[k].edge);
      continue;
    }
    if (!old_corner && joint.place[k].edge == contact.place[k].edge &&
        joint.lo[k] <= contact.hi[k] && contact.lo[k] <= joint.hi[k])
      continue;
    Box2 where;
    where.include(joint.point);
    where.include(contact.point);
    return fail("a corner seems to meet the other boundary in two places", where);
  }
  return true;
}

bool Arrangement::sort_joints() {
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<std::int32_t>& order = order_[k];
    order.resize(joints_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    const auto joint = [&](std::int32_t i) -> BoundaryJoint& {
      return joints_[static_cast<std::size_t>(i)];
    };
    std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
      return before(joint(i).place[k], joint(j).place[k]);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      joint(order[i]).position[k] = static_cast<std::int32_t>(i);
    for (std::size_t i = 1; i < order.size(); ++i) {
      const BoundaryJoint &p = joint(order[i - 1]), &q = joint(order[i]);
      if (p.place[k].edge != q.place[k].edge || is_corner(p.place[k]) || p.hi[k] < q.lo[k])
        continue;
      Box2 where;
      where.include(p.point);
      where.include(q.point);
      return fail("the order of common points along a side is lost in rounding", where);
    }
  }
  return true;
}

bool Arrangement::classify(int k) {
  const std::vector<std::int32_t>& order = order_[at(k)];
  std::vector<BoundaryPart>& parts = parts_[at(k)];
  for (std::size_t i = 0; i < order.size(); ++i) {
    BoundaryPart part{order[i], order[i + 1 < order.size() ? i + 1 : 0], PartClass::outside};
    if (!classify_part(k, part)) return false;
    parts.push_back(part);
  }
  return true;
}

bool Arrangement::classify_part(int k, BoundaryPart& part) {
  const BoundaryJoint &p = joints_[static_cast<std::size_t>(part.from)],
                      &q = joints_[static_cast<std::size_t>(part.to)];
  // cross(a', b') > 0: the second triangle's side passes from right to left of the first's, into
  // the first; and the first's goes from left to right, out of the second.
  const int enters = k == 0 ? -1 : 1;
  const int at_start = p.sign * enters, at_end = -q.sign * enters;
  if (at_start + at_end != 0) {  // known, and not contradictory
    part.place = at_start + at_end > 0 ? PartClass::inside : PartClass::outside;
    return true;
  }
  // On a side of the other triangle?
  const BoundaryPlace &start = p.place[at(k)], &end = q.place[at(k)];
  const double s1 = end.edge == start.edge && start.s < end.s          ? end.s
                    : end.s == 0.0 && end.edge == (start.edge + 1) % 3 ? 1.0
                                                                       : -1.0;
  if (s1 >= 0.0) {
    const double s = 0.5 * (start.s + s1);
    for (const SideOverlap& o : overlaps_) {
      if (o.edge[at(k)] != start.edge) continue;
      const double lo = k == 0 ? o.s0 : std::min(o.t0, o.t1),
                   hi = k == 0 ? o.s1 : std::max(o.t0, o.t1);
      if (!(lo < s && s < hi)) continue;
      part.place = o.t0 < o.t1 ? PartClass::along : PartClass::against;
      return true;
    }
  }
  return classify_exactly(k, part);
}

/// By a point strictly between the joints: no common point is there, so any one will do.
bool Arrangement::classify_exactly(int k, BoundaryPart& part) {
  const BoundaryJoint &p = joints_[static_cast<std::size_t>(part.from)],
                      &q = joints_[static_cast<std::size_t>(part.to)];
  const BoundaryPlace &start = p.place[at(k)], &end = q.place[at(k)];
  const auto decided = [&](int side, double s) {
    const Place place = place_of(k, side, s);
    part.place = place == Place::inside ? PartClass::inside : PartClass::outside;
    return place != Place::unknown;
  };
  int side = start.edge;
  double lo = p.hi[at(k)];
  for (bool first = true;; first = false) {
    // The joint's own side comes round again when the part goes once around.
    const bool last = side == end.edge && (!first || start.s < end.s);
    const double hi = last ? q.lo[at(k)] : 1.0;
    for (const double f : {0.5, 0.3125, 0.6875}) {
      const double s = lo + f * (hi - lo);
      if (lo < s && s < hi && decided(side, s)) return true;
    }
    if (last) break;
    side = (side + 1) % 3;
    lo = 0.0;
    if (side == end.edge && end.s == 0.0) break;
    if (decided(side, 0.0)) return true;
  }
  Box2 where;
  where.include(p.point);
  where.include(q.point);
  return fail("what is between two common points could not be told", where);
}

Arrangement::Place Arrangement::place_of(int k, int side, double s) const {
  const TriangleSides &own = sides(k), &other = sides(1 - k);
  const ExactCurvePoint p(own.control(side), s);
  if (p.error() == 0.0 && !other.box().contains(p.rounded())) return Place::outside;
  int turns = 0;
  for (int j = 0; j < 3; ++j) {
    const PointOnCurve found = point_on_curve(other.control(j), p);
    if (!found.incidences.empty()) return Place::unknown;
    turns += found.ray_crossings;
  }
  return turns > 0 ? Place::inside : Place::outside;
}

}  // namespace bezel::geometry_kernel
