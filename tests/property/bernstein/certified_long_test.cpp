// Certified values on a million hard points, each against exact integers: faithful, with a bound
// that holds, the same bits in batches of every size and on every SIMD target.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bezel/bernstein/certified.hpp"
#include "certified_check.hpp"
#include "support/exact_values.hpp"
#include "support/hard_polynomials.hpp"
#include "support/simd_targets.hpp"

namespace {

using namespace bezel::bernstein;
using support::complaint;
using support::described;
using support::ExactValues;
using support::Hard;
using support::HardPolynomials;
using support::Number;
using support::same_bits;
using Doubles = std::vector<double>;

class Certified : public testing::TestWithParam<int> {};

TEST_P(Certified, IsFaithfulOnHardPoints) {
  HardPolynomials source(static_cast<std::uint64_t>(2000 + GetParam()), true);
  std::array<long, 6> reached{};
  long checked = 0, zeros = 0, subnormal = 0, infinite = 0;
  int failures = 0;
  for (int polynomial = 0; polynomial < 7300 && failures < 5; ++polynomial) {
    const int n = polynomial % 64 == 0 ? 60 - polynomial / 64 % 61 : source.degree(60);
    const Hard hard = n == 0 ? Hard{source.coefficients(0), source.parameter()} : source.draw(n);
    const Doubles s = source.parameters(hard, polynomial % 71);
    const ExactValues exact(hard.b);
    const std::vector<CertifiedValue> found = support::certified_batch(hard.b, s);
    for (std::size_t q = 0; q < s.size() && failures < 5; ++q) {
      const Number p = exact(s[q]);
      const std::string wrong = complaint(found[q], p);
      if (!wrong.empty()) {
        ADD_FAILURE() << wrong << "; " << described(hard.b, s[q]);
        ++failures;
      }
      ++checked;
      ++reached[static_cast<std::size_t>(found[q].certificate)];
      zeros += p.sign() == 0 ? 1 : 0;
      subnormal += p.sign() != 0 && std::fabs(found[q].value) < 0x1p-1022 ? 1 : 0;
      infinite += std::isinf(found[q].value) ? 1 : 0;
    }
    // One by one, as the batch: the first points of a batch, the last of another.
    const std::size_t few = std::min<std::size_t>(s.size(), polynomial % 8 == 0 ? 9 : 1);
    for (std::size_t i = 0; i < few; ++i) {
      const std::size_t q = polynomial % 2 == 0 ? i : s.size() - 1 - i;
      if (!same_bits(evaluate_certified(hard.b, s[q]), found[q])) {
        ADD_FAILURE() << "alone it has other bits than in a batch of " << s.size() << "; "
                      << described(hard.b, s[q]);
        ++failures;
      }
    }
    if (polynomial % 11 != 0) continue;
    support::on_every_target([&] {
      const std::vector<CertifiedValue> here = support::certified_batch(hard.b, s);
      Doubles value(s.size());
      evaluate_certified(hard.b, s, value);
      for (std::size_t q = 0; q < s.size() && failures < 5; ++q)
        if (!same_bits(here[q], found[q]) || !same_bits(value[q], found[q].value)) {
          ADD_FAILURE() << "other bits than the best target's in place " << q << " of " << s.size()
                        << "; " << described(hard.b, s[q]);
          ++failures;
        }
    });
  }
  EXPECT_GT(checked, 250000);
  // The generators do what they are for.
  EXPECT_GT(zeros, checked / 100);
  EXPECT_GT(subnormal, checked / 100);
  EXPECT_GT(infinite, 100);
  RecordProperty("checked", std::to_string(checked));
  RecordProperty("zeros", std::to_string(zeros));
  RecordProperty("subnormal", std::to_string(subnormal));
  RecordProperty("infinite", std::to_string(infinite));
  for (const int level : {2, 3, 4, 5}) {
    std::string name = "certificate";
    name += std::to_string(level);
    RecordProperty(name, std::to_string(reached[static_cast<std::size_t>(level)]));
  }
}

// Four parts of 7300 polynomials with 0 to 70 points: 10^6 points.
INSTANTIATE_TEST_SUITE_P(Parts, Certified, testing::Range(0, 4));

// Every count of points and every place of one hard point among easy ones, and of one easy point
// among hard ones: what is packed comes back to its own place.
TEST(CertifiedBatch, HardPointsAmongEasyOnes) {
  const Doubles b{-0x1p-6, 0x1p-6 + 0x1p-50, -0x1p-6, 0x1p-6, -0x1p-6, 0x1p-6, -0x1p-6};
  const double easy[] = {0.0625, 0.9, 0.12, 0.99}, hard[] = {0.5, 0.5 + 0x1p-40, 0.5 - 0x1p-20};
  const auto at = [](const auto& list, std::size_t q) { return list[q % std::size(list)]; };
  std::map<double, CertifiedValue> known;
  for (const double* list : {&easy[0], &hard[0]})
    for (std::size_t q = 0; q < (list == easy ? std::size(easy) : std::size(hard)); ++q) {
      const CertifiedValue alone = evaluate_certified(b, list[q]);
      EXPECT_EQ(complaint(alone, ExactValues(b)(list[q])), "");
      known.emplace(list[q], alone);
    }
  for (std::size_t count = 1; count <= 70; ++count)
    for (std::size_t place = 0; place < count; ++place)
      for (const bool one_is_hard : {true, false}) {
        Doubles s;
        for (std::size_t q = 0; q < count; ++q)
          s.push_back((q == place) == one_is_hard ? at(hard, q) : at(easy, q));
        const std::vector<CertifiedValue> found = support::certified_batch(b, s);
        for (std::size_t q = 0; q < count; ++q)
          ASSERT_TRUE(same_bits(found[q], known.at(s[q])))
              << count << " points, place " << q << ", the odd one in " << place;
      }
}

// Terms that underflow although the value does not, and values that do: s^j vanishes, coefficients
// are huge to make up for it.
TEST(CertifiedUnderflow, HugeCoefficientsTimesVanishingPowers) {
  HardPolynomials source(31, true);
  for (int i = 0; i < 3000; ++i) {
    const int n = 1 + source.below(i % 2 == 0 ? 8 : 60);
    Doubles b(static_cast<std::size_t>(n) + 1);
    const int power = 1 + source.below(1100);
    for (int j = 0; j <= n; ++j) {
      const int exponent = std::min(1020, power * j - 1000 + source.below(40));
      if (source.below(4) > 0)
        b[static_cast<std::size_t>(j)] = std::ldexp(source.mantissa(), exponent);
    }
    Doubles s;
    for (int q = 0; q < 9; ++q) s.push_back(std::ldexp(1.0 + source.unit(), -power + q - 4));
    const ExactValues exact(b);
    const std::vector<CertifiedValue> found = support::certified_batch(b, s);
    for (std::size_t q = 0; q < s.size(); ++q)
      ASSERT_EQ(complaint(found[q], exact(s[q])), "") << described(b, s[q]);
  }
}

// Small degrees, where the fewest errors are needed for the largest share of a bound, with values
// cancelled to just what each precision can serve.
TEST(CertifiedThresholds, SmallDegrees) {
  HardPolynomials source(32, false);
  for (int i = 0; i < 12000; ++i) {
    const int n = 1 + i % 4;
    const Hard hard = source.cancelled(n);
    Doubles s(4, hard.s);
    for (double& x : s) x *= 1.0 + std::ldexp(source.unit() - 0.5, -30 - source.below(80));
    const ExactValues exact(hard.b);
    const std::vector<CertifiedValue> found = support::certified_batch(hard.b, s);
    for (std::size_t q = 0; q < s.size(); ++q)
      ASSERT_EQ(complaint(found[q], exact(s[q])), "") << described(hard.b, s[q]);
  }
}

}  // namespace
