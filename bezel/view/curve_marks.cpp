// What curves and triangles share, as marks and regions of a picture.

#include <utility>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/curve_shape.hpp"
#include "bezel/view/draw_curves.hpp"

namespace bezel {
namespace {

/// Bands and marks with numbers that go on.
class Marks {
 public:
  Marks(CurvePicture& picture, int first) : picture_(picture), next_(first) {}
  int next() const { return next_; }

  void mark(MarkKind kind, const Vec2& point) {
    picture_.marks.push_back({kind, point, std::to_string(next_++)});
  }
  void add(const std::vector<Vec2>& a, const CurveIntersections& found) {
    const Curve curve(a);
    for (const Crossing& c : found.crossings) mark(MarkKind::crossing, c.point_a);
    for (const Tangency& t : found.tangencies) mark(MarkKind::tangency, curve(t.s));
    for (const Overlap& o : found.overlaps)
      picture_.bands.push_back({specialize(a, o.s0, o.s1), std::to_string(next_++)});
    for (const UnresolvedBox& u : found.unresolved)
      mark(MarkKind::unresolved, curve(0.5 * (u.s_lo + u.s_hi)));
  }

 private:
  CurvePicture& picture_;
  int next_;
};

}  // namespace

int add_intersections(CurvePicture& picture, const std::vector<Vec2>& a,
                      const CurveIntersections& found, int first) {
  Marks marks(picture, first);
  marks.add(a, found);
  return marks.next();
}

int add_self_intersections(CurvePicture& picture, const std::vector<Vec2>& curve,
                           const SelfIntersections& found, int first) {
  Marks marks(picture, first);
  const Curve c(curve);
  for (const Cusp& cusp : found.cusps) marks.mark(MarkKind::cusp, c(cusp.s));
  marks.add(curve, found.pairs);
  return marks.next();
}

DrawnShape drawn_triangle(std::string name, int g, std::span<const Vec2> control) {
  DrawnShape shape{std::move(name), {}, true};
  for (int side = 0; side < 3; ++side) {
    shape.curves.emplace_back();
    for (int m = 0; m <= g; ++m)
      shape.curves.back().push_back(
          control[static_cast<std::size_t>(bernstein::triangle_side_index(g, side, m))]);
  }
  return shape;
}

int add_loops(CurvePicture& picture, std::span<const CurvedPolygon> loops, int first) {
  if (loops.empty()) return first;
  Marks marks(picture, first);
  DrawnRegion region;
  for (const CurvedPolygon& loop : loops) {
    if (!region.curves.empty()) region.further.push_back(region.curves.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::span<const Vec2> control = loop.control(i);
      marks.mark(MarkKind::vertex, control[0]);
      region.curves.emplace_back(control.begin(), control.end());
    }
  }
  picture.regions.push_back(std::move(region));
  return marks.next();
}

int add_polygons(CurvePicture& picture, std::span<const CurvedPolygon> polygons, int first) {
  for (const CurvedPolygon& polygon : polygons) first = add_loops(picture, {&polygon, 1}, first);
  return first;
}

}  // namespace bezel
