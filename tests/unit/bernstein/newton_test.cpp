// newton_root: simple cases, why it stops, documented errors. The conditioned family is in
// tests/reference/bernstein/newton_test.cpp.

#include "bezel/bernstein/newton.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/roots.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::InputError;
using testing::ThrowsMessage;
using Doubles = std::vector<double>;

constexpr NewtonForm forms[] = {NewtonForm::basic, NewtonForm::accurate, NewtonForm::full,
                                NewtonForm::triple};

TEST(Newton, WellConditionedRootInEveryForm) {
  const double root = (3.0 - std::sqrt(3.0)) / 6.0;  // of 1 - 6 s + 6 s^2
  for (const NewtonForm form : forms) {
    const NewtonRoot found = newton_root(Doubles{1.0, -2.0, 1.0}, 0.1, form);
    EXPECT_EQ(found.stop, NewtonStop::small_step);
    EXPECT_NEAR(found.s, root, 4 * 0x1p-53);
    EXPECT_LE(found.iterations, 6);
    ASSERT_EQ(found.history.size(), static_cast<std::size_t>(found.iterations) + 1);
    EXPECT_EQ(found.history.front(), 0.1);
    EXPECT_EQ(found.history.back(), found.s);
    // p~ = 1 - 2 s + ... = (1-s)^2 + 4 s (1-s) + s^2, p' = 12 s - 6
    EXPECT_NEAR(found.condition, (1.0 + 2.0 * root * (1.0 - root)) / (root * (6.0 - 12.0 * root)),
                1e-5);
  }
}

TEST(Newton, WhyItStops) {
  for (const NewtonForm form : forms) {
    const NewtonRoot exact = newton_root(Doubles{-1.0, 3.0}, 0.25, form);
    EXPECT_EQ(exact.stop, NewtonStop::small_step);
    EXPECT_EQ(exact.iterations, 1);
    EXPECT_EQ(exact.s, 0.25);

    const NewtonRoot flat = newton_root(Doubles{1.0, 0.5, 1.0}, 0.5, form);
    EXPECT_EQ(flat.stop, NewtonStop::zero_derivative);
    EXPECT_EQ(flat.iterations, 0);
    EXPECT_EQ(flat.history, Doubles{0.5});
    EXPECT_EQ(newton_root(Doubles{7.0}, 0.5, form).stop, NewtonStop::zero_derivative);
    // Value and derivative 0: no step is defined.
    const NewtonRoot twice = newton_root(Doubles{1.0, -1.0, 1.0}, 0.5, form);
    EXPECT_EQ(twice.stop, NewtonStop::zero_derivative);
    EXPECT_EQ(twice.s, 0.5);
    EXPECT_EQ(twice.condition, std::numeric_limits<double>::infinity());

    const NewtonRoot cut = newton_root(Doubles{1.0, -2.0, 1.0}, 0.1, form, {1e-15, 2});
    EXPECT_EQ(cut.stop, NewtonStop::max_iterations);
    EXPECT_EQ(cut.iterations, 2);
    const NewtonRoot none = newton_root(Doubles{1.0, -2.0, 1.0}, 0.1, form, {1e-15, 0});
    EXPECT_EQ(none.stop, NewtonStop::max_iterations);
    EXPECT_EQ(none.s, 0.1);

    // The slope underflows almost to nothing: the step overflows.
    const NewtonRoot away = newton_root(Doubles{1e300, 1e300 * (1.0 + 0x1p-52)}, 1e300, form);
    EXPECT_TRUE(std::isfinite(away.s));
    const NewtonRoot far = newton_root(Doubles{1e200, 0.0, 0.0}, 1e200, form);
    EXPECT_EQ(far.stop, NewtonStop::not_finite);
    EXPECT_EQ(far.s, 1e200);
  }
}

TEST(Newton, BadInput) {
  const Doubles b{-1.0, 1.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([] { newton_root(Doubles{}, 0.5, NewtonForm::full); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([] { newton_root(Doubles(62, 1.0), 0.5, NewtonForm::full); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT(
      [&] {
        newton_root(Doubles{1.0, nan}, 0.5, NewtonForm::full);
      },
      ThrowsMessage<InputError>("coefficient 1 is not finite"));
  EXPECT_THAT([&] { newton_root(b, nan, NewtonForm::full); },
              ThrowsMessage<InputError>("start is nan, expected a finite value"));
  EXPECT_THAT(
      [&] {
        newton_root(b, 0.5, NewtonForm::full, {-1.0, 10});
      },
      ThrowsMessage<InputError>("tolerance -1.000000, expected at least 0"));
  EXPECT_THAT(
      [&] {
        newton_root(b, 0.5, NewtonForm::full, {nan, 10});
      },
      ThrowsMessage<InputError>("tolerance nan, expected at least 0"));
  EXPECT_THAT(
      [&] {
        newton_root(b, 0.5, NewtonForm::full, {1e-15, -1});
      },
      ThrowsMessage<InputError>("at most -1 iterations, expected at least 0"));
}

}  // namespace
