#include "bezel/bernstein/exact.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/interval_kernel.hpp"

namespace {

using bezel::Dyadic;
using namespace bezel::bernstein;
using Doubles = std::vector<double>;

TEST(ExactPolynomial, ValuesAreThoseOfDeCasteljauAtEveryDegree) {
  std::mt19937_64 random(1);
  for (int d = 0; d <= max_interval_degree; ++d) {
    Doubles b;
    for (int i = 0; i <= d; ++i)
      b.push_back(std::ldexp(static_cast<double>(random() >> 11) - 0x1p52,
                             static_cast<int>(random() % 200) - 150));
    const std::vector<Dyadic> exact(b.begin(), b.end());
    const ExactPolynomial p(b);
    EXPECT_EQ(p.degree(), d);
    for (const double s : {0.0, 1.0, 0.1, 0x1p-1074, -3.7, 1e300}) {
      const Dyadic expected = kernel::evaluate_unchecked(d, exact.data(), Dyadic(s));
      EXPECT_EQ(p(Dyadic(s)), expected) << d << " " << s;
      EXPECT_EQ(p.sign(Dyadic(s)), expected.sign());
    }
  }
}

TEST(ExactPolynomial, DerivativeAndRestriction) {
  const Doubles b{1.0, -0.75, 0.5, -0.25, 0.0};  // (2s-1)^3 (s-1)
  const ExactPolynomial p(b);
  EXPECT_EQ(p(Dyadic(0.5)).sign(), 0);
  EXPECT_EQ(p.derivative()(Dyadic(0.5)).sign(), 0);
  EXPECT_EQ(p.derivative().derivative()(Dyadic(0.5)).sign(), 0);
  EXPECT_EQ(p.derivative().derivative().derivative()(Dyadic(0.5)).sign(), -1);
  EXPECT_EQ(p.derivative().degree(), 3);
  const auto c = p.specialize(Dyadic(0.25), Dyadic(0.75));
  const ExactPolynomial part{std::span<const Dyadic>(c)};
  EXPECT_EQ(part(Dyadic(0.5)), Dyadic());
  EXPECT_EQ(part(Dyadic(0.1)), p(Dyadic(0.25) + Dyadic(0.5) * Dyadic(0.1)));
  EXPECT_FALSE(p.is_zero());
  EXPECT_TRUE(ExactPolynomial(Doubles{0.0, -0.0}).is_zero());
  EXPECT_TRUE(ExactPolynomial(Doubles{7.0}).derivative().is_zero());
}

TEST(ExactPolynomial, BisectionGivesBothHalves) {
  const Doubles b{1.0, -0.75, 0.1, 3.0, -0x1p-60};
  for (std::size_t d = 0; d < b.size(); ++d) {
    std::vector<Dyadic> right(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(d) + 1);
    const ExactPolynomial p{std::span<const Dyadic>(right)};
    std::vector<Dyadic> left = bisect_exactly(right);
    for (auto* half : {&left, &right})
      for (Dyadic& c : *half) c = c.scaled(-static_cast<std::int64_t>(d));
    EXPECT_EQ(left, p.specialize(Dyadic(0.0), Dyadic(0.5))) << d;
    EXPECT_EQ(right, p.specialize(Dyadic(0.5), Dyadic(1.0))) << d;
  }
}

TEST(ExactPolynomial, BadCoefficients) {
  EXPECT_THAT(
      [] { ExactPolynomial{Doubles{}}; },
      testing::ThrowsMessage<bezel::InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([] { ExactPolynomial{Doubles(62)}; },
              testing::ThrowsMessage<bezel::InputError>(testing::HasSubstr("degree 61")));
  EXPECT_THAT(
      [] {
        ExactPolynomial(Doubles{1.0, std::nan("")});
      },
      testing::ThrowsMessage<bezel::InputError>("coefficient 1 is not finite"));
}

}  // namespace
