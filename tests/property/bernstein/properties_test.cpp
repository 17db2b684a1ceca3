// Identities that hold for every input, checked on random and degenerate polynomials: zeros,
// subnormals, mixed scales, constant and alternating coefficients. A failing case prints its seed.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/bernstein/roots.hpp"
#include "bezel/bernstein/triangle.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::Vec2;
using Doubles = std::vector<double>;
using Span = std::span<const double>;
constexpr double u = 0x1p-53;

class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  /// In [0, 1], often at or next to the ends and the middle.
  double parameter() {
    switch (below(8)) {
      case 0:
        return 0.0;
      case 1:
        return 1.0;
      case 2:
        return 0.5;
      case 3:
        return unit() * 1e-17;
      case 4:
        return 1.0 - 0x1p-53;
      default:
        return unit();
    }
  }
  Doubles coefficients(int n) {
    const int kind = below(7);
    Doubles b(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < b.size(); ++i) {
      const double x = 2.0 * unit() - 1.0;
      switch (kind) {
        case 0:
          b[i] = 0.0;
          break;
        case 1:
          b[i] = std::ldexp(x, -1060);
          break;  // subnormal
        case 2:
          b[i] = std::ldexp(x, below(120) - 60);
          break;
        case 3:
          b[i] = below(3) == 0 ? x : 0.0;
          break;
        case 4:
          b[i] = i % 2 == 0 ? 1.0 : -1.0;
          break;
        case 5:
          b[i] = 1.0 + x * 1e-15;
          break;
        default:
          b[i] = x;
      }
    }
    return b;
  }
  Lambda inside() {
    double a = parameter(), b = parameter();
    if (a + b > 1.0)
      a = 1.0 - a, b = std::min(b, 1.0 - a) - std::max(0.0, a + std::min(b, 1.0 - a) - 1.0);
    return {1.0 - a - b, a, b};
  }

 private:
  std::mt19937_64 random_;
};

double max_abs(const Doubles& b) {
  double m = 0.0;
  for (const double x : b) m = std::fmax(m, std::fabs(x));
  return m;
}

// A rounding costs u times the value, or 2^-1075 when the result is subnormal.
double budget(double units, const Doubles& b) {
  return (units + 1.0) * (u * max_abs(b) + 0x1p-1074);
}
double product_budget(double units, const Doubles& a, const Doubles& b) {
  const double subnormal = 0x1p-1074 * (1.0 + max_abs(a) + max_abs(b));
  return (units + 1.0) * (u * max_abs(a) * max_abs(b) + subnormal);
}

template <class Check>
void for_many(int cases, const Check& check) {
  for (int seed = 0; seed < cases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Source source(static_cast<std::uint64_t>(seed));
    check(source);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(IntervalProperty, ValuesStayInTheCoefficientRange) {
  for_many(2000, [](Source& source) {
    const int d = source.below(61);
    const Doubles b = source.coefficients(d + 1);
    const auto [lo, hi] = std::minmax_element(b.begin(), b.end());
    const double x = evaluate(Span(b), source.parameter());
    EXPECT_GE(x, *lo - budget(3.0 * d, b));
    EXPECT_LE(x, *hi + budget(3.0 * d, b));
  });
}

TEST(IntervalProperty, SplitIsTheWhole) {
  for_many(2000, [](Source& source) {
    const int d = source.below(61);
    const Doubles b = source.coefficients(d + 1);
    const double t = source.parameter(), s = source.parameter();
    const auto [left, right] = subdivide(Span(b), t);
    EXPECT_EQ(left.front(), b.front());
    EXPECT_EQ(right.back(), b.back());
    EXPECT_EQ(left.back(), right.front());
    EXPECT_EQ(left.back(), evaluate(Span(b), t));
    // Rounding of the parameter t s moves the value by at most u |p'| <= 2 d u max|b|.
    EXPECT_NEAR(evaluate(Span(left), s), evaluate(Span(b), t * s), budget(12.0 * d, b));
  });
}

TEST(IntervalProperty, SpecializeReversedIsReversed) {
  for_many(2000, [](Source& source) {
    const int d = source.below(31);
    const Doubles b = source.coefficients(d + 1);
    const double t0 = source.parameter(), t1 = source.parameter();
    Doubles back = specialize(Span(b), t1, t0);
    const Doubles forth = specialize(Span(b), t0, t1);
    std::reverse(back.begin(), back.end());
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(back[i], forth[i], budget(6.0 * d, b));
    EXPECT_EQ(forth.front(), evaluate(Span(b), t0));
    EXPECT_EQ(forth.back(), evaluate(Span(b), t1));
    EXPECT_EQ(forth.front(), back.front());
    EXPECT_EQ(specialize(Span(b), 0.0, 1.0), b);
    Doubles mirror = specialize(Span(b), 1.0, 0.0);
    std::reverse(mirror.begin(), mirror.end());
    EXPECT_EQ(mirror, b);
  });
}

TEST(IntervalProperty, ElevateThenEvaluate) {
  for_many(2000, [](Source& source) {
    const int d = source.below(50), by = source.below(11);
    const Doubles b = source.coefficients(d + 1);
    const double s = source.parameter();
    const Doubles raised = elevate(Span(b), by);
    EXPECT_NEAR(evaluate(Span(raised), s), evaluate(Span(b), s),
                budget(4.0 * by + 6.0 * (d + by), b));
    const Doubles back = reduce(Span(raised), by);
    for (std::size_t i = 0; i < b.size(); ++i)
      EXPECT_NEAR(back[i], b[i], budget(4.0 * by * (d + by + 2.0) * (by + 1.0), b));
  });
}

TEST(IntervalProperty, ProductRule) {
  for_many(1000, [](Source& source) {
    const int da = 1 + source.below(20), db = 1 + source.below(20);
    const Doubles a = source.coefficients(da + 1), b = source.coefficients(db + 1);
    const double s = source.parameter();
    const double left = evaluate_derivative(Span(multiply(a, b)), s);
    const double right = evaluate_derivative(Span(a), s) * evaluate(Span(b), s) +
                         evaluate(Span(a), s) * evaluate_derivative(Span(b), s);
    const double d = da + db;
    EXPECT_NEAR(left, right, product_budget(20.0 * d * d, a, b));
  });
}

TEST(IntervalProperty, IntegralOfThePartsIsTheIntegral) {
  for_many(1000, [](Source& source) {
    const int d = source.below(60);
    const Doubles b = source.coefficients(d + 1);
    const double t = source.parameter();
    const auto [left, right] = subdivide(Span(b), t);
    EXPECT_NEAR(t * integral(left) + (1.0 - t) * integral(right), integral(b),
                budget(3.0 * d + 4.0, b));
    EXPECT_NEAR(evaluate(Span(antiderivative(b)), t), t * integral(left), budget(6.0 * d + 6.0, b));
  });
}

TEST(IntervalProperty, BasisSumsToOneAndIsSymmetric) {
  for_many(1000, [](Source& source) {
    const int d = source.below(61);
    const double s = 0x1p-30 * source.below(1 << 30);  // 1 - s is exact
    Doubles out(static_cast<std::size_t>(d + 1)), mirror(out.size());
    basis(d, s, out);
    basis(d, 1.0 - s, mirror);
    double sum = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      sum += out[i];
      EXPECT_NEAR(out[i], mirror[out.size() - 1 - i], 4.0 * (d + 2.0) * u * out[i]);
      EXPECT_GE(out[i], 0.0);
    }
    EXPECT_NEAR(sum, 1.0, (4.0 * d + 4.0) * u);
  });
}

TEST(IntervalProperty, RangeEnclosesAndRootsLieWhereSignsChange) {
  for_many(600, [](Source& source) {
    const int d = source.below(25);
    const Doubles b = source.coefficients(d + 1);
    if (max_abs(b) == 0.0) return;
    const double tol = std::ldexp(max_abs(b), -source.below(40));
    const Range outer = range(b), inner = range(b, tol);
    EXPECT_LE(outer.lo, inner.lo);
    EXPECT_GE(outer.hi, inner.hi);
    double lo = b.front(), hi = b.front();
    for (int i = 0; i <= 200; ++i) {
      const double x = evaluate(Span(b), i / 200.0);
      EXPECT_GE(x, inner.lo - budget(3.0 * d, b));
      EXPECT_LE(x, inner.hi + budget(3.0 * d, b));
      lo = std::fmin(lo, x);
      hi = std::fmax(hi, x);
    }
    const auto found = roots(b);
    EXPECT_LE(static_cast<int>(found.size()), d);
    // Between neighbouring samples of certain, opposite sign there is a root.
    for (int i = 0; i < 200; ++i) {
      const double s0 = i / 200.0, s1 = (i + 1) / 200.0;
      const double x0 = evaluate(Span(b), s0), x1 = evaluate(Span(b), s1);
      const double noise = budget(3.0 * d + 1.0, b);
      if (std::fabs(x0) <= noise || std::fabs(x1) <= noise || (x0 > 0) == (x1 > 0)) continue;
      const bool covered = std::any_of(found.begin(), found.end(),
                                       [&](const Root& r) { return r.hi >= s0 && r.lo <= s1; });
      EXPECT_TRUE(covered) << s0;
    }
    for (const Root& root : found) {
      EXPECT_LE(root.lo, root.s);
      EXPECT_LE(root.s, root.hi);
      EXPECT_LE(std::fabs(evaluate(Span(b), root.s)),
                budget(3.0 * d + 2.0 * d, b) + (root.hi - root.lo) * 2.0 * d * max_abs(b));
    }
  });
}

TEST(TriangleProperty, ChildrenAgreeOnSharedSidesBitForBit) {
  for_many(400, [](Source& source) {
    const int d = source.below(13);
    const Doubles b = source.coefficients(triangle_size(d));
    const auto child = subdivide(d, Span(b));
    for (int c = 0; c < 3; ++c) {
      // Child c meets the middle child along the child's side opposite corner c; the middle child
      // runs through the same points the other way: its side opposite its corner c.
      Doubles own = side(d, Span(child[static_cast<std::size_t>(c)]), (c + 1) % 3);
      const Doubles middle = side(d, Span(child[3]), (c + 1) % 3);
      std::reverse(own.begin(), own.end());
      EXPECT_EQ(own, middle) << c;
    }
    // The outer sides are the halves of the parent's sides, and depend on nothing else.
    for (int e = 0; e < 3; ++e) {
      const Doubles along = side(d, Span(b), e);
      const auto [first, second] = subdivide(Span(along), 0.5);
      EXPECT_EQ(side(d, Span(child[static_cast<std::size_t>(e)]), e), first);
      EXPECT_EQ(side(d, Span(child[static_cast<std::size_t>((e + 1) % 3)]), e), second);
    }
  });
}

TEST(TriangleProperty, ChildrenAreTheWhole) {
  for_many(400, [](Source& source) {
    const int d = source.below(13);
    const Doubles b = source.coefficients(triangle_size(d));
    const auto child = subdivide(d, Span(b));
    const Lambda x = source.inside();
    const Lambda in_first{x[0] + 0.5 * (x[1] + x[2]), 0.5 * x[1], 0.5 * x[2]};
    EXPECT_NEAR(evaluate(d, Span(child[0]), x), evaluate(d, Span(b), in_first),
                budget(12.0 * d, b));
    const Lambda in_middle{0.5 * (x[1] + x[2]), 0.5 * (x[0] + x[2]), 0.5 * (x[0] + x[1])};
    EXPECT_NEAR(evaluate(d, Span(child[3]), x), evaluate(d, Span(b), in_middle),
                budget(12.0 * d, b));
    double total = 0.0;
    for (const Doubles& c : child) total += 0.25 * integral(d, c);
    EXPECT_NEAR(total, integral(d, b), budget(d + 4.0, b));
  });
}

TEST(TriangleProperty, SidesAreTheCurves) {
  for_many(1000, [](Source& source) {
    const int d = source.below(41);
    const Doubles b = source.coefficients(triangle_size(d));
    const double s = source.parameter(), r = 1.0 - s;
    const std::array<Lambda, 3> x{{{r, s, 0.0}, {0.0, r, s}, {s, 0.0, r}}};
    for (int e = 0; e < 3; ++e)
      EXPECT_NEAR(evaluate(d, Span(b), x[static_cast<std::size_t>(e)]),
                  evaluate(Span(side(d, Span(b), e)), s), budget(6.0 * d, b));
  });
}

TEST(TriangleProperty, ElevateThenEvaluate) {
  for_many(500, [](Source& source) {
    const int d = source.below(20), by = source.below(6);
    const Doubles b = source.coefficients(triangle_size(d));
    const Lambda x = source.inside();
    const Doubles raised = elevate(d, Span(b), by);
    EXPECT_NEAR(evaluate(d + by, Span(raised), x), evaluate(d, Span(b), x),
                budget(5.0 * by + 6.0 * (d + by), b));
    const Doubles back = reduce(d + by, Span(raised), by);
    for (std::size_t n = 0; n < b.size(); ++n)
      EXPECT_NEAR(back[n], b[n], budget(5.0 * by * (d + by + 2.0) * (by + 1.0), b));
  });
}

TEST(TriangleProperty, ProductOfValuesAndMassMatrixForm) {
  for_many(300, [](Source& source) {
    const int d = source.below(9);
    const Doubles a = source.coefficients(triangle_size(d)),
                  b = source.coefficients(triangle_size(d));
    const Lambda x = source.inside();
    const Doubles product = multiply(d, a, d, b);
    const double n = triangle_size(d);
    EXPECT_NEAR(evaluate(2 * d, Span(product), x),
                evaluate(d, Span(a), x) * evaluate(d, Span(b), x),
                product_budget(12.0 * d + n + 12.0, a, b));
    const Doubles mass = mass_matrix(d);
    double form = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < a.size(); ++j) form += a[i] * mass[i * a.size() + j] * b[j];
    EXPECT_NEAR(form, integral(2 * d, product), product_budget(n * n + n + 20.0, a, b));
  });
}

// Points are transformed coordinate by coordinate with the same bits as scalars.
TEST(TriangleProperty, PointsAreTheirCoordinates) {
  for_many(300, [](Source& source) {
    const int d = source.below(15);
    const Doubles x = source.coefficients(triangle_size(d)),
                  y = source.coefficients(triangle_size(d));
    std::vector<Vec2> p;
    for (std::size_t n = 0; n < x.size(); ++n) p.push_back({{x[n], y[n]}});
    const Lambda at = source.inside();
    const auto value = evaluate_gradient(d, std::span<const Vec2>(p), at);
    const auto vx = evaluate_gradient(d, Span(x), at), vy = evaluate_gradient(d, Span(y), at);
    EXPECT_EQ(value.value, (Vec2{{vx.value, vy.value}}));
    EXPECT_EQ(value.du, (Vec2{{vx.du, vy.du}}));
    EXPECT_EQ(value.dv, (Vec2{{vx.dv, vy.dv}}));
    EXPECT_EQ(value.value, evaluate(d, std::span<const Vec2>(p), at));
    const auto children = subdivide(d, std::span<const Vec2>(p));
    const auto children_x = subdivide(d, Span(x));
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t n = 0; n < x.size(); ++n) EXPECT_EQ(children[c][n][0], children_x[c][n]);
  });
}

TEST(TriangleProperty, RangeEncloses) {
  for_many(200, [](Source& source) {
    const int d = source.below(10);
    const Doubles b = source.coefficients(triangle_size(d));
    const double tol = std::ldexp(max_abs(b), -source.below(20));
    const Range outer = range(d, b), inner = range(d, b, tol);
    EXPECT_LE(outer.lo, inner.lo);
    EXPECT_GE(outer.hi, inner.hi);
    for (int i = 0; i < 100; ++i) {
      const double x = evaluate(d, Span(b), source.inside());
      EXPECT_GE(x, inner.lo - budget(3.0 * d + 8.0, b));
      EXPECT_LE(x, inner.hi + budget(3.0 * d + 8.0, b));
    }
  });
}

}  // namespace
