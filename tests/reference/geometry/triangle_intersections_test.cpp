// The triangle pairs of dhermes/bezier (tests/reference/data/bezier/SOURCE.md) against their
// answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "support/reference_data.hpp"

namespace {

using bezel::CurvedPolygon;
using bezel::TriangleRelation;
using bezel::Vec2;
using nlohmann::json;
using support::load_reference;
using support::reference_control;
using support::reference_number;

struct Triangle {
  int degree = 1;
  std::vector<Vec2> control;
};

Triangle triangle(const json& triangles, const std::string& id) {
  Triangle out;
  out.control = reference_control(triangles, id);
  while (bezel::bernstein::triangle_size(out.degree) < static_cast<int>(out.control.size()))
    ++out.degree;
  return out;
}

std::string show(const bezel::TriangleIntersections& found) {
  std::ostringstream text;
  text.precision(17);
  text << "relation " << static_cast<int>(found.relation) << " " << found.reason;
  for (const CurvedPolygon& p : found.polygons) {
    text << "\n  polygon";
    for (const auto& e : p.edges()) {
      const Vec2 v = p.vertices()[static_cast<std::size_t>(e.vertex)].point;
      text << "\n    " << e.triangle * 3 + e.edge << " " << e.s0 << " " << e.s1 << " from ("
           << v.x() << ", " << v.y() << ")";
    }
  }
  return text.str();
}

/// Sides 0 to 2 are the first triangle's, 3 to 5 the second's; the other way round when exchanged.
/// Whether polygon p, from its edge `shift` on, is the expected one.
bool agrees(const CurvedPolygon& p, std::size_t shift, const json& expected, bool exchanged) {
  const json &edges = expected.at("edge_list"), &starts = expected.at("start_params"),
             &ends = expected.at("end_params"), &nodes = expected.at("nodes");
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& e = p.edges()[(i + shift) % n];
    const Vec2 v = p.vertices()[static_cast<std::size_t>(e.vertex)].point;
    if ((exchanged ? 1 - e.triangle : e.triangle) * 3 + e.edge != edges.at(i).get<int>() ||
        !(std::fabs(e.s0 - reference_number(starts.at(i))) <= 1e-12) ||
        !(std::fabs(e.s1 - reference_number(ends.at(i))) <= 1e-12) ||
        !(std::fabs(v.x() - reference_number(nodes.at(i).at(0))) <= 1e-14) ||
        !(std::fabs(v.y() - reference_number(nodes.at(i).at(1))) <= 1e-14))
      return false;
  }
  return true;
}

bool agrees(const CurvedPolygon& p, const json& expected, bool exchanged) {
  if (p.size() != expected.at("edge_list").size() || p.vertices().size() != p.size()) return false;
  for (std::size_t shift = 0; shift < p.size(); ++shift)
    if (agrees(p, shift, expected, exchanged)) return true;
  return false;
}

void check(const bezel::TriangleIntersections& found, const json& expected, bool exchanged) {
  if (expected.size() == 1 && expected.at(0).is_boolean()) {
    const TriangleRelation inside = expected.at(0).get<bool>() != exchanged
                                        ? TriangleRelation::first_in_second
                                        : TriangleRelation::second_in_first;
    EXPECT_TRUE(found.relation == inside || found.relation == TriangleRelation::same)
        << show(found);
    return;
  }
  if (expected.empty()) {
    EXPECT_TRUE(found.relation == TriangleRelation::disjoint ||
                found.relation == TriangleRelation::touching)
        << show(found);
    return;
  }
  EXPECT_EQ(found.relation, TriangleRelation::overlapping) << show(found);
  EXPECT_EQ(found.polygons.size(), expected.size()) << show(found);
  for (const json& polygon : expected)
    EXPECT_EQ(std::count_if(found.polygons.begin(), found.polygons.end(),
                            [&](const CurvedPolygon& p) { return agrees(p, polygon, exchanged); }),
              1)
        << polygon.dump() << "\n"
        << show(found);
}

TEST(TrianglePairs, AgreeWithTheReference) {
  const json triangles = load_reference("triangles.json"),
             cases = load_reference("triangle_intersections.json");
  ASSERT_EQ(cases.size(), 36u);
  for (const json& c : cases) {
    SCOPED_TRACE("case " + std::to_string(c.at("id").get<int>()));
    const Triangle a = triangle(triangles, c.at("triangle1")),
                   b = triangle(triangles, c.at("triangle2"));
    // Case 47 is a triangle and its elevation, with thirds as control points: rounded to doubles
    // the two agree to the last bit only.
    bezel::TriangleIntersectOptions options;
    if (c.at("id") == 47) options.coincidence_distance = 0x1p-50;
    const json& expected = c.at("intersections");
    check(bezel::intersect(a.degree, a.control, b.degree, b.control, options), expected, false);
    check(bezel::intersect(b.degree, b.control, a.degree, a.control, options), expected, true);
  }
}

}  // namespace
