// The elimination that other tests trust, on pairs with known answers.

#include "support/curve_oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "support/curve_pairs.hpp"

namespace {

using nlohmann::json;
using support::common_parts;
using support::CommonParts;
using Points = std::vector<support::RationalPoint>;

mpq_class number(const json& j) {
  if (j.is_number_integer()) return mpq_class(j.get<long>());
  const std::string text = j.get<std::string>();
  if (text.find("0x") != std::string::npos) return mpq_class(std::strtod(text.c_str(), nullptr));
  mpq_class x(text);
  x.canonicalize();
  return x;
}
json load(const std::string& name) {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/" + name);
  EXPECT_TRUE(in.good()) << name;
  return json::parse(in);
}
Points curve(const json& curves, const std::string& id) {
  const json& points = curves.at(id).at("control_points");
  Points control;
  for (std::size_t i = 0; i < points.at(0).size(); ++i)
    control.push_back({number(points.at(0).at(i)), number(points.at(1).at(i))});
  return control;
}
/// The parameters' numbers lie in [lo, hi] of one point each.
bool holds(const CommonParts& found, const mpq_class& s, const mpq_class& t, double slack) {
  for (const auto& p : found.points)
    if (s >= p.s_lo - slack && s <= p.s_hi + slack && t >= p.t_lo - slack && t <= p.t_hi + slack)
      return true;
  return false;
}

void expect_stated(const support::CurvePair& pair) {
  SCOPED_TRACE(pair.name);
  const CommonParts found =
      common_parts(support::rational_points(pair.a), support::rational_points(pair.b));
  ASSERT_TRUE(found.decided);
  if (pair.points < 0) return;
  EXPECT_EQ(found.points.size(), static_cast<std::size_t>(pair.points));
  EXPECT_EQ(found.intervals.size(), static_cast<std::size_t>(pair.intervals));
  for (const auto& p : found.points) {
    EXPECT_LE(p.s_hi - p.s_lo, mpq_class(0x1p-80));
    EXPECT_LE(p.t_hi - p.t_lo, mpq_class(0x1p-80));
    if (pair.multiplicity > 0) {
      EXPECT_EQ(p.multiplicity, pair.multiplicity);
    }
  }
  for (const auto& at : pair.at) EXPECT_TRUE(holds(found, at[0], at[1], 0));
}

TEST(CurveOracle, KnowsTheHardPairs) {
  bezel::RandomStream random("CurveOracle.KnowsTheHardPairs", 1);
  int mapped = 0;
  for (const auto& generator :
       {support::nine_hits(), support::near_tangents(), support::contacts(), support::sheared(),
        support::overlaps(), support::singular_and_ends()})
    for (const support::CurvePair& pair : generator) {
      expect_stated(pair);
      expect_stated(exchanged(pair));
      expect_stated(with_first_reversed(pair));
      expect_stated(scaled(pair, 200));
      for (int i = 0; i < 4; ++i)
        if (const auto image = exactly_mapped(pair, support::random_dyadic_map(random))) {
          expect_stated(*image);
          ++mapped;
        }
    }
  EXPECT_GT(mapped, 300);
}

/// Eliminating the other parameter is another computation; and the curves must meet there.
TEST(CurveOracle, BothEliminationsAgree) {
  bezel::RandomStream random("CurveOracle.BothEliminationsAgree", 1);
  std::size_t points = 0;
  for (int i = 0; i < 300; ++i) {
    const int m = 1 + static_cast<int>(random.below(5)), n = 1 + static_cast<int>(random.below(4));
    const Points a = support::rational_points(support::random_curve(random, m));
    const Points b = support::rational_points(support::random_curve(random, n));
    const CommonParts one = common_parts(a, b), two = common_parts(b, a);
    ASSERT_TRUE(one.decided && two.decided);
    ASSERT_EQ(one.points.size(), two.points.size());
    points += one.points.size();
    for (const auto& p : one.points) {
      EXPECT_EQ(p.multiplicity, 1);
      EXPECT_NE(p.sign, 0);
      EXPECT_TRUE(std::any_of(two.points.begin(), two.points.end(), [&](const auto& q) {
        return p.s_lo <= q.t_hi && q.t_lo <= p.s_hi && p.t_lo <= q.s_hi && q.s_lo <= p.t_hi &&
               q.sign == -p.sign;
      }));
      const auto x = support::exact_point(a, (p.s_lo + p.s_hi) / 2);
      const auto y = support::exact_point(b, (p.t_lo + p.t_hi) / 2);
      // Control points differ by at most 1: derivatives are at most the degree.
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_LE(abs(x[k] - y[k]), m * (p.s_hi - p.s_lo) + n * (p.t_hi - p.t_lo));
    }
  }
  EXPECT_GT(points, 200u);
}

/// A double point on a double point is beyond it, and said to be.
TEST(CurveOracle, SaysWhatItCannotDecide) {
  const Points loop = support::rational_points(support::loop_curve);
  Points mirrored = loop;
  for (auto& p : mirrored) p[1] = mpq_class(3, 5) - p[1];  // the double point is at (1/2, 3/10)
  EXPECT_FALSE(common_parts(loop, mirrored).decided);
  mirrored[0][0] += mpq_class(1, 100);
  EXPECT_TRUE(common_parts(loop, mirrored).decided);
}

TEST(CurveOracle, AgreesWithTheReferencePairs) {
  const json curves = load("curves.json"), cases = load("curve_intersections.json");
  ASSERT_EQ(cases.size(), 53u);
  int exact_tangencies = 0;
  for (const json& c : cases) {
    const int id = c.at("id");
    SCOPED_TRACE("case " + std::to_string(id));
    const CommonParts found =
        common_parts(curve(curves, c.at("curve1")), curve(curves, c.at("curve2")));
    ASSERT_TRUE(found.decided);
    const json &s = c.at("curve1_params"), &t = c.at("curve2_params");
    if (id == 20) {  // the only pair that shares an interval
      ASSERT_EQ(found.intervals.size(), 1u);
      EXPECT_EQ(found.intervals[0].s0, number(s.at(0)));
      EXPECT_EQ(found.intervals[0].s1, number(s.at(1)));
      EXPECT_EQ(found.intervals[0].t0, number(t.at(0)));
      EXPECT_EQ(found.intervals[0].t1, number(t.at(1)));
      continue;
    }
    EXPECT_TRUE(found.intervals.empty());
    // Case 46 is tangent up to rounding only: as given, the curves cross twice there.
    EXPECT_EQ(found.points.size(), s.size() + (id == 46 ? 1u : 0u));
    for (std::size_t i = 0; i < s.size(); ++i)
      EXPECT_TRUE(holds(found, number(s.at(i)), number(t.at(i)), id == 46 ? 0x1p-28 : 0x1p-52))
          << i;
    for (const auto& p : found.points)
      if (p.multiplicity > 1) ++exact_tangencies;
    if (id == 42 || id == 45) {
      EXPECT_EQ(found.points.at(0).multiplicity, 3);
    }
  }
  EXPECT_EQ(exact_tangencies, 12);  // 13 pairs are tangent, 46 only to rounding
}

}  // namespace
