#include "bezel/geometry/quadrilateral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/bernstein/interval.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::message_of;

constexpr double u = 0x1p-53;

/// The equally spaced net of [0, 1]^2, each point moved by up to `amount` / g.
std::vector<Vec2> perturbed(RandomStream& random, int g, double amount) {
  std::vector<Vec2> b;
  for (int j = 0; j <= g; ++j)
    for (int i = 0; i <= g; ++i)
      b.push_back(Vec2{(i + random.uniform(-amount, amount)) / g,
                       (j + random.uniform(-amount, amount)) / g});
  return b;
}

/// The tensor-product polynomial with n+1 coefficients each way at (s, t), from the basis.
double value(int n, const std::vector<double>& c, double s, double t) {
  std::vector<double> bs(static_cast<std::size_t>(n) + 1), bt(bs.size());
  bernstein::basis(n, s, bs);
  bernstein::basis(n, t, bt);
  double sum = 0;
  for (std::size_t j = 0; j < bt.size(); ++j)
    for (std::size_t i = 0; i < bs.size(); ++i) sum += c[j * bs.size() + i] * bs[i] * bt[j];
  return sum;
}

double magnitude(const std::vector<Vec2>& b) {
  double most = 0;
  for (const Vec2& p : b) most = std::max({most, std::fabs(p.x()), std::fabs(p.y())});
  return most;
}

TEST(Quadrilateral, ValueAndDerivativesOfABilinearMap) {
  const std::vector<Vec2> b{{0.1, 0.2}, {2.1, 0.3}, {0.4, 1.7}, {1.9, 2.2}};
  const QuadValue at = evaluate_quad(1, b, 0.25, 0.5);
  EXPECT_NEAR(at.point.x(), 0.75 * 0.25 + 0.25 * 2.0, 4 * u);
  EXPECT_NEAR(at.point.y(), 0.75 * 0.95 + 0.25 * 1.25, 4 * u);
  EXPECT_NEAR(at.ds.x(), 2.0 - 0.25, 4 * u);
  EXPECT_NEAR(at.dt.y(), 0.75 * 1.5 + 0.25 * 1.9, 4 * u);
  EXPECT_EQ(evaluate_quad(1, b, 1.0, 0.0).point, b[1]);
  EXPECT_EQ(evaluate_quad(1, b, 0.0, 1.0).point, b[2]);
}

TEST(Quadrilateral, EvaluationAgreesWithTheBasisWithinItsAccuracy) {
  RandomStream random("quadrilateral evaluation", 1);
  for (const int g : {1, 2, 3, 7, 15, 30}) {
    const std::vector<Vec2> b = perturbed(random, g, 1.0);
    std::vector<double> x, y, xs;
    for (const Vec2& p : b) {
      x.push_back(p.x());
      y.push_back(p.y());
    }
    for (int k = 0; k < 20; ++k) {
      const double s = random.uniform(), t = random.uniform(), h = 0x1p-18;
      const QuadValue at = evaluate_quad(g, b, s, t);
      // The reference has (2g + 3) u of each term twice.
      const double within = (6 * g + 4 * g + 8 + g * g) * u * magnitude(b);
      EXPECT_NEAR(at.point.x(), value(g, x, s, t), within);
      EXPECT_NEAR(at.point.y(), value(g, y, s, t), within);
      const Vec2 next = evaluate_quad(g, b, s + h, t).point,
                 last = evaluate_quad(g, b, s - h, t).point;
      EXPECT_NEAR(at.ds.x(), (next.x() - last.x()) / (2 * h), 1e-6 * g * g) << g;
      const Vec2 up = evaluate_quad(g, b, s, t + h).point,
                 down = evaluate_quad(g, b, s, t - h).point;
      EXPECT_NEAR(at.dt.y(), (up.y() - down.y()) / (2 * h), 1e-6 * g * g) << g;
    }
  }
}

TEST(Quadrilateral, TheDeterminantIsTheCrossProductOfTheDerivatives) {
  RandomStream random("quadrilateral determinant", 1);
  for (const int g : {1, 2, 3, 5, 12, 30}) {
    const std::vector<Vec2> b = perturbed(random, g, 0.7);
    const std::vector<double> det = quad_jacobian_determinant(g, b);
    ASSERT_EQ(det.size(), static_cast<std::size_t>(quad_size(2 * g - 1)));
    for (int k = 0; k < 20; ++k) {
      const double s = random.uniform(), t = random.uniform();
      const QuadValue at = evaluate_quad(g, b, s, t);
      EXPECT_NEAR(value(2 * g - 1, det, s, t), cross(at.ds, at.dt), 100 * g * g * u * 4) << g;
    }
  }
}

TEST(Quadrilateral, ValidityIsProvenOrRefuted) {
  RandomStream random("quadrilateral validity", 1);
  int valid = 0, inverted = 0;
  for (const int g : {1, 2, 3, 4, 6, 10})
    for (int k = 0; k < 40; ++k) {
      const std::vector<Vec2> b = perturbed(random, g, 0.1 + 0.03 * k);
      const QuadValidity verdict = check_quad_validity(g, b);
      ASSERT_NE(verdict.status, Validity::undecided) << g << ' ' << k;
      const QuadValue at = evaluate_quad(g, b, verdict.where.x(), verdict.where.y());
      EXPECT_NEAR(cross(at.ds, at.dt), verdict.det, 1e-12 * g * g);
      double least = std::numeric_limits<double>::infinity();
      for (int j = 0; j <= 16; ++j)
        for (int i = 0; i <= 16; ++i) {
          const QuadValue q = evaluate_quad(g, b, i / 16.0, j / 16.0);
          least = std::min(least, cross(q.ds, q.dt));
        }
      if (verdict.status == Validity::valid) {
        ++valid;
        EXPECT_GT(least, 0.0);
      } else {
        ++inverted;
        EXPECT_LT(verdict.det, 0.0);
      }
    }
  EXPECT_GT(valid, 30);
  EXPECT_GT(inverted, 30);
}

TEST(Quadrilateral, ADeterminantThatVanishesAtACornerIsUndecided) {
  // Sides 0 and 3 leave corner 0 in opposite directions.
  const std::vector<Vec2> b{{0, 0}, {1, 0}, {-0.5, 0}, {1, 1}};
  const QuadValidity verdict = check_quad_validity(1, b);
  EXPECT_EQ(verdict.status, Validity::undecided);
  EXPECT_EQ(verdict.det, 0.0);
  EXPECT_EQ(verdict.where, (Vec2{0.0, 0.0}));
  // A little beyond it is inverted, before it valid.
  EXPECT_EQ(check_quad_validity(1, std::vector<Vec2>{{0, 0}, {1, 0}, {-0.5, 1e-12}, {1, 1}}).status,
            Validity::valid);
  EXPECT_EQ(
      check_quad_validity(1, std::vector<Vec2>{{0, 0}, {1, 0}, {-0.5, -1e-12}, {1, 1}}).status,
      Validity::inverted);
}

TEST(Quadrilateral, TheAreaIsTheMeanOfTheDeterminant) {
  RandomStream random("quadrilateral area", 1);
  for (const int g : {1, 2, 5, 9, 20}) {
    const std::vector<Vec2> b = perturbed(random, g, 0.8);
    double sum = 0;
    const std::vector<double> det = quad_jacobian_determinant(g, b);
    for (const double c : det) sum += c;
    EXPECT_NEAR(quad_area(g, b), sum / static_cast<double>(det.size()), 1e-14 * g);
  }
}

TEST(Quadrilateral, SidesRunCounterClockwise) {
  std::vector<Vec2> b;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 2; ++i) b.push_back(Vec2{double(i), double(j)});
  EXPECT_EQ(quad_side(2, b, 0), (std::vector<Vec2>{{0, 0}, {1, 0}, {2, 0}}));
  EXPECT_EQ(quad_side(2, b, 1), (std::vector<Vec2>{{2, 0}, {2, 1}, {2, 2}}));
  EXPECT_EQ(quad_side(2, b, 2), (std::vector<Vec2>{{2, 2}, {1, 2}, {0, 2}}));
  EXPECT_EQ(quad_side(2, b, 3), (std::vector<Vec2>{{0, 2}, {0, 1}, {0, 0}}));
  EXPECT_EQ(quad_area(2, b), 4.0);
}

TEST(Quadrilateral, BadInput) {
  const std::vector<Vec2> b{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  std::vector<Vec2> nan = b;
  nan[2] = Vec2{0.0, std::nan("")};
  EXPECT_EQ(message_of([&] { (void)check_quad_validity(0, b); }),
            "found degree 0 of a quadrilateral, expected 1 to 30");
  EXPECT_EQ(message_of([&] { quad_area(31, b); }),
            "found degree 31 of a quadrilateral, expected 1 to 30");
  EXPECT_EQ(message_of([&] { quad_jacobian_determinant(2, b); }),
            "found 4 control points of a quadrilateral, expected 9");
  EXPECT_EQ(message_of([&] { evaluate_quad(1, nan, 0.5, 0.5); }), "control point 2 is not finite");
  EXPECT_EQ(message_of([&] { evaluate_quad(1, b, 0.5, std::numeric_limits<double>::infinity()); }),
            "parameter t is inf, expected a finite value");
  EXPECT_EQ(message_of([&] { quad_side(1, b, 4); }), "side 4 of a quadrilateral, expected 0 to 3");
}

}  // namespace
}  // namespace bezel
