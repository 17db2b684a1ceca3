#include "bezel/geometry/triangle_intersection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_arrangement.hpp"
#include "bezel/geometry/triangle_assembly.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/numeric/box.hpp"

namespace bezel {

using geometry_kernel::Arrangement;
using geometry_kernel::Assembly;
using geometry_kernel::Operation;
using geometry_kernel::PartClass;
using geometry_kernel::TriangleSides;

namespace {

/// All products that make up the determinant's coefficients are positive beyond rounding; says
/// nothing otherwise.
bool plainly_valid(int g, std::span<const Vec2> control) {
  if (g > 3) return false;
  using bernstein::triangle_index;
  std::array<Vec2, static_cast<std::size_t>(bernstein::triangle_size(2))> du, dv;
  std::size_t n = 0;
  for (int k = 0; k < g; ++k)
    for (int j = 0; j + k < g; ++j, ++n) {
      const Vec2& base = control[static_cast<std::size_t>(triangle_index(g, j, k))];
      du[n] = control[static_cast<std::size_t>(triangle_index(g, j + 1, k))] - base;
      dv[n] = control[static_cast<std::size_t>(triangle_index(g, j, k + 1))] - base;
    }
  bool positive = true;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double left = du[i].x() * dv[j].y(), right = du[i].y() * dv[j].x();
      // Differences, products and their difference: under 4 u of either product.
      positive &= left - right > 0x1p-50 * (std::fabs(left) + std::fabs(right)) + 0x1p-900;
    }
  return positive;
}

/// False: undecided.
bool check(const char* which, int g, std::span<const Vec2> control) {
  geometry_kernel::check_triangle(g, control, bernstein::max_triangle_degree);
  if (plainly_valid(g, control)) return true;
  const Validity status = check_validity(g, control).status;
  if (status == Validity::inverted)
    throw InputError(std::string("the ") + which +
                     " triangle's Jacobian determinant is not positive everywhere, expected a "
                     "counter-clockwise triangle without folds");
  return status == Validity::valid;
}

Box2 box_of(std::span<const Vec2> control) {
  Box2 box;
  for (const Vec2& p : control) box.include(p);
  return box;
}

/// What both operations share.
struct Both {
  TriangleSides a, b;
  Arrangement arrangement;
  Assembly assembly;
  std::vector<CurvedPolygon> spare;

  TriangleRelation relate(int g, std::span<const Vec2> pa, int h, std::span<const Vec2> pb,
                          const TriangleIntersectOptions& options, std::string& reason, Box2& box) {
    const double distance = options.coincidence_distance;
    if (!(distance >= 0.0) || !std::isfinite(distance))
      throw InputError("the coincidence distance must be finite and not negative");
    const bool valid_a = check("first", g, pa), valid_b = check("second", h, pb);
    if (!grown(box_of(pa), distance).overlaps(box_of(pb))) return TriangleRelation::disjoint;
    if (!valid_a || !valid_b) {
      reason = std::string("it is undecided whether the ") + (valid_a ? "second" : "first") +
               " triangle is valid";
      box = box_of(valid_a ? pb : pa);
      return TriangleRelation::unresolved;
    }
    a.assign(g, pa, distance > 0.0);
    b.assign(h, pb, distance > 0.0);
    if (!arrangement.build(a, b, distance)) {
      reason = arrangement.reason();
      box = arrangement.where();
      return TriangleRelation::unresolved;
    }
    return relation_of();
  }

  /// Joins the parts to loops; `found` is unresolved when they do not close.
  template <class Found>
  void join(Operation operation, bool cut_where_touching, std::span<const Vec2> first,
            std::vector<CurvedPolygon>& loops, Found& found) {
    if (assembly.run(arrangement, operation, cut_where_touching, spare, loops)) return;
    loops.clear();
    found.relation = TriangleRelation::unresolved;
    found.reason =
        "the parts of the boundaries do not close: the curves' common points contradict each other";
    found.box = box_of(first);
  }

  TriangleRelation relation_of() const {
    if (arrangement.joints().empty())
      return arrangement.corner_inside(0)   ? TriangleRelation::first_in_second
             : arrangement.corner_inside(1) ? TriangleRelation::second_in_first
                                            : TriangleRelation::disjoint;
    // A boundary that is never outside a triangle bounds a part of it.
    std::array<bool, 2> within = {true, true}, along = {true, true};
    bool none = true;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
      for (const auto& part : arrangement.parts(static_cast<int>(k))) {
        const bool is_along = part.place == PartClass::along;
        within[k] = within[k] && (is_along || part.place == PartClass::inside);
        along[k] = along[k] && is_along;
        none = none && !is_along && part.place != PartClass::inside;
      }
    if (along[0] && along[1]) return TriangleRelation::same;
    if (within[0]) return TriangleRelation::first_in_second;
    if (within[1]) return TriangleRelation::second_in_first;
    return none ? TriangleRelation::touching : TriangleRelation::overlapping;
  }
};

}  // namespace

struct TriangleIntersector::Work : Both {};

TriangleIntersector::TriangleIntersector(const TriangleIntersectOptions& options)
    : options_(options), work_(std::make_unique<Work>()) {}
TriangleIntersector::~TriangleIntersector() = default;
TriangleIntersector::TriangleIntersector(TriangleIntersector&&) noexcept = default;
TriangleIntersector& TriangleIntersector::operator=(TriangleIntersector&&) noexcept = default;

void TriangleIntersector::intersect(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                                    TriangleIntersections& out) {
  Work& work = *work_;
  for (CurvedPolygon& polygon : out.polygons) work.spare.push_back(std::move(polygon));
  out.polygons.clear();
  out.reason.clear();
  out.box = Box2();
  out.relation = work.relate(g, a, h, b, options_, out.reason, out.box);
  switch (out.relation) {
    case TriangleRelation::overlapping:
      work.join(Operation::intersection, options_.cut_where_touching, a, out.polygons, out);
      return;
    case TriangleRelation::first_in_second:
    case TriangleRelation::same:
      work.assembly.whole(work.a, 0, false, work.spare, out.polygons);
      return;
    case TriangleRelation::second_in_first:
      work.assembly.whole(work.b, 1, false, work.spare, out.polygons);
      return;
    case TriangleRelation::disjoint:
    case TriangleRelation::touching:
    case TriangleRelation::unresolved:
      return;
  }
}

TriangleIntersections intersect(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                                const TriangleIntersectOptions& options) {
  TriangleIntersections out;
  TriangleIntersector(options).intersect(g, a, h, b, out);
  return out;
}

TriangleDifference difference(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                              const TriangleIntersectOptions& options) {
  TriangleDifference out;
  Both work;
  out.relation = work.relate(g, a, h, b, options, out.reason, out.box);
  const bool joined = !work.arrangement.joints().empty();
  switch (out.relation) {
    case TriangleRelation::disjoint:
    case TriangleRelation::touching:
      work.a.assign(g, a);
      work.b.assign(h, b);
      work.assembly.whole(work.a, 0, false, work.spare, out.loops);
      break;
    case TriangleRelation::second_in_first:
    case TriangleRelation::overlapping:
      if (!joined) {
        work.assembly.whole(work.a, 0, false, work.spare, out.loops);
        work.assembly.whole(work.b, 1, true, work.spare, out.loops);
      } else {
        work.join(Operation::difference, false, a, out.loops, out);
      }
      break;
    case TriangleRelation::first_in_second:
    case TriangleRelation::same:
    case TriangleRelation::unresolved:
      break;
  }
  return out;
}

}  // namespace bezel
