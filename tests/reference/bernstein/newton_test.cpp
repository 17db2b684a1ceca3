// Newton's method against tests/reference/data/compensated/newton_roots.json: the family
// (1-5s)^n + 2^30 (1-3s)^n, whose root's condition grows from 1 to 2e44.

#include "bezel/bernstein/newton.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/newton_kernel.hpp"
#include "bezel/bernstein/roots.hpp"
#include "exact.hpp"

namespace {

using namespace bezel::bernstein;
using exact::Rational;
using nlohmann::json;
using Doubles = std::vector<double>;

constexpr double u = 0x1p-53;

double hex(const json& j) {
  return std::strtod(j.get<std::string>().c_str(), nullptr);
}

/// "0.333..." exactly.
Rational decimal(const std::string& text) {
  const std::size_t point = text.find('.');
  Rational value(text.substr(0, point) + text.substr(point + 1), 10);
  for (std::size_t i = point + 1; i < text.size(); ++i) value /= 10;
  return value;
}

struct Row {
  int n;
  Rational alpha;
  double rounded, kappa;
  Doubles b;
  json expected;
};

std::vector<Row> rows() {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/newton_roots.json");
  EXPECT_TRUE(in.good());
  const json data = json::parse(in);
  std::vector<Row> out;
  for (const json& row : data.at("rows")) {
    Doubles b;
    for (const json& c : row.at("b")) b.push_back(hex(c));
    out.push_back({row.at("n").get<int>(), decimal(row.at("alpha").get<std::string>()),
                   hex(row.at("alpha_rounded")), row.at("kappa").get<double>(), b, row});
  }
  EXPECT_EQ(out.size(), 31U);
  return out;
}

struct Form {
  const char* name;
  NewtonForm form;
};
constexpr Form forms[] = {{"basic", NewtonForm::basic},
                          {"accurate", NewtonForm::accurate},
                          {"full", NewtonForm::full},
                          {"full3", NewtonForm::triple}};

double relative_error(double s, const Rational& alpha) {
  return exact::distance(s, alpha) / alpha.get_d();
}

void expect_same(const NewtonRoot& found, const json& expected) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(found.s),
            std::bit_cast<std::uint64_t>(hex(expected.at("root"))));
  EXPECT_EQ(found.iterations, expected.at("iters").get<int>());
  const std::string stop = expected.at("stop").get<std::string>();
  EXPECT_EQ(found.stop, stop == "tol"    ? NewtonStop::small_step
                        : stop == "max"  ? NewtonStop::max_iterations
                        : stop == "div0" ? NewtonStop::zero_derivative
                                         : NewtonStop::not_finite);
  EXPECT_EQ(found.history.size(), static_cast<std::size_t>(found.iterations) + 1);
  EXPECT_EQ(found.history.front(), 0.5);
  EXPECT_EQ(found.history.back(), found.s);
}

TEST(NewtonReference, EveryFormGivesTheExpectedBits) {
  for (const Row& row : rows())
    for (const Form& form : forms) {
      SCOPED_TRACE(std::string(form.name) + " n = " + std::to_string(row.n));
      const json& expected = row.expected.at(form.name);
      // The file goes to degree 61, one beyond the checked functions.
      if (row.n > max_interval_degree) {
        EXPECT_THROW(newton_root(row.b, 0.5, form.form), bezel::InputError);
        expect_same(kernel::newton_root(row.n, row.b.data(), 0.5, form.form, {}), expected);
      } else {
        expect_same(newton_root(row.b, 0.5, form.form), expected);
      }
    }
}

TEST(NewtonReference, ConditionOfTheRoot) {
  for (const Row& row : rows()) {
    if (row.n > max_interval_degree) continue;
    // At the rounded root instead of the root: p'' alpha u / p' of it, about n^2 u kappa^(1/n) ...
    // far below the accuracy of root_condition, 2^-20.
    EXPECT_NEAR(root_condition(row.b, row.rounded) / row.kappa, 1.0, 0x1p-20) << row.n;
  }
}

// What the forms promise, with the constants of the error bounds: with values known to
// m_K u^K p~ (m_K = error_multiplier) the root is known to kappa m_K u^K and the rounding of the
// last steps, 2 u.
TEST(NewtonReference, HowFarEachFormCarries) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.n);
    if (row.n > max_interval_degree) continue;
    const auto error = [&](NewtonForm form) {
      return relative_error(newton_root(row.b, 0.5, form).s, row.alpha);
    };
    const double m1 = error_multiplier(row.n, 1), m2 = error_multiplier(row.n, 2),
                 m3 = error_multiplier(row.n, 3);
    if (row.kappa * m1 * u < 0.1) {
      EXPECT_LE(error(NewtonForm::basic), 2 * u + row.kappa * m1 * u);
    }
    if (row.kappa * u < 0.1) {
      EXPECT_LE(error(NewtonForm::accurate), 2 * u + row.kappa * m2 * u * u);
    }
    if (row.kappa * m2 * u * u < 0.1) {
      EXPECT_LE(error(NewtonForm::full), 2 * u + row.kappa * m2 * u * u);
    }
    if (row.kappa * u * u < 0.1) {
      EXPECT_LE(error(NewtonForm::triple), 2 * u + row.kappa * m3 * u * u * u);
    }
    // And where they collapse: nothing but the precision of the values is to blame.
    if (row.kappa * u > 10) {
      EXPECT_GT(error(NewtonForm::basic), 1e-2);
      EXPECT_GT(error(NewtonForm::accurate), 1e-5);
    }
    if (row.kappa * u * u > 1e-8) {
      EXPECT_GT(error(NewtonForm::full), 1e3 * u);
    }
  }
}

// Never a stress test: de Casteljau is anomalously accurate on [(1-s) - 2^t s]^n, because every
// intermediate coefficient is the value times a power of two, up to rounding. The condition at
// s near the root 1 / (1 + 2^t) is huge, the error is not.
TEST(NewtonReference, FalseStart) {
  for (const int t : {1, 3})
    for (const int n : {5, 15, 25}) {
      SCOPED_TRACE(std::to_string(t) + " " + std::to_string(n));
      Doubles b;
      for (int j = 0; j <= n; ++j) b.push_back((j % 2 == 0 ? 1.0 : -1.0) * std::ldexp(1.0, t * j));
      const double root = 1.0 / (1.0 + std::ldexp(1.0, t));
      double worst = 0.0, least_condition = INFINITY;
      for (int i = 1; i <= 20; ++i) {
        const double s = root * (1.0 + i * 0x1p-12);
        const std::vector<Rational> c = exact::rationals(b);
        const Rational value = kernel::evaluate_unchecked(n, c.data(), Rational(s));
        const double found = evaluate(std::span<const double>(b), s);
        worst = std::fmax(worst, exact::distance(found, value) / std::fabs(value.get_d()));
        least_condition = std::fmin(least_condition, condition_number(b, s));
      }
      // Every level multiplies by the same factor (1-s) - 2^t s, which two roundings of terms
      // near 2/3 leave with a relative error of about u 2^12 per level.
      EXPECT_LE(worst, 4 * n * u * 0x1p12);
      EXPECT_GT(least_condition * u, 1e2 * worst);
    }
}

}  // namespace
