// roots() against an independent exact count (Sturm) and exact signs.

#include "bezel/bernstein/roots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "bezel/bernstein/interval.hpp"
#include "exact.hpp"
#include "sturm.hpp"

namespace {

using namespace bezel::bernstein;
using exact::Rational;
using exact::sign_at;
using exact::Sturm;
using Doubles = std::vector<double>;

/// Everything that roots.hpp promises, checked exactly.
void expect_right(const Doubles& b, const std::vector<Root>& found) {
  const Sturm sturm(b);
  const exact::Integers& p = sturm.polynomial();
  const int distinct = (sign_at(p, 0) == 0 ? 1 : 0) + sturm.count(0, 1);
  int least = 0, most = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Root& root = found[i];
    SCOPED_TRACE(root.s);
    const Rational lo(root.lo), hi(root.hi);
    EXPECT_LE(0.0, root.lo);
    EXPECT_LE(root.hi, 1.0);
    EXPECT_LE(root.lo, root.s);
    EXPECT_LE(root.s, root.hi);
    EXPECT_EQ(root.multiple, root.min_multiplicity != 1 || root.max_multiplicity != 1);
    EXPECT_LE(root.min_multiplicity, root.max_multiplicity);
    EXPECT_EQ((root.max_multiplicity - root.min_multiplicity) % 2, 0);
    if (i > 0) {
      const Root& before = found[i - 1];
      EXPECT_TRUE(before.hi <= root.lo || (before.lo == root.lo && before.s <= root.s));
    }
    if (root.lo == root.hi) {
      exact::Integers q = p;
      int multiplicity = 0;
      for (; !q.empty() && sign_at(q, lo) == 0; q = exact::derivative(q)) ++multiplicity;
      EXPECT_EQ(multiplicity, root.min_multiplicity);
      EXPECT_EQ(multiplicity, root.max_multiplicity);
      ++least;
      ++most;
      continue;
    }
    EXPECT_EQ(root.hi, std::nextafter(root.lo, 2.0));
    int sharing = 0, sharing_least = 0, sharing_most = 0;
    for (const Root& other : found)
      if (other.lo == root.lo && other.hi == root.hi) {
        ++sharing;
        sharing_least += std::min(other.min_multiplicity, 1);
        sharing_most += other.max_multiplicity;
      }
    const int inside = sturm.count(lo, hi) - (sign_at(p, hi) == 0 ? 1 : 0);
    EXPECT_GE(inside, sharing_least);
    EXPECT_LE(inside, sharing_most);
    if (!root.multiple) {
      if (sharing == 1) {
        const Rational middle = (lo + hi) / 2;
        const int below = sturm.count(lo, middle), at = sign_at(p, middle) == 0 ? 1 : 0;
        EXPECT_EQ(inside, 1);
        if (at == 0) {
          EXPECT_EQ(root.s, below == 1 ? root.lo : root.hi);
        }
      }
    }
    least += std::min(root.min_multiplicity, 1);
    most += root.max_multiplicity;
  }
  EXPECT_GE(distinct, least);
  EXPECT_LE(distinct, most);
}

Doubles with_roots(const Doubles& r) {
  Doubles b{1.0};
  for (const double x : r) b = multiply(b, Doubles{-x, 1.0 - x});
  return b;
}

TEST(RootsReference, RandomCoefficients) {
  std::mt19937_64 random(1);
  for (int d = 1; d <= max_interval_degree; d += d < 24 ? 1 : 6)
    for (int i = 0; i < (d <= 18 ? 10 : 2); ++i) {
      SCOPED_TRACE(d);
      Doubles b = exact::random_doubles(d + 1, random);
      if (exact::max_abs(b) == 0.0) continue;
      const std::vector<Root> found = roots(b);
      expect_right(b, found);
      for (const Root& root : found)
        if (root.s > 0.0 && root.s < 1.0) {
          EXPECT_FALSE(root.multiple);
        }
    }
}

// Small integers make many zeros at split points, multiple roots and near misses.
TEST(RootsReference, SmallIntegerCoefficients) {
  std::mt19937_64 random(4);
  int multiple = 0;
  for (int i = 0; i < 800; ++i) {
    const int d = 1 + static_cast<int>(random() % 12), range = 1 + static_cast<int>(random() % 4);
    Doubles b;
    for (int j = 0; j <= d; ++j)
      b.push_back(static_cast<double>(
          static_cast<int>(random() % (2U * static_cast<unsigned>(range) + 1U)) - range));
    if (exact::max_abs(b) == 0.0) continue;
    // Squares and cubes of them.
    const Doubles factor = b;
    for (std::uint64_t power = random() % 3; power > 0; --power) b = multiply(b, factor);
    const std::vector<Root> found = roots(b);
    expect_right(b, found);
    for (const Root& root : found) multiple += root.multiple ? 1 : 0;
    if (HasFailure()) {
      for (const double c : b) std::printf("%a ", c);
      std::printf("\n");
      break;
    }
  }
  EXPECT_GT(multiple, 100);
}

// Products of factors k s - l with rational roots l / k, rounded to doubles: their roots move, and
// many leave the real axis at high degrees.
TEST(RootsReference, ProductsWithRationalRoots) {
  std::mt19937_64 random(2);
  for (int d = 1; d <= max_interval_degree; d += d < 24 ? 1 : 6)
    for (int i = 0; i < (d <= 18 ? 8 : 2); ++i) {
      SCOPED_TRACE(d);
      // Exactly: scaled Bernstein coefficients of the product, each factor (k - l) s - l (1 - s).
      std::vector<Rational> c{Rational(1)};
      for (int f = 0; f < d; ++f) {
        const int k = 2 + static_cast<int>(random() % 30), l = static_cast<int>(random()) % (k + 1);
        std::vector<Rational> next(c.size() + 1);
        for (std::size_t j = 0; j < c.size(); ++j) {
          next[j] -= l * c[j];
          next[j + 1] += (k - l) * c[j];
        }
        c = std::move(next);
      }
      Doubles b;
      Rational binomial = 1;
      for (int j = 0; j <= d; ++j) {
        b.push_back(Rational(c[static_cast<std::size_t>(j)] / binomial).get_d());
        binomial = binomial * (d - j) / (j + 1);
      }
      if (exact::max_abs(b) == 0.0) continue;
      expect_right(b, roots(b));
    }
}

// Small degrees and denominators, scaled so that all coefficients are exact: the roots are known.
TEST(RootsReference, RationalRootsOfExactPolynomials) {
  std::mt19937_64 random(3);
  int tested = 0;
  for (int i = 0; i < 400; ++i) {
    const int d = 1 + static_cast<int>(random() % 8);
    std::vector<Rational> c{Rational(1)};
    std::multiset<Rational> expected;
    for (int f = 0; f < d; ++f) {
      const int k = 2 + static_cast<int>(random() % 9), l = static_cast<int>(random() % 11);
      std::vector<Rational> next(c.size() + 1);
      for (std::size_t j = 0; j < c.size(); ++j) {
        next[j] -= l * c[j];
        next[j + 1] += (k - l) * c[j];
      }
      c = std::move(next);
      Rational root(l, k);
      root.canonicalize();
      if (root <= 1) expected.insert(root);
    }
    Doubles b;
    Rational binomial = 1;
    bool all_exact = true;
    for (int j = 0; j <= d; ++j) {
      const Rational x = c[static_cast<std::size_t>(j)] * 840 / binomial;  // lcm of C(8, j)
      b.push_back(x.get_d());
      all_exact = all_exact && Rational(b.back()) == x;
      binomial = binomial * (d - j) / (j + 1);
    }
    if (!all_exact) continue;
    ++tested;
    const std::vector<Root> found = roots(b);
    expect_right(b, found);
    // Every expected root in its Root, with its multiplicity.
    std::size_t at = 0;
    for (auto it = expected.begin(); it != expected.end(); it = expected.upper_bound(*it), ++at) {
      ASSERT_LT(at, found.size());
      const int multiplicity = static_cast<int>(expected.count(*it));
      EXPECT_LE(Rational(found[at].lo), *it);
      EXPECT_GE(Rational(found[at].hi), *it);
      EXPECT_LE(found[at].min_multiplicity, multiplicity);
      EXPECT_EQ(found[at].max_multiplicity, multiplicity);
      EXPECT_EQ(found[at].lo == found[at].hi, Rational(it->get_d()) == *it);
      if (found[at].lo == found[at].hi) {
        EXPECT_EQ(found[at].min_multiplicity, multiplicity);
      }
      EXPECT_EQ(found[at].multiple, multiplicity != 1);
    }
    EXPECT_EQ(at, found.size());
  }
  EXPECT_GT(tested, 200);
}

TEST(RootsReference, WilkinsonAndChebyshev) {
  for (const int d : {20, 60}) {
    SCOPED_TRACE(d);
    Doubles r;
    for (int i = 1; i <= d; ++i) r.push_back(i / (d + 1.0));
    const Doubles b = with_roots(r);
    const std::vector<Root> found = roots(b);
    expect_right(b, found);
    if (d == 20) {
      EXPECT_EQ(found.size(), 20U);
    }
    // T_d (2s - 1): coefficients (-1)^(d-j) C(2d, 2j) / C(d, j).
    Doubles chebyshev;
    Rational x(1);
    for (int j = 0; j <= d; ++j) {
      chebyshev.push_back(((d - j) % 2 == 0 ? 1.0 : -1.0) * x.get_d());
      x *= Rational((2 * d - 2 * j) * (2 * d - 2 * j - 1), (2 * j + 1) * (2 * j + 2));
      x *= Rational(j + 1, d > j ? d - j : 1);
    }
    const std::vector<Root> nodes = roots(chebyshev);
    expect_right(chebyshev, nodes);
  }
}

// (1-5s)^n + 2^30 (1-3s)^n: one real root, as ill-conditioned as 1e43.
TEST(RootsReference, IllConditionedSimpleRoots) {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/newton_roots.json");
  ASSERT_TRUE(in.good());
  const nlohmann::json data = nlohmann::json::parse(in);
  int tested = 0;
  for (const nlohmann::json& row : data.at("rows")) {
    const int n = row.at("n").get<int>();
    if (n > max_interval_degree) continue;
    SCOPED_TRACE(n);
    Doubles b;
    for (const auto& c : row.at("b"))
      b.push_back(std::strtod(c.get<std::string>().c_str(), nullptr));
    const std::vector<Root> found = roots(b);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].multiple);
    EXPECT_EQ(found[0].s, std::strtod(row.at("alpha_rounded").get<std::string>().c_str(), nullptr));
    EXPECT_EQ(found[0].hi, std::nextafter(found[0].lo, 2.0));
    EXPECT_NEAR(found[0].condition / row.at("kappa").get<double>(), 1.0, 0x1p-20);
    if (n <= 31) expect_right(b, found);
    ++tested;
  }
  EXPECT_EQ(tested, 30);
}

}  // namespace
