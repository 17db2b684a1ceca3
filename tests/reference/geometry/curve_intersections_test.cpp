// The curve pairs of dhermes/bezier (tests/reference/data/bezier/SOURCE.md) against their exact
// answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "support/reference_data.hpp"

namespace {

using bezel::Vec2;
using nlohmann::json;
using support::load_reference;
using support::reference_control;
using support::reference_number;

struct Pair {
  double s, t;
};

/// Every point reported, as (s, t): crossings and tangencies.
std::vector<Pair> points_of(const bezel::CurveIntersections& found) {
  std::vector<Pair> points;
  for (const auto& c : found.crossings) points.push_back({c.s, c.t});
  for (const auto& c : found.tangencies) points.push_back({c.s, c.t});
  std::sort(points.begin(), points.end(), [](const Pair& p, const Pair& q) { return p.s < q.s; });
  // Case 46 is tangent "only up to machine precision": as given, the curves cross twice, 1.4e-9
  // apart.
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].s - points[i - 1].s < 1e-8 && std::fabs(points[i].t - points[i - 1].t) < 1e-8)
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(i--));
  return points;
}

std::string show(const bezel::CurveIntersections& found) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& c : found.crossings)
    text << "\n  crossing " << c.s << " " << c.t << " sign " << c.sign << " cond " << c.condition;
  for (const auto& c : found.tangencies) text << "\n  tangency " << c.s << " " << c.t;
  for (const auto& c : found.overlaps)
    text << "\n  overlap " << c.s0 << " " << c.s1 << " | " << c.t0 << " " << c.t1 << " gap "
         << c.gap;
  for (const auto& c : found.unresolved)
    text << "\n  unresolved " << c.s_lo << " " << c.s_hi << " | " << c.t_lo << " " << c.t_hi << " "
         << c.reason;
  return text.str();
}

void check(const json& c, const bezel::CurveIntersections& found, const json& expected_s,
           const json& expected_t, double tolerance, double coincidence_distance) {
  const std::string type = c.at("type");
  EXPECT_TRUE(found.unresolved.empty()) << show(found);
  std::vector<Pair> expected;
  for (std::size_t i = 0; i < expected_s.size(); ++i)
    expected.push_back({reference_number(expected_s.at(i)), reference_number(expected_t.at(i))});
  std::sort(expected.begin(), expected.end(),
            [](const Pair& p, const Pair& q) { return p.s < q.s; });
  // Case 33 is named coincident because both curves belong to one algebraic curve; on [0, 1] they
  // meet in two points, its double point and a common end.
  if (type == "coincident" && expected.size() == 2 && c.at("id") != 33) {
    ASSERT_EQ(found.overlaps.size(), 1u) << show(found);
    EXPECT_TRUE(found.crossings.empty() && found.tangencies.empty()) << show(found);
    EXPECT_NEAR(found.overlaps[0].s0, expected[0].s, 1e-14);
    EXPECT_NEAR(found.overlaps[0].s1, expected[1].s, 1e-14);
    EXPECT_NEAR(found.overlaps[0].t0, expected[0].t, 1e-14);
    EXPECT_NEAR(found.overlaps[0].t1, expected[1].t, 1e-14);
    return;
  }
  // Contact of order 3 keeps the curves within the coincidence distance over a length of its cube
  // root: then the answer is an overlap of that length about the place.
  if (coincidence_distance > 0 && type == "tangent" && found.overlaps.size() == 1) {
    const auto& o = found.overlaps[0];
    EXPECT_TRUE(expected.size() == 1 && found.crossings.empty() && found.tangencies.empty())
        << show(found);
    EXPECT_LT(o.s1 - o.s0, 8 * std::cbrt(coincidence_distance)) << show(found);
    EXPECT_TRUE(o.s0 < expected[0].s && expected[0].s < o.s1) << show(found);
    EXPECT_TRUE(o.t0 < expected[0].t && expected[0].t < o.t1) << show(found);
    return;
  }
  EXPECT_TRUE(found.overlaps.empty()) << show(found);
  const std::vector<Pair> points = points_of(found);
  ASSERT_EQ(points.size(), expected.size()) << show(found);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].s, expected[i].s, tolerance) << show(found);
    EXPECT_NEAR(points[i].t, expected[i].t, tolerance) << show(found);
  }
  if (type == "standard") {
    EXPECT_TRUE(found.tangencies.empty()) << show(found);
  } else if (type == "tangent") {
    // At least one of the points is tangential: said so, or a crossing known to be ill-conditioned.
    const bool tangential =
        !found.tangencies.empty() ||
        std::any_of(found.crossings.begin(), found.crossings.end(),
                    [](const bezel::Crossing& x) { return x.sign == 0 || x.condition > 1e6; });
    EXPECT_TRUE(tangential) << show(found);
  }
}

class CurvePairs : public testing::TestWithParam<double> {};

TEST_P(CurvePairs, AgreeWithTheReference) {
  const json curves = load_reference("curves.json"),
             cases = load_reference("curve_intersections.json");
  ASSERT_EQ(cases.size(), 53u);
  for (const json& c : cases) {
    SCOPED_TRACE("case " + std::to_string(c.at("id").get<int>()));
    const auto a = reference_control(curves, c.at("curve1")),
               b = reference_control(curves, c.at("curve2"));
    const double tolerance = c.at("type") == "tangent" ? 1e-7 : 1e-12;
    bezel::IntersectOptions options;
    options.coincidence_distance = GetParam();
    check(c, bezel::intersect(a, b, options), c.at("curve1_params"), c.at("curve2_params"),
          tolerance, GetParam());
    if (c.at("curve1_params").size() <= 1 || c.at("type") != "coincident")
      check(c, bezel::intersect(b, a, options), c.at("curve2_params"), c.at("curve1_params"),
            tolerance, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(CoincidenceDistance, CurvePairs, testing::Values(0.0, 1e-14));

}  // namespace
