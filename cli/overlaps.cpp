#include "cli/overlaps.hpp"

#include <algorithm>
#include <optional>

#include "bezel/geometry/triangle_intersection.hpp"
#include "bezel/mesh/bvh.hpp"
#include "cli/for_all.hpp"

namespace bezel::cli {
namespace {

constexpr double smallest_part = 1e-10;      // of the smaller element's area
constexpr double second_distance = 0x1p-40;  // of the smaller element, when exact is undecided
constexpr std::size_t most_of_an_element = 10;

struct Element {
  std::vector<Vec2> control;
  Box2 box;
  double area = 0.0;
};

std::optional<ElementOverlap> overlap(int degree, const std::vector<Element>& elements,
                                      std::size_t e, std::size_t f) {
  const Element &a = elements[e], &b = elements[f];
  TriangleIntersections common = intersect(degree, a.control, degree, b.control);
  if (common.relation == TriangleRelation::unresolved) {
    TriangleIntersectOptions options;
    options.coincidence_distance = second_distance * std::min(a.box.diameter(), b.box.diameter());
    common = intersect(degree, a.control, degree, b.control, options);
  }
  if (common.relation == TriangleRelation::unresolved)
    return ElementOverlap{e, f, false, 0.0, common.box.centre(), common.reason};
  double sum = 0.0;
  for (const CurvedPolygon& polygon : common.polygons) sum += area(polygon);
  if (!(sum > smallest_part * std::min(a.area, b.area))) return {};
  return ElementOverlap{e, f, true, sum, common.polygons[0].vertices()[0].point, {}};
}

}  // namespace

std::vector<ElementOverlap> find_overlaps(const TriangleMesh& mesh, const MeshValidity& validity,
                                          int threads, const Progress& progress) {
  const std::size_t n = mesh.element_count();
  std::vector<Element> elements(n);
  std::vector<Box2> boxes(n);  // empty for elements that are not valid: never found
  for (std::size_t e = 0; e < n; ++e) {
    if (validity.elements[e].status != Validity::valid) continue;
    Element& element = elements[e];
    element.control.resize(static_cast<std::size_t>(mesh.nodes_per_element()));
    mesh.gather(ElementId(e), element.control);
    for (const Vec2& p : element.control) element.box.include(p);
    element.area = area(mesh.degree(), element.control);
    boxes[e] = element.box;
  }
  const Bvh tree(boxes);
  std::vector<std::vector<ElementOverlap>> found(n);
  for_all(n, 64, threads, progress, [&](std::size_t e) {
    std::vector<std::int32_t> near;
    tree.query(boxes[e], near);
    std::sort(near.begin(), near.end());
    for (const std::int32_t i : near) {
      const auto f = static_cast<std::size_t>(i);
      if (f <= e) continue;
      if (found[e].size() == most_of_an_element) break;
      if (const auto o = overlap(mesh.degree(), elements, e, f)) found[e].push_back(*o);
    }
  });
  std::vector<ElementOverlap> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace bezel::cli
