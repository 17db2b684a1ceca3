// newton_intersection and intersection_condition: known values, why it stops, documented errors.
// Iterates: tests/reference/geometry/newton_intersection_test.cpp.

#include "bezel/geometry/newton_intersection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bezel/base/error.hpp"

namespace {

using namespace bezel;
using bernstein::NewtonStop;
using testing::ThrowsMessage;
using Points = std::vector<Vec2>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr ResidualForm forms[] = {ResidualForm::plain, ResidualForm::compensated,
                                  ResidualForm::rounded_values};

// [2s, 2s] and [4 t^2, 2 - 4 t^2], which meet at (1/2, 1/2).
const Points line{Vec2{{0, 0}}, Vec2{{2, 2}}};
const Points parabola{Vec2{{0, 2}}, Vec2{{0, 2}}, Vec2{{4, -2}}};

TEST(NewtonIntersection, ConditionsKnownInClosedForm) {
  EXPECT_NEAR(intersection_condition(line, parabola, 0.5, 0.5), std::sqrt(202.0) / 8, 1e-14);
  for (const double r : {1.0, 0x1p-10, 0x1p-30}) {
    // y = 1 and r x + y = 1 + r, both with x as the parameter.
    const Points level{Vec2{{0, 1}}, Vec2{{1, 1}}}, slope{Vec2{{0, 1 + r}}, Vec2{{1, 1}}};
    EXPECT_NEAR(intersection_condition(level, slope, 1.0, 1.0) / std::sqrt(4 / (r * r) + 4 / r + 2),
                1.0, 1e-14);
  }
  // Scaling by powers of two, and exchange, change nothing.
  const double kappa = intersection_condition(line, parabola, 0.5, 0.5);
  EXPECT_NEAR(intersection_condition(parabola, line, 0.5, 0.5), kappa, 1e-14);
  for (const double scale : {0x1p-1000, 0x1p+1000}) {
    Points a = line, b = parabola;
    for (Vec2& p : a) p *= scale;
    for (Vec2& p : b) p *= scale;
    EXPECT_EQ(intersection_condition(a, b, 0.5, 0.5), kappa);
  }
  EXPECT_EQ(intersection_condition(line, line, 0.5, 0.5), infinity);
  EXPECT_EQ(intersection_condition(Points{Vec2{{1, 1}}}, line, 0.5, 0.5), infinity);
  EXPECT_EQ(intersection_condition(line, parabola, 0.0, 0.0), infinity);
}

TEST(NewtonIntersection, ConvergesInEveryForm) {
  for (const ResidualForm form : forms) {
    const NewtonIntersection found = newton_intersection(line, parabola, 0.6, 0.7, form);
    EXPECT_NEAR(found.s, 0.5, 0x1p-52);
    EXPECT_NEAR(found.t, 0.5, 0x1p-52);
    EXPECT_LE(found.iterations, 8);
    EXPECT_NEAR(found.condition, std::sqrt(202.0) / 8, 1e-13);
    EXPECT_EQ(found.history.front().s, 0.6);
    EXPECT_EQ(found.history.back().t, found.t);
  }
}

TEST(NewtonIntersection, WhyItStops) {
  for (const ResidualForm form : forms) {
    const NewtonIntersection there = newton_intersection(line, parabola, 0.5, 0.5, form);
    EXPECT_EQ(there.stop, NewtonStop::zero_residual);
    EXPECT_EQ(there.iterations, 1);
    EXPECT_EQ(there.history.size(), 1U);
    const NewtonIntersection cut = newton_intersection(line, parabola, 0.6, 0.7, form, {1e-15, 2});
    EXPECT_EQ(cut.stop, NewtonStop::max_iterations);
    EXPECT_EQ(cut.iterations, 2);
    EXPECT_EQ(cut.history.size(), 3U);
    Points shifted = line;
    for (Vec2& p : shifted) p += Vec2{{1, 0}};
    const NewtonIntersection parallel = newton_intersection(line, shifted, 0.5, 0.5, form);
    EXPECT_EQ(parallel.stop, NewtonStop::zero_derivative);
    EXPECT_EQ(parallel.iterations, 0);
    EXPECT_EQ(parallel.condition, infinity);
    EXPECT_EQ(newton_intersection(Points{Vec2{{3, 3}}}, line, 0.5, 0.5, form).stop,
              NewtonStop::zero_derivative);
    EXPECT_EQ(newton_intersection(line, parabola, 1e200, 1e200, form).stop, NewtonStop::not_finite);
  }
}

TEST(NewtonIntersection, BadInput) {
  const auto run = [](const Points& a, const Points& b, double s, double t,
                      const NewtonIntersectionOptions& options = {}) {
    newton_intersection(a, b, s, t, ResidualForm::compensated, options);
  };
  EXPECT_THAT([&] { run({}, line, 0, 0); },
              ThrowsMessage<InputError>("the curve has no control points, expected 1 to 61"));
  EXPECT_THAT([&] { run(line, Points(62), 0, 0); },
              ThrowsMessage<InputError>("the curve has 62 control points, expected 1 to 61"));
  EXPECT_THAT(
      [&] {
        run(line, {Vec2{{0, nan}}}, 0, 0);
      },
      ThrowsMessage<InputError>("control point 0 of the curve is not finite"));
  EXPECT_THAT([&] { run(line, line, nan, 0); },
              ThrowsMessage<InputError>("start s is nan, expected a finite value"));
  EXPECT_THAT([&] { run(line, line, 0, infinity); },
              ThrowsMessage<InputError>("start t is inf, expected a finite value"));
  EXPECT_THAT(
      [&] {
        run(line, line, 0, 0, {nan, 5});
      },
      ThrowsMessage<InputError>("tolerance nan, expected at least 0"));
  EXPECT_THAT(
      [&] {
        run(line, line, 0, 0, {0.0, -5});
      },
      ThrowsMessage<InputError>("at most -5 iterations, expected at least 0"));
  EXPECT_THAT([&] { intersection_condition(line, line, nan, 0); },
              ThrowsMessage<InputError>("parameter is nan, expected a finite value"));
  EXPECT_THAT([&] { intersection_condition({}, line, 0, 0); },
              ThrowsMessage<InputError>("the curve has no control points, expected 1 to 61"));
}

}  // namespace
