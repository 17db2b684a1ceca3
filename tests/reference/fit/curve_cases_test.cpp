// The five curves of [bjontegaard2009] against an independent prototype
// (tests/reference/data/curves/SOURCE.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bezel/fit/curve_interpolation.hpp"
#include "support/smooth_curves.hpp"

namespace {

using bezel::CurveErrors;
using bezel::CurveInterpolant;
using bezel::CurveInterpolator;
using bezel::CurveKind;
using bezel::CurveMethod;
using bezel::CurveStatus;
using bezel::PlaneCurve;
using bezel::testing::paper_curve;

const nlohmann::json& cases() {
  static const nlohmann::json all = [] {
    std::ifstream in(BEZEL_CURVE_CASES);
    return nlohmann::json::parse(in);
  }();
  return all;
}
const CurveInterpolator& interpolator() {
  static const CurveInterpolator tables;
  return tables;
}

class CurveCase : public ::testing::TestWithParam<int> {
 protected:
  const nlohmann::json& data() const { return cases().at(std::to_string(GetParam())); }
  const PlaneCurve curve = paper_curve(GetParam());

  // Distances at most 3.5 times the best known, also of polynomials that do not interpolate; below
  // 2e-14 all count as exact.
  void check_distances(int first, int last) const {
    for (int n = first; n <= last; ++n) {
      const CurveInterpolant<2> found = interpolator().interpolate(curve, n);
      const double known = data().at("best_d2").at(std::size_t(n - 2)).get<double>();
      ASSERT_EQ(found.nodes.status, CurveStatus::ok);
      EXPECT_LE(found.errors.distance_l2, 3.5 * std::max(known, 2e-14)) << "degree " << n;
    }
  }
};

TEST_P(CurveCase, LengthIsThePrototypes) {
  EXPECT_NEAR(curve.length(), data().at("length").get<double>(), 4e-15);
}

TEST_P(CurveCase, SimplePlacementsHaveThePrototypesErrors) {
  const std::pair<const char*, CurveMethod> methods[] = {{"standard", CurveMethod::standard},
                                                         {"chord", CurveMethod::chord},
                                                         {"arclength", CurveMethod::arc_length}};
  for (const auto& [key, method] : methods)
    for (const int n : {2, 5, 8, 12, 20, 29}) {
      const CurveErrors found = interpolator().interpolate(curve, n, method).errors;
      const double d2 = data().at(key).at("d2").at(std::size_t(n - 2)).get<double>();
      const double l2 = data().at(key).at("L2").at(std::size_t(n - 2)).get<double>();
      // Of the errors six digits are stored. Interpolants that swing far from the curve have
      // distances with kinks, where the nearest foot changes: their quadrature differs by 3e-4
      // (seen). The prototype followed one foot; ours may be nearer (1 percent seen).
      EXPECT_LE(found.distance_l2, 1.0005 * d2 + 2e-15) << key << " " << n;
      EXPECT_GE(found.distance_l2, 0.985 * d2 - 2e-15) << key << " " << n;
      if (found.monotone) {
        EXPECT_NEAR(found.l2, l2, 2e-5 * l2 + 2e-15) << key << " " << n;
      }
    }
}

TEST_P(CurveCase, DistancesUpToDegree12) {
  check_distances(2, 12);
}
TEST_P(CurveCase, DistancesUpToDegree17) {
  check_distances(13, 17);
}
TEST_P(CurveCase, DistancesUpToDegree20) {
  check_distances(18, 20);
}
TEST_P(CurveCase, DistancesUpToDegree23) {
  check_distances(21, 23);
}
TEST_P(CurveCase, DistancesUpToDegree26) {
  check_distances(24, 26);
}
TEST_P(CurveCase, DistancesUpToDegree30) {
  check_distances(27, 30);
}

INSTANTIATE_TEST_SUITE_P(Paper, CurveCase, ::testing::Values(1, 2, 3, 4, 5));

double l2(int number, int degree, CurveMethod method = CurveMethod::best) {
  return interpolator().interpolate(paper_curve(number), degree, method).errors.l2;
}

TEST(PaperGoals, ErrorFour) {
  EXPECT_LE(l2(1, 7), 2.5e-13);
  EXPECT_LE(l2(2, 15), 2e-14);
  for (int n = 6; n <= 30; n += 3) EXPECT_LE(l2(3, n), 1e-15) << n;
  EXPECT_LE(l2(4, 7), 1e-4);
  EXPECT_LE(l2(4, 16), 1e-13);
  EXPECT_LE(l2(5, 13), 2e-14);
}

TEST(PaperGoals, LeastErrorFourIsNeverAboveTheStart) {
  for (int number = 1; number <= 5; ++number)
    for (const int n : {3, 5, 7, 9}) {
      const CurveErrors start = interpolator().interpolate(paper_curve(number), n).errors;
      const CurveErrors least =
          interpolator().interpolate(paper_curve(number), n, CurveMethod::l2).errors;
      EXPECT_LE(least.l2, start.l2 * (1.0 + 1e-12) + 1e-15) << number << " " << n;
      EXPECT_TRUE(least.monotone || !start.monotone) << number << " " << n;
    }
}

TEST(PaperGoals, EqualTangentNodesSolveTheEquations) {
  for (const int number : {1, 2, 3})
    for (int n = 2; n <= 12; ++n) {
      const auto found =
          interpolator().interpolate(paper_curve(number), n, CurveMethod::equal_tangent);
      EXPECT_EQ(found.nodes.status, CurveStatus::ok) << number << " " << n;
      EXPECT_EQ(found.nodes.kind, CurveKind::equal_tangent) << number << " " << n;
      EXPECT_LE(found.nodes.residual, 1e-10) << number << " " << n;
    }
}

}  // namespace
