#include "bezel/geometry/triangle_arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using short_names::at;
using short_names::u;

bool is_corner(const BoundaryPlace& p) {
  return p.s == 0.0;
}

bool before(const BoundaryPlace& p, const BoundaryPlace& q) {
  return p.edge != q.edge ? p.edge < q.edge : p.s < q.s;
}

/// A parameter with the interval that holds the true one; ends of the side exactly.
struct Parameter {
  double s, lo, hi, error;
  bool end;
};

/// Common points at an end, and such that are rounded to it: `settle_corners` tells them apart.
bool is_end(double s) {
  return s == 0.0 || s == 1.0;
}

/// The computed parameter is within half the error of the true one, which is in the box, too.
Parameter parameter_of(double s, double lo, double hi, double error) {
  if (is_end(s)) return {s, s, s, error, true};
  double least = std::max(0.0, s - error), most = std::min(1.0, s + error);
  if (lo < hi) {
    least = std::max(least, lo);
    most = std::min(most, hi);
  }
  return {s, std::min(least, s), std::max(most, s), error, false};
}

void set_place(BoundaryJoint& joint, int k, int side, const Parameter& p) {
  const auto i = at(k);
  if (p.end)
    joint.place[i] = {p.s == 0.0 ? side : (side + 1) % 3, 0.0};
  else
    joint.place[i] = {side, p.s};
  joint.seen[i] = !p.end ? 0 : p.s == 0.0 ? 1 : 2;
  joint.error[i] = p.error;
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

/// Two sides with one end in common that provably meet nowhere else: seen from there, the control
/// points of each lie in a cone, and the cones are apart. With cross(a_i, b_j) > 0 for all i and j
/// no sum of the a_i with weights >= 0 is one of the b_j.
struct CommonEnd {
  bool alone = false;
  double s = 0.0, t = 0.0;
};
CommonEnd common_end(std::span<const Vec2> a, std::span<const Vec2> b) {
  CommonEnd out;
  int count = 0;
  for (const bool last_a : {false, true})
    for (const bool last_b : {false, true})
      if ((last_a ? a.back() : a.front()) == (last_b ? b.back() : b.front())) {
        ++count;
        out.s = last_a ? 1.0 : 0.0;
        out.t = last_b ? 1.0 : 0.0;
      }
  if (count != 1) return out;
  const Vec2 end = out.s == 0.0 ? a.front() : a.back();
  const std::span<const Vec2> rest_a = a.subspan(out.s == 0.0 ? 1 : 0, a.size() - 1),
                              rest_b = b.subspan(out.t == 0.0 ? 1 : 0, b.size() - 1);
  bool left = true, right = true;
  for (const Vec2& p : rest_a)
    for (const Vec2& q : rest_b) {
      const Vec2 x = p - end, y = q - end;
      const double positive = x.x() * y.y(), negative = x.y() * y.x();
      // Differences, products and their difference: under 4 u of either product.
      const double error = 0x1p-50 * (std::fabs(positive) + std::fabs(negative)) + 0x1p-900;
      left = left && positive - negative > error;
      right = right && negative - positive > error;
      if (!left && !right) return out;
    }
  out.alone = true;
  return out;
}

/// The sign of a crossing where boundary k enters the other triangle. cross(a', b') > 0: the second
/// triangle's side passes from right to left of the first's, into the first; and the first's goes
/// from left to right, out of the second.
int entering(int k) {
  return k == 0 ? -1 : 1;
}

/// The side of triangle k on which a contact was found.
int side_of(const BoundaryJoint& contact, std::size_t k) {
  const int edge = contact.place[k].edge;
  return contact.seen[k] == 2 ? (edge + 2) % 3 : edge;
}

Box2 part_box(const CurveCache& side, double s0, double s1) {
  PointBuffer<max_curve_points> points;
  const int d = static_cast<int>(side.control.size()) - 1;
  restrict_curve(d, side.control.data(), s0, s1, points.data());
  return control_box(d, points.data());
}

}  // namespace

void TriangleSides::assign(int g, std::span<const Vec2> control, bool with_distance) {
  const auto n = at(g + 1);
  points_.resize(3 * n);
  box_ = Box2();
  for (int side = 0; side < 3; ++side) {
    const std::size_t first = at(side) * n;
    for (int m = 0; m <= g; ++m)
      points_[first + at(m)] = control[at(bernstein::triangle_side_index(g, side, m))];
    const auto points = std::span<const Vec2>(points_).subspan(first, n);
    cache_[at(side)] = with_distance ? cache_curve(points) : box_cache(points);
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
  contacts_.clear();
  same_joint_.clear();
  overlaps_.clear();
  parts_[0].clear();
  parts_[1].clear();
  corner_inside_ = {};
  reason_.clear();
  for (int i = 0; i < 3; ++i) {
    const Box2 box = grown(a.cache(i).box, coincidence_distance);
    if (!box.overlaps(b.box())) continue;
    for (int j = 0; j < 3; ++j)
      if (box.overlaps(b.cache(j).box) && !meet(i, j, coincidence_distance)) return false;
  }
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
  separate_contacts();
  settle_corners();
  return sort_joints() && classify(0) && classify(1);
}

bool Arrangement::meet(int i, int j, double coincidence_distance) {
  const CurveCache &a = sides(0).cache(i), &b = sides(1).cache(j);
  const int same = same_curve(a.control, b.control);
  const CommonEnd end =
      same == 0 && coincidence_distance == 0.0 ? common_end(a.control, b.control) : CommonEnd();
  if (end.alone) {
    BoundaryJoint joint{};
    set_place(joint, 0, i, {end.s, end.s, end.s, 0.0, true});
    set_place(joint, 1, j, {end.t, end.t, end.t, 0.0, true});
    return add_contact(joint);
  }
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
  // A polygon is no better than its joints: both sides must agree there to rounding.
  const double apart = 2.0 * coincidence_distance + 0x1p-40 * std::max(a.magnitude, b.magnitude);
  for (const Crossing& c : found_.crossings) {
    const Vec2 gap = c.point_a - c.point_b;
    if (!(std::max(std::fabs(gap.x()), std::fabs(gap.y())) <= apart)) {
      Box2 where;
      where.include(c.point_a);
      where.include(c.point_b);
      return fail("a common point of two sides is not known well enough", where);
    }
    // Where a corner lies on a side only that side's speed counts, else the angle as well.
    const bool corner = is_end(c.s) || is_end(c.t);
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
    joint.seen_sign = c.certified ? c.sign : 0;
    joint.sign = s.end || t.end ? 0 : joint.seen_sign;
    // The same bits when the triangles change places.
    joint.point = 0.5 * (c.point_a + c.point_b);
    if (!add_contact(joint)) return false;
  }
  const auto add_place = [&](double s, double t, double slack) {
    BoundaryJoint joint{};
    const auto parameter = [&](double x) {
      if (is_end(x)) return Parameter{x, x, x, slack, true};
      return Parameter{x, std::max(0.0, x - slack), std::min(1.0, x + slack), slack, false};
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
  const auto name = static_cast<std::int32_t>(contacts_.size());
  contacts_.push_back(contact);
  same_joint_.push_back(-1);
  const auto last_contact = [&](const BoundaryJoint& joint) {
    std::int32_t i = joint.first_contact;
    while (same_joint_[at(i)] >= 0) i = same_joint_[at(i)];
    return i;
  };
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
      same_joint_[at(last_contact(joint))] = name;
      if (!join(joint, contact)) return false;
    } else {  // two joints seen apart so far turn out to be one
      same_joint_[at(last_contact(joints_[first]))] = joint.first_contact;
      if (!join(joints_[first], joint)) return false;
      joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(i--));
    }
  }
  if (first == joints_.size()) {
    joints_.push_back(contact);
    BoundaryJoint& joint = joints_.back();
    joint.first_contact = name;
    for (int k = 1; k >= 0; --k)
      if (is_corner(joint.place[at(k)])) joint.point = sides(k).corner(joint.place[at(k)].edge);
  }
  return true;
}

bool Arrangement::join(BoundaryJoint& joint, const BoundaryJoint& contact) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (joint.place[k] == contact.place[k]) {
      joint.seen[k] |= contact.seen[k];
      continue;
    }
    const bool old_corner = is_corner(joint.place[k]), new_corner = is_corner(contact.place[k]);
    if (old_corner && !new_corner) continue;
    if (!old_corner && new_corner) {
      joint.place[k] = contact.place[k];
      joint.lo[k] = contact.lo[k];
      joint.hi[k] = contact.hi[k];
      joint.seen[k] = contact.seen[k];
      joint.error[k] = contact.error[k];
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

/// Crossings so near to a corner that they are rounded to it are joints of their own: a corner on
/// the other boundary is met by both its sides, on one side of the other triangle. (As one joint,
/// the boundaries would cross an odd number of times, which closed curves cannot.)
void Arrangement::separate_contacts() {
  const std::size_t count = joints_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const BoundaryJoint joint = joints_[i];
    if (joint.sign != 0 || same_joint_[at(joint.first_contact)] < 0) continue;
    if (joint.seen[0] == 3 && joint.seen[1] == 3) continue;
    bool crossings = true;
    std::array<std::array<std::uint8_t, 3>, 2>
        met{};  // of a corner, per side of the other triangle
    for (std::int32_t c = joint.first_contact; c >= 0; c = same_joint_[at(c)]) {
      const BoundaryJoint& contact = contacts_[at(c)];
      crossings = crossings && contact.seen_sign != 0;
      for (const std::size_t k : {0U, 1U}) met[k][at(side_of(contact, 1 - k))] |= contact.seen[k];
    }
    if (!crossings) continue;
    std::size_t corner = 2;  // the triangle whose corner is on the other's side `on`
    int on = 0;
    for (const std::size_t k : {0U, 1U})
      for (int side = 0; side < 3 && corner == 2; ++side)
        if (met[k][at(side)] == 3) {
          corner = k;
          on = side;
        }
    bool first = true, first_kept = true;
    for (std::int32_t c = joint.first_contact, next; c >= 0; c = next) {
      next = same_joint_[at(c)];
      const BoundaryJoint& contact = contacts_[at(c)];
      const bool keep = corner < 2 && side_of(contact, 1 - corner) == on;
      if (keep && first_kept) {
        joints_[i] = contact;
        joints_[i].seen[corner] = 3;
        joints_[i].point = sides(static_cast<int>(corner)).corner(contact.place[corner].edge);
        first_kept = false;
      } else if (!keep && corner == 2 && first) {
        joints_[i] = contact;
      } else if (!keep) {
        joints_.push_back(contact);
      }
      first = false;
    }
  }
}

/// A corner on the other boundary is met by both sides that end there. What only one of them meets
/// is a common point inside that side, so near to its end that its parameter is rounded to it.
void Arrangement::settle_corners() {
  for (BoundaryJoint& joint : joints_) {
    bool moved = false;
    for (std::size_t k = 0; k < 2; ++k) {
      if (joint.seen[k] != 1 && joint.seen[k] != 2) continue;
      moved = true;
      const bool start = joint.seen[k] == 1;
      BoundaryPlace& place = joint.place[k];
      place = start ? BoundaryPlace{place.edge, 0x1p-1022}
                    : BoundaryPlace{(place.edge + 2) % 3, 1.0 - u};
      joint.seen[k] = 0;
      joint.lo[k] = start ? 0.0 : std::min(place.s, 1.0 - joint.error[k]);
      joint.hi[k] = start ? std::max(place.s, std::min(1.0, joint.error[k])) : 1.0;
    }
    if (moved && !is_corner(joint.place[0]) && !is_corner(joint.place[1]))
      joint.sign = joint.seen_sign;
  }
}

/// Narrows the interval of each parameter to where that side meets the box of what the interval of
/// the other leaves of the other side.
void Arrangement::tighten(std::int32_t i) {
  BoundaryJoint& joint = joints_[static_cast<std::size_t>(i)];
  for (const int k : {0, 1}) {
    if (is_corner(joint.place[at(k)])) continue;
    const BoundaryPlace& other = joint.place[at(1 - k)];
    Box2 box;
    if (is_corner(other))
      box.include(sides(1 - k).corner(other.edge));
    else
      box = part_box(sides(1 - k).cache(other.edge), joint.lo[at(1 - k)], joint.hi[at(1 - k)]);
    const CurveCache& side = sides(k).cache(joint.place[at(k)].edge);
    const double magnitude = std::max(side.magnitude, sides(1 - k).cache(other.edge).magnitude);
    // de Casteljau's algorithm, twice for either, and some more.
    const double slack = 16.0 * 41.0 * u * magnitude;
    box = grown(box, slack);
    double lo = joint.lo[at(k)], hi = joint.hi[at(k)];
    // The largest dyadic steps from either end that certainly miss the box.
    for (double step = 0.5 * (hi - lo); step > 0x1p-40; step *= 0.5) {
      if (lo + step < joint.place[at(k)].s && !part_box(side, lo, lo + step).overlaps(box))
        lo += step;
      if (hi - step > joint.place[at(k)].s && !part_box(side, hi - step, hi).overlaps(box))
        hi -= step;
    }
    joint.lo[at(k)] = lo;
    joint.hi[at(k)] = hi;
  }
}

bool Arrangement::sort_joints() {
  for (int k = 0; k < 2; ++k) {
    std::vector<std::int32_t>& order = order_[at(k)];
    order.clear();
    for (std::size_t i = 0; i < joints_.size(); ++i) {  // few: insertion is quickest
      const auto name = static_cast<std::int32_t>(i);
      order.push_back(name);
      for (std::size_t j = i; j > 0; --j) {
        if (!before(joint(name).place[at(k)], joint(order[j - 1]).place[at(k)])) break;
        std::swap(order[j], order[j - 1]);
      }
    }
    for (std::size_t i = 1; i < order.size(); ++i)
      if (!apart(k, order[i - 1], order[i])) {
        tighten(order[i - 1]);
        tighten(order[i]);
        if (!apart(k, order[i - 1], order[i]) && !order_pair(k, i - 1)) return false;
      }
  }
  return true;
}

/// Whether joint i comes before joint j on the same side for certain, or they are on two sides.
bool Arrangement::apart(int k, std::int32_t i, std::int32_t j) const {
  const BoundaryJoint &p = joint(i), &q = joint(j);
  return p.place[at(k)].edge != q.place[at(k)].edge || is_corner(p.place[at(k)]) ||
         p.hi[at(k)] < q.lo[at(k)];
}

/// Joints i and i + 1 along boundary k are too near to each other: two crossings, into the other
/// triangle and out of it, have the order that fits what comes before them.
bool Arrangement::order_pair(int k, std::size_t i) {
  std::vector<std::int32_t>& order = order_[at(k)];
  const std::size_t n = order.size();
  BoundaryJoint &p = joints_[static_cast<std::size_t>(order[i])],
                &q = joints_[static_cast<std::size_t>(order[i + 1])];
  const std::int32_t last = order[(i + n - 1) % n];
  const bool alone =
      (i == 0 || apart(k, last, order[i])) && (i == 0 || apart(k, last, order[i + 1])) &&
      (i + 2 == n || (apart(k, order[i], order[i + 2]) && apart(k, order[i + 1], order[i + 2])));
  if (p.sign * q.sign < 0 && alone) {
    const double lo = std::min(p.lo[at(k)], q.lo[at(k)]), hi = std::max(p.hi[at(k)], q.hi[at(k)]);
    // The order of what comes before in the list is settled, so its sign counts; round the start of
    // the list it need not be.
    int place = i > 0 ? joint(last).sign * entering(k) : 0;
    if (place == 0) {
      const bool around = n == 2;
      double after = around ? hi : joint(last).hi[at(k)];
      if (i == 0 && n > 3 && !apart(k, order[n - 2], last))
        after = std::max(after, joint(order[n - 2]).hi[at(k)]);
      place = class_between(k, around ? p.place[at(k)] : joint(last).place[at(k)], after,
                            p.place[at(k)], lo);
    }
    // Inside: the first one leads out.
    if (p.sign * entering(k) * place > 0) std::swap(order[i], order[i + 1]);
    BoundaryJoint &first = joints_[static_cast<std::size_t>(order[i])],
                  &second = joints_[static_cast<std::size_t>(order[i + 1])];
    double &s = first.place[at(k)].s, &t = second.place[at(k)].s;
    if (place != 0 && s < t + 0x1p-40) {
      if (s >= t) {  // by rounding: the parameter that is known better stays
        const bool keep = first.hi[at(k)] - first.lo[at(k)] < second.hi[at(k)] - second.lo[at(k)];
        s = std::min(keep ? s : t, 1.0 - 4.0 * u);
        t = std::nextafter(s, 1.0);
      }
      return true;
    }
  }
  Box2 where;
  where.include(p.point);
  where.include(q.point);
  return fail("the order of common points along a side is lost in rounding", where);
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
  const BoundaryJoint &p = joint(part.from), &q = joint(part.to);
  const int at_start = p.sign * entering(k), at_end = -q.sign * entering(k);
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
  const BoundaryJoint &p = joint(part.from), &q = joint(part.to);
  const int place = class_between(k, p.place[at(k)], p.hi[at(k)], q.place[at(k)], q.lo[at(k)]);
  part.place = place > 0 ? PartClass::inside : PartClass::outside;
  if (place != 0) return true;
  Box2 where;
  where.include(p.point);
  where.include(q.point);
  return fail("what is between two common points could not be told", where);
}

int Arrangement::class_between(int k, const BoundaryPlace& start, double after,
                               const BoundaryPlace& end, double before_end) const {
  Place place = Place::unknown;
  const auto decided = [&](int side, double s) {
    place = place_of(k, side, s);
    return place != Place::unknown;
  };
  const auto result = [&] { return place == Place::inside ? 1 : -1; };
  int side = start.edge;
  double lo = after;
  for (bool first = true;; first = false) {
    // The joint's own side comes round again when the part goes once around.
    const bool last = side == end.edge && (!first || start.s < end.s);
    const double hi = last ? before_end : 1.0;
    for (const double f : {0.5, 0.3125, 0.6875}) {
      const double s = lo + f * (hi - lo);
      if (lo < s && s < hi && decided(side, s)) return result();
    }
    if (last) return 0;
    side = (side + 1) % 3;
    lo = 0.0;
    if (side == end.edge && end.s == 0.0) return 0;
    if (decided(side, 0.0)) return result();
  }
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
