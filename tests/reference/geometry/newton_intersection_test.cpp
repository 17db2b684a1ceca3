// Newton's method for intersections against
// tests/reference/data/compensated/newton_intersections.json: a tangent pair of parabolas, and the
// same parabolas moved until they are almost tangent, kappa from 38 to 2e30.

#include "bezel/geometry/newton_intersection.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using namespace bezel;
using bernstein::NewtonStop;
using nlohmann::json;
using Points = std::vector<Vec2>;

double hex(const json& j) {
  return std::strtod(j.get<std::string>().c_str(), nullptr);
}
Points points(const json& x, const json& y) {
  Points out;
  for (std::size_t j = 0; j < x.size(); ++j) out.push_back(Vec2{{hex(x[j]), hex(y[j])}});
  return out;
}

void expect_same_bits(double found, double expected) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected))
      << found << " " << expected;
}

struct Form {
  const char* name;
  ResidualForm form;
};
constexpr Form forms[] = {{"basic", ResidualForm::plain},
                          {"compensated", ResidualForm::compensated},
                          {"naive_comp", ResidualForm::rounded_values}};

NewtonStop stop_of(const json& j) {
  const std::string stop = j.get<std::string>();
  return stop == "tol"    ? NewtonStop::small_step
         : stop == "zero" ? NewtonStop::zero_residual
         : stop == "max"  ? NewtonStop::max_iterations
                          : NewtonStop::not_finite;
}

json load() {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/../compensated/newton_intersections.json");
  EXPECT_TRUE(in.good());
  return json::parse(in);
}

TEST(NewtonIntersectionReference, TangentPair) {
  // x1 = 2 (4 s^2 - 1), y1 = (2 s - 1)^2 + 1; x2 = 4 (4 t^2 - 1), y2 = 4 (2 t - 1)^2 + 1.
  const Points a{Vec2{{-2, 2}}, Vec2{{-2, 0}}, Vec2{{6, 2}}};
  const Points b{Vec2{{-4, 5}}, Vec2{{-4, -3}}, Vec2{{12, 5}}};
  const json data = load().at("tangent");
  for (const Form& form : forms) {
    SCOPED_TRACE(form.name);
    const json& expected = data.at(form.name);
    const json& history = expected.at("history");
    const NewtonIntersection found =
        newton_intersection(a, b, hex(history[0][0]), hex(history[0][1]), form.form);
    EXPECT_EQ(found.iterations, expected.at("iters").get<int>());
    EXPECT_EQ(found.stop, stop_of(expected.at("stop")));
    ASSERT_EQ(found.history.size(), history.size());
    for (std::size_t i = 0; i < history.size(); ++i) {
      expect_same_bits(found.history[i].s, hex(history[i][0]));
      expect_same_bits(found.history[i].t, hex(history[i][1]));
    }
  }
}

TEST(NewtonIntersectionReference, AlmostTangentPairs) {
  const json data = load().at("almost_tangent");
  ASSERT_EQ(data.size(), 49U);
  for (const json& row : data) {
    const int n = row.at("n").get<int>();
    const Points a = points(row.at("x1"), row.at("y1")), b = points(row.at("x2"), row.at("y2"));
    for (const Form& form : forms) {
      SCOPED_TRACE(std::string(form.name) + " n = " + std::to_string(n));
      const json& expected = row.at(form.name);
      const NewtonIntersection found = newton_intersection(a, b, 1.0, 1.0, form.form);
      expect_same_bits(found.s, hex(expected.at("s")));
      expect_same_bits(found.t, hex(expected.at("t")));
      EXPECT_EQ(found.iterations, expected.at("iters").get<int>());
      EXPECT_EQ(found.stop, stop_of(expected.at("stop")));
      EXPECT_EQ(found.history.size(), static_cast<std::size_t>(found.iterations) +
                                          (found.stop == NewtonStop::zero_residual ? 0 : 1));
    }
    // r = 2^-n; alpha = (1 + sqrt r) / 2 and beta = (2 + sqrt r) / 4 are doubles for even n, and
    // come out exactly.
    if (n % 2 == 0) {
      const double root = std::ldexp(1.0, -n / 2);
      const NewtonIntersection found =
          newton_intersection(a, b, 1.0, 1.0, ResidualForm::compensated);
      EXPECT_EQ(found.s, (1.0 + root) / 2);
      EXPECT_EQ(found.t, (2.0 + root) / 4);
    }
    // Where the intersection is not a double, within u: where compensation carries, kappa < 1/u.
    if (row.at("kappa").get<double>() < 0x1p53) {
      const double r = std::ldexp(1.0, -n), exact = (1.0 + std::sqrt(r)) / 2;
      const NewtonIntersection found =
          newton_intersection(a, b, 1.0, 1.0, ResidualForm::compensated);
      EXPECT_NEAR(found.s, exact, 0x1p-53);
    }
  }
}

TEST(NewtonIntersectionReference, Condition) {
  const json data = load().at("almost_tangent");
  ASSERT_EQ(data.size(), 49U);
  for (const json& row : data) {
    const int n = row.at("n").get<int>();
    const Points a = points(row.at("x1"), row.at("y1")), b = points(row.at("x2"), row.at("y2"));
    const double r = std::ldexp(1.0, -n);
    const double alpha = (1.0 + std::sqrt(r)) / 2, beta = (2.0 + std::sqrt(r)) / 4;
    // Even n: alpha, beta and the tangents are doubles. Odd n: alpha and beta are rounded by u/2
    // each, and the determinant of the tangents, 32 r, moves by up to (128 + 256) u/2.
    const double allowed = n % 2 == 0 ? 0.0 : 8 * 0x1p-53 / r;
    EXPECT_NEAR(intersection_condition(a, b, alpha, beta) / row.at("kappa").get<double>(), 1.0,
                1e-14 + allowed)
        << n;
  }
}

}  // namespace
