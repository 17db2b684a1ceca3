#include "bezel/geometry/exact_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using bezel::Dyadic;
using bezel::Ratio;
using bezel::Vec2;
using namespace bezel::geometry_kernel;
using Points = std::vector<Vec2>;

const Points parabola{{{-1, 1}}, {{0, -1}}, {{1, 1}}};  // (2 s - 1, (2 s - 1)^2)
const Points axis{{{-1, 0}}, {{1, 0}}};

TEST(ExactCurve, TaylorCoefficients) {
  const ExactCurve c(parabola, 0);
  EXPECT_EQ(c.degree(), 2);
  const ExactTaylor at_half = c.taylor(Dyadic(0.5));
  EXPECT_TRUE(at_half[0] == (Polynomial{0.0, 2.0, 0.0}));
  EXPECT_TRUE(at_half[1] == (Polynomial{0.0, 0.0, 4.0}));
  // At 1/3, times 9: x = -1/3 + 2 h, y = 1/9 - 4/3 h + 4 h^2.
  const ExactTaylor at_third = c.taylor(Ratio{1.0, 3.0});
  EXPECT_TRUE(at_third[0] == (Polynomial{-3.0, 18.0, 0.0}));
  EXPECT_TRUE(at_third[1] == (Polynomial{1.0, -12.0, 36.0}));
  EXPECT_EQ(c(Dyadic(0.75))[1].to_double(), 0.25);
  // Leading zeros are left out, and the scale is exact.
  const ExactCurve line(Points{{{0, 0}}, {{1, 2}}, {{2, 4}}}, 3);
  EXPECT_EQ(line.degree(), 1);
  EXPECT_EQ(line(Dyadic(1.0))[1].to_double(), 0.5);
}

TEST(ExactCurve, ContactsAreVerified) {
  const ExactCurve a(parabola, 0), b(axis, 0);
  EXPECT_TRUE(verify_contact(a, b, Ratio{0.5}, Ratio{0.5}));
  EXPECT_FALSE(verify_contact(a, b, Ratio{0.5}, Ratio{0.5 + 0x1p-50}));
  EXPECT_FALSE(verify_contact(a, b, Ratio{0.5 + 0x1p-40}, Ratio{0.5 + 0x1p-40}));
}

TEST(ExactCurve, OrderOfContact) {
  const auto order = [](const Points& c, const Points& d, const Ratio& s, const Ratio& t) {
    const auto contact = verify_contact(ExactCurve(c, 0), ExactCurve(d, 0), s, t);
    EXPECT_TRUE(contact.has_value());
    return contact_order(*contact, 0, 20, 0.5);
  };
  const Ratio half{0.5}, third{1.0, 3.0};
  EXPECT_EQ(order(parabola, axis, half, half).order, 2);
  EXPECT_EQ(
      order({{{-3, -1}}, {{-1, 1}}, {{1, -1}}, {{3, 1}}}, {{{-3, 0}}, {{3, 0}}}, half, half).order,
      3);
  EXPECT_EQ(order({{{-1, 1}}, {{-0.25, -2}}, {{0.5, 4}}, {{1.25, -8}}, {{2, 16}}},
                  {{{-1, 0}}, {{2, 0}}}, third, third)
                .order,
            4);
  // x^2 and x^2 + x^3.
  EXPECT_EQ(order({{{-3, 9}}, {{0, -9}}, {{3, 9}}},
                  {{{-3, -18}}, {{-1, 24}}, {{1, -30}}, {{3, 36}}}, half, half)
                .order,
            3);
  // Crossing at an angle.
  EXPECT_EQ(order(parabola, {{{-1, -1}}, {{1, 1}}}, Ratio{0.5}, Ratio{0.5}).order, 1);
  // A cusp across the line and along it.
  const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
  EXPECT_EQ(order(cusp, {{{-1, 0.75}}, {{2, 0.75}}}, half, half).order, 2);
  // Which way the curves cross: cubics through the x axis upwards, in either direction.
  const Points up{{{-3, -1}}, {{-1, 1}}, {{1, -1}}, {{3, 1}}}, down(up.rbegin(), up.rend());
  const Points right{{{-3, 0}}, {{3, 0}}}, left(right.rbegin(), right.rend());
  EXPECT_EQ(order(up, right, half, half).sign, -1);  // the axis passes from left to right of it
  EXPECT_EQ(order(up, left, half, half).sign, 1);
  EXPECT_EQ(order(down, right, half, half).sign, 1);
  EXPECT_EQ(order(right, up, half, half).sign, 1);
  EXPECT_EQ(order(parabola, axis, half, half).sign, 0);
  // A curve and itself: no order within any limit.
  EXPECT_EQ(order(parabola, parabola, half, half).order, 0);
}

TEST(ExactCurve, TheRadiusHoldsNoOtherContact) {
  // y = x^2 (x - 3 d), x = 2 s - 1, meets the axis at s = 1/2 and at s = 1/2 + 3 d / 2.
  for (int k = 2; k <= 40; ++k) {
    const double d = std::ldexp(1.0, -k);
    const Points c{{{-3, -1 - 3 * d}}, {{-1, 1 + d}}, {{1, -1 + d}}, {{3, 1 - 3 * d}}};
    const auto contact = verify_contact(
        ExactCurve(c, 0), ExactCurve(Points{{{-3, 0}}, {{3, 0}}}, 0), Ratio{0.5}, Ratio{0.5});
    ASSERT_TRUE(contact) << k;
    const ContactOrder order = contact_order(*contact, 0, 20, 0.5);
    EXPECT_EQ(order.order, 2) << k;
    EXPECT_GT(order.s_radius, d / 4) << k;
    EXPECT_LT(order.s_radius, 1.5 * d) << k;
  }
}

TEST(ExactCurve, CoincidenceUnderAnAffineChange) {
  const Points c{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
  const Points reversed(c.rbegin(), c.rend());
  const ExactCurve a(c, 0), b(reversed, 0);
  const auto contact = verify_contact(a, b, Ratio{1.0}, Ratio{0.0});
  ASSERT_TRUE(contact);
  const auto change = coincide(*contact);
  ASSERT_TRUE(change);
  EXPECT_TRUE(change->p == -change->q);
  Points moved = c;
  moved[2] = Vec2{{2, -1 + 0x1p-52}};
  const auto near = verify_contact(a, ExactCurve(moved, 0), Ratio{0.0}, Ratio{0.0});
  ASSERT_TRUE(near);
  EXPECT_FALSE(coincide(*near));
}

TEST(ExactCurve, CommonRoots) {
  // (x^2 - 2) (x - 1) and (x^2 - 2) (x + 3).
  const Polynomial f{2.0, -2.0, -1.0, 1.0}, g{-6.0, -2.0, 3.0, 1.0};
  EXPECT_EQ(common_root(f, g, Dyadic(1.25), Dyadic(1.5)), true);
  EXPECT_NE(common_root(f, g, Dyadic(0.5), Dyadic(1.25)), true);
  EXPECT_EQ(common_root({-1.0, 1.0}, {-2.0, 1.0}, Dyadic(0.5), Dyadic(3.0)), false);
  EXPECT_EQ(common_root({0.0}, {-1.0, 1.0}, Dyadic(0.5), Dyadic(2.0)), true);
  EXPECT_EQ(common_root({-1.0, 1.0}, {0.0}, Dyadic(0.5), Dyadic(2.0)), true);
  EXPECT_EQ(common_root({-1.0, 1.0}, {5.0}, Dyadic(0.5), Dyadic(2.0)), false);
  EXPECT_FALSE(common_root(Polynomial(20, Dyadic(1.0)), g, Dyadic(0.5), Dyadic(2.0)).has_value());
}

}  // namespace
