#include "bezel/numeric/local_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/local_error_kernel.hpp"

namespace {

using bezel::Dyadic;
using Doubles = std::vector<double>;

Doubles values(std::size_t n, std::mt19937_64& random) {
  Doubles out(n);
  for (double& x : out)
    x = std::ldexp(static_cast<double>(random() >> 11) * 0x1p-53 - 0.5,
                   static_cast<int>(random() % 120) - 60);
  return out;
}

TEST(LocalError, SumAndErrorsAreExact) {
  std::mt19937_64 random(1);
  for (std::size_t n = 2; n < 40; ++n)
    for (int i = 0; i < 50; ++i) {
      const Doubles e = values(n, random), product = values(2, random);
      Doubles eta(n + 1);
      const double l = bezel::local_error_eft(e, product[0], product[1], eta);
      Dyadic exact = Dyadic(product[0]) * Dyadic(product[1]), found(l);
      for (const double x : e) exact += Dyadic(x);
      for (const double x : eta) found += Dyadic(x);
      EXPECT_EQ(found, exact);
      EXPECT_EQ(l, bezel::local_error(e, product[0], product[1]));
      // The kernel works in place.
      Doubles w = e;
      w.resize(n + 1);
      int count = static_cast<int>(n);
      double k = bezel::kernel::sum_with_errors(w.data(), count--);
      k = bezel::kernel::add_product_with_errors(k, product[0], product[1], w.data(), count);
      EXPECT_EQ(k, l);
      EXPECT_EQ(w, eta);
    }
}

TEST(LocalError, ErrorsAreInTheOrderTheyArise) {
  Doubles eta(4);
  EXPECT_EQ(bezel::local_error_eft(Doubles{1.0, 0x1p-60, 0x1p-61}, 1.0, 0x1p-62, eta), 1.0);
  EXPECT_THAT(eta, testing::ElementsAre(0x1p-60, 0x1p-61, 0.0, 0x1p-62));
}

TEST(LocalError, WrongSizes) {
  Doubles eta(3);
  EXPECT_THAT([&] { bezel::local_error_eft(Doubles{1.0}, 0, 0, eta); },
              testing::ThrowsMessage<bezel::InputError>("found 1 errors, expected at least 2"));
  EXPECT_THAT(
      [&] {
        bezel::local_error_eft(Doubles{1.0, 2.0, 3.0}, 0, 0, eta);
      },
      testing::ThrowsMessage<bezel::InputError>("found 3 places for errors, expected 4"));
  EXPECT_THAT([] { bezel::local_error(Doubles{}, 0, 0); },
              testing::ThrowsMessage<bezel::InputError>("found 0 errors, expected at least 2"));
}

}  // namespace
