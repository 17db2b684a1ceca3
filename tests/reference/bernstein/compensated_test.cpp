// Compensated evaluation against tests/reference/data/compensated: every level and value, bit for
// bit, on the scalar path and on every SIMD target.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "exact.hpp"
#include "support/simd_targets.hpp"

namespace {

using namespace bezel::bernstein;
using exact::Rational;
using nlohmann::json;
using Doubles = std::vector<double>;

json load(const std::string& name) {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/" + name);
  EXPECT_TRUE(in.good()) << name;
  return json::parse(in);
}

double hex(const json& j) {
  return std::strtod(j.get<std::string>().c_str(), nullptr);
}
Doubles hexes(const json& j) {
  Doubles out;
  for (const json& x : j) out.push_back(hex(x));
  return out;
}

void expect_same_bits(double found, double expected) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected))
      << found << " " << expected;
}

class Points : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const json data = load(GetParam());
    b = hexes(data.at("bernstein_coefficients"));
    for (const json& point : data.at("points")) {
      s.push_back(hex(point.at("s")));
      levels.push_back(hexes(point.at("levels")));
      Doubles values;
      for (const char* K : {"1", "2", "3", "4"}) values.push_back(hex(point.at("value").at(K)));
      value.push_back(values);
      exact_value.emplace_back(point.at("p_exact").get<std::string>());
      absolute.emplace_back(point.at("p_tilde_exact").get<std::string>());
      rounded.push_back(hex(point.at("p_rounded")));
      cond.push_back(hex(point.at("cond")));
    }
  }
  Doubles b, s, rounded, cond;
  std::vector<Doubles> levels, value;
  std::vector<Rational> exact_value, absolute;
};

TEST_P(Points, LevelsAndValuesOfTheScalarKernel) {
  for (std::size_t q = 0; q < s.size(); ++q) {
    SCOPED_TRACE(s[q]);
    Doubles found(4);
    compensated_levels(b, s[q], found);
    for (std::size_t f = 0; f < 4; ++f) expect_same_bits(found[f], levels[q][f]);
    for (int K = 1; K <= 4; ++K) {
      SCOPED_TRACE(K);
      // Level F does not depend on K.
      Doubles fewer(static_cast<std::size_t>(K));
      compensated_levels(b, s[q], fewer);
      for (std::size_t f = 0; f < fewer.size(); ++f) expect_same_bits(fewer[f], levels[q][f]);
      expect_same_bits(evaluate_compensated(std::span<const double>(b), s[q], K),
                       value[q][static_cast<std::size_t>(K) - 1]);
    }
  }
}

TEST_P(Points, ValuesOnEveryTarget) {
  support::on_every_target([&] {
    for (int K = 1; K <= 4; ++K) {
      SCOPED_TRACE(K);
      Doubles out(s.size());
      evaluate_compensated(b, s, out, K);
      for (std::size_t q = 0; q < s.size(); ++q)
        expect_same_bits(out[q], value[q][static_cast<std::size_t>(K) - 1]);
      // One point alone takes another way through the vector code than a batch.
      expect_same_bits(evaluate_compensated(std::span<const double>(b), s[0], K),
                       value[0][static_cast<std::size_t>(K) - 1]);
    }
  });
}

TEST_P(Points, ConditionNumbers) {
  for (std::size_t q = 0; q < s.size(); ++q) {
    const double within = 4 * 10 * 0x1p-53;
    EXPECT_NEAR(absolute_value_sum(b, s[q]) / absolute[q].get_d(), 1.0, within);
    if (std::isfinite(cond[q]))
      EXPECT_NEAR(condition_number(b, s[q]) / cond[q], 1.0, within);
    else
      EXPECT_EQ(condition_number(b, s[q]), cond[q]);
  }
}

TEST_P(Points, CertifiedValuesAreFaithful) {
  for (std::size_t q = 0; q < s.size(); ++q) {
    const CertifiedValue p = evaluate_certified(b, s[q]);
    EXPECT_LE(abs(Rational(p.value) - exact_value[q]), Rational(p.error_bound));
    EXPECT_TRUE(p.value == rounded[q] || p.value == std::nextafter(rounded[q], HUGE_VAL) ||
                p.value == std::nextafter(rounded[q], -HUGE_VAL));
    EXPECT_EQ(p.value == 0.0, exact_value[q] == 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Reference, Points,
                         testing::Values("eval_p4_fig5_4.json", "eval_p8_fig5_6.json",
                                         "eval_p8_geometric.json", "eval_p8_jlcs10.json"),
                         [](const auto& test) {
                           const std::string name = test.param;
                           return name.substr(0, name.find('.'));
                         });

// Table 5.1: both levels of every intermediate coefficient, and what they miss, exactly.
TEST(CompensatedReference, Table51) {
  const json table = load("table5_1.json");
  const double s = hex(table.at("s"));
  const Doubles b = hexes(table.at("coefficients"));
  const int d = static_cast<int>(b.size()) - 1;
  Doubles w;
  for (const double c : b) w.insert(w.end(), {c, 0.0});
  std::vector<Rational> exact(b.begin(), b.end());
  const Rational t(s), r = 1 - t;
  const bezel::WithError split = bezel::two_sum(1.0, -s);
  std::size_t row = 0;
  for (int k = d - 1; k >= 0; --k)
    for (int j = 0; j <= k; ++j) {
      const auto at = static_cast<std::size_t>(j);
      exact[at] = r * exact[at] + t * exact[at + 1];
      kernel::compensated_update(&w[2 * at], &w[2 * at + 2], split.value, split.error, s, 2);
      const json& expected = table.at("rows").at(row++);
      ASSERT_EQ(expected.at("k").get<int>(), k);
      ASSERT_EQ(expected.at("j").get<int>(), j);
      expect_same_bits(w[2 * at], hex(expected.at("b")));
      expect_same_bits(w[2 * at + 1], hex(expected.at("db")));
      EXPECT_EQ(Rational(exact[at] - Rational(w[2 * at]) - Rational(w[2 * at + 1])),
                Rational(expected.at("remainder_exact").get<std::string>()));
    }
  EXPECT_EQ(row, table.at("rows").size());
}

TEST(CompensatedReference, Multipliers) {
  const json data = load("multipliers.json");
  int tested = 0;
  for (const auto& [K, entry] : data.items()) {
    const json& values = entry.at("values_n0_to_40");
    for (std::size_t n = 0; n < values.size(); ++n, ++tested)
      EXPECT_EQ(error_multiplier(static_cast<int>(n), std::stoi(K)),
                Rational(values[n].get<std::string>()).get_d());
  }
  EXPECT_GE(tested, 4 * 41);
}

}  // namespace
