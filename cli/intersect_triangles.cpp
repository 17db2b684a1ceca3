// What `intersect` says about curved triangles.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <type_traits>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "cli/intersect_report.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

const std::vector<std::string> polygon_columns = {"polygon", "vertex",   "x",    "y",
                                                  "of",      "triangle", "side", "s"};
constexpr const char* polygon_units =
    "s: parameters of the sides, 0 to 1; x, y: in the units of the input; areas: in their "
    "squares\n\n";

const char* word(TriangleRelation relation) {
  switch (relation) {
    case TriangleRelation::disjoint:
      return "disjoint";
    case TriangleRelation::touching:
      return "touching";
    case TriangleRelation::overlapping:
      return "polygons";
    case TriangleRelation::first_in_second:
      return "a_inside_b";
    case TriangleRelation::second_in_first:
      return "b_inside_a";
    case TriangleRelation::same:
      return "equal";
    case TriangleRelation::unresolved:
      return "unresolved";
  }
  return "";
}

const std::vector<CurvedPolygon>& regions(const TriangleIntersections& found) {
  return found.polygons;
}
const std::vector<CurvedPolygon>& regions(const TriangleDifference& found) {
  return found.loops;
}

template <class Found>
double total_area(const Found& found) {
  double sum = 0.0;
  for (const CurvedPolygon& polygon : regions(found)) sum += area(polygon);
  return sum;
}

Json place_json(const BoundaryPlace& place, bool hex) {
  if (place.edge < 0) return {};
  return {{"edge", place.edge}, {"s", number_json(place.s, hex)}};
}

Json polygon_json(const CurvedPolygon& polygon, bool hex) {
  Json edges = Json::array(), vertices = Json::array();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const CurvedEdge& edge = polygon.edges()[i];
    Json control = Json::array();
    for (const Vec2& p : polygon.control(i)) control.push_back(point_json(p, hex));
    edges.push_back({{"triangle", edge.triangle == 0 ? "a" : "b"},
                     {"edge", edge.edge},
                     {"start", number_json(edge.s0, hex)},
                     {"end", number_json(edge.s1, hex)},
                     {"vertex", edge.vertex},
                     {"control", control}});
  }
  for (const CurvedVertex& vertex : polygon.vertices())
    vertices.push_back({{"point", point_json(vertex.point, hex)},
                        {"a", place_json(vertex.place[0], hex)},
                        {"b", place_json(vertex.place[1], hex)}});
  return {{"area", number_json(area(polygon), hex)}, {"vertices", vertices}, {"edges", edges}};
}

template <class Found>
Json to_json(const Found& found, bool hex) {
  const char* list = std::is_same_v<Found, TriangleDifference> ? "loops" : "polygons";
  const bool unresolved = found.relation == TriangleRelation::unresolved;
  Json out{{"relation", word(found.relation)},
           {"area", unresolved ? Json() : number_json(total_area(found), hex)},
           {list, Json::array()},
           {"unresolved", Json::array()}};
  for (const CurvedPolygon& polygon : regions(found))
    out[list].push_back(polygon_json(polygon, hex));
  if (unresolved)
    out["unresolved"].push_back(
        {{"reason", found.reason},
         {"box",
          {{"min", point_json(found.box.lo, hex)}, {"max", point_json(found.box.hi, hex)}}}});
  return out;
}

template <class Found>
std::string unresolved_sentence(const Found& found) {
  return fmt::format("unresolved: {}, within [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]", found.reason,
                     found.box.lo.x(), found.box.hi.x(), found.box.lo.y(), found.box.hi.y());
}

std::string sentence(const TriangleDifference& found, const std::string&, const std::string&) {
  if (found.relation == TriangleRelation::unresolved) return unresolved_sentence(found);
  if (found.loops.empty()) return "nothing remains";
  return fmt::format("{}, area {:.10g}", summary({{found.loops.size(), "loop"}}, ""),
                     total_area(found));
}

std::string sentence(const TriangleIntersections& found, const std::string& a,
                     const std::string& b) {
  const auto with_area = [&](const std::string& text) {
    return fmt::format("{}, area {:.10g}", text, total_area(found));
  };
  switch (found.relation) {
    case TriangleRelation::disjoint:
      return "nothing in common";
    case TriangleRelation::touching:
      return "they touch, without a common area";
    case TriangleRelation::overlapping:
      return with_area(summary({{found.polygons.size(), "polygon"}}, "no polygon"));
    case TriangleRelation::first_in_second:
      return with_area(fmt::format("{} is part of {}", a, b));
    case TriangleRelation::second_in_first:
      return with_area(fmt::format("{} is part of {}", b, a));
    case TriangleRelation::same:
      return with_area("the same boundary");
    case TriangleRelation::unresolved:
      return unresolved_sentence(found);
  }
  return {};
}

/// One row for each edge, with the vertex where it begins; vertices have the picture's numbers.
std::string polygon_table(const std::vector<CurvedPolygon>& polygons, const std::string& a,
                          const std::string& b, bool hex, int next) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    const CurvedPolygon& polygon = polygons[k];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const CurvedEdge& edge = polygon.edges()[i];
      const Vec2 p = polygon.control(i)[0];
      rows.push_back({std::to_string(k), std::to_string(next++), exact_text(p.x(), hex),
                      exact_text(p.y(), hex), edge.triangle == 0 ? "a" : "b",
                      edge.triangle == 0 ? a : b, std::to_string(edge.edge),
                      fmt::format("{} to {}", exact_text(edge.s0, hex), exact_text(edge.s1, hex))});
    }
  }
  return rows.empty() ? std::string() : aligned(polygon_columns, rows);
}

void check_shapes(const Shapes& input, const std::string& file) {
  for (const Shape& shape : input.shapes) {
    const ValidityResult validity = check_validity(shape.degree, shape.control);
    if (validity.status != Validity::inverted) continue;
    throw InputError(
        InputPlace{file, shape.line, shape.place, -1},
        fmt::format("found a Jacobian determinant of {:.6g} at barycentric ({:.4g}, {:.4g}, "
                    "{:.4g}), expected a counter-clockwise triangle without folds",
                    validity.det, validity.where[0], validity.where[1], validity.where[2]));
  }
}

/// Names that were not given are long in pairs: there the letter will do.
std::string name_in_pair(const Shapes& input, std::size_t i, const char* letter) {
  const Shape& shape = input.shapes[i];
  return input.in_pairs && shape.name == shape.place ? letter : shape.name;
}

/// meet(triangle, triangle) of every pair.
template <class Found, class Meet>
IntersectReport report(const Shapes& input, const ReportOptions& options, const Meet& meet) {
  const auto found = meet_pairs<Found>(input, options, meet);
  constexpr bool remainder = std::is_same_v<Found, TriangleDifference>;
  IntersectReport out;
  for (const Shape& shape : input.shapes)
    out.picture.shapes.push_back(drawn_triangle(shape.name, shape.degree, shape.control));
  out.picture.region_name = remainder ? "what remains" : "common part";
  int next = 1;
  bool any = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto& [first, second] = input.pairs[i];
    const std::string a = name_in_pair(input, first, "a"), b = name_in_pair(input, second, "b");
    Json result;
    if (!input.in_pairs) result.update({{"a", first}, {"b", second}});
    result.update(to_json(found[i], options.hex));
    out.results.push_back(std::move(result));
    const std::vector<CurvedPolygon>& parts = regions(found[i]);
    const std::string rows = polygon_table(parts, a, b, options.hex, next);
    any = any || !parts.empty();
    out.text +=
        fmt::format("{}{}: {}\n{}", i > 0 ? "\n" : "",
                    remainder && !input.in_pairs ? a + " without " + b : pair_name(input, i),
                    sentence(found[i], a, b), rows);
    next = remainder ? add_loops(out.picture, parts, next) : add_polygons(out.picture, parts, next);
    if (found[i].relation == TriangleRelation::unresolved) {
      ++out.unresolved;
      out.picture.marks.push_back(
          {MarkKind::unresolved, found[i].box.centre(), std::to_string(next++)});
    }
  }
  if (any) out.text = polygon_units + out.text;
  return out;
}

}  // namespace

IntersectReport report_triangles(const Shapes& input, const ReportOptions& options) {
  check_shapes(input, options.file);
  const TriangleIntersectOptions how{options.coincidence_distance};
  if (options.difference)
    return report<TriangleDifference>(input, options, [&](const Shape& a, const Shape& b) {
      return difference(a.degree, a.control, b.degree, b.control, how);
    });
  return report<TriangleIntersections>(input, options, [&](const Shape& a, const Shape& b) {
    return intersect(a.degree, a.control, b.degree, b.control, how);
  });
}

}  // namespace bezel::cli
