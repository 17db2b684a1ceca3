// Integrals, norms and ranges of bezel/field/field.hpp.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bezel/field/element_range.hpp"
#include "bezel/field/field.hpp"
#include "bezel/geometry/triangle.hpp"
#include "checks.hpp"
#include "meshes.hpp"
#include "support/exact_integrals.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using field_test::formulas;
using field_test::MeshPtr;
using field_test::message_of;

TEST(Integral, OfPolynomialsOnTheSquare) {
  // Straight mesh of [-1,1]^2: integral of x^2 y^4 = 2/3 * 2/5, odd powers vanish.
  const MeshPtr mesh = field_test::straight(3, 2);
  const auto f = formulas({"x^2*y^4 + x^3", "1", "y^5 - x^4*y^2/3"});
  for (const auto& space : {Space::discontinuous(mesh, 6), Space::continuous(mesh, 6),
                            Space::discontinuous(mesh, 6, Basis::physical)}) {
    const Field field = sample("f", space, f);
    const std::vector<double> total = integral(field);
    ASSERT_EQ(total.size(), 3u);
    EXPECT_NEAR(total[0], 4.0 / 15, 2e-15);
    EXPECT_NEAR(total[1], 4.0, 2e-15);
    EXPECT_NEAR(total[2], -4.0 / 45, 2e-15);
    const std::vector<double> parts = element_integrals(field);
    ASSERT_EQ(parts.size(), 18u * 3u);
    double sum = 0.0;
    for (std::size_t e = 0; e < 18; ++e) {
      EXPECT_NEAR(parts[3 * e + 1], 2.0 / 9, 1e-15);
      sum += parts[3 * e];
    }
    EXPECT_NEAR(sum, 4.0 / 15, 2e-15);
  }
}

TEST(Integral, OnCurvedElementsEqualsMoments) {
  // Against geometry's moments (Green's theorem), element by element.
  for (int g = 1; g <= 5; ++g) {
    const MeshPtr mesh = field_test::wavy(2, g);
    for (int d = 0; d <= Space::max_degree; ++d) {
      const int a = d / 2, b = d - a;
      const auto f = formulas({("x^" + std::to_string(a) + "*y^" + std::to_string(b)).c_str()});
      const Field field = sample("f", Space::discontinuous(mesh, d, Basis::physical), f);
      const std::vector<double> parts = element_integrals(field);
      for (std::size_t e = 0; e < parts.size(); ++e)
        EXPECT_NEAR(parts[e], moment(g, mesh->gather(ElementId(e)), a, b), 2e-15) << g << " " << d;
      if (d * g <= Space::max_degree) {
        const Field mapped = sample("f", Space::discontinuous(mesh, d * g), f);
        const std::vector<double> same = element_integrals(mapped);
        for (std::size_t e = 0; e < parts.size(); ++e)
          EXPECT_NEAR(same[e], parts[e], 4e-15) << g << " " << d;
      }
    }
  }
}

TEST(Integral, HighestDegreesInThePhysicalBasis) {
  // degree 10 on geometric degree 10: integrands of degree 118, above the table of triangle rules.
  const MeshPtr mesh = field_test::wavy(2, 10, 0.05);
  const Field field =
      sample("f", Space::discontinuous(mesh, 10, Basis::physical), formulas({"x^4*y^6"}));
  const std::vector<double> parts = element_integrals(field);
  for (std::size_t e = 0; e < parts.size(); ++e)
    EXPECT_NEAR(parts[e], moment(10, mesh->gather(ElementId(e)), 4, 6), 2e-15);
}

TEST(IntegralAbs, SignsAndPieces) {
  const MeshPtr mesh = field_test::straight(2);
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    // y changes sign between elements only, so the result is exact: 2.
    const auto f = formulas({"y", "-3 - x", "x - y/3"});
    const std::vector<double> total =
        integral_abs(sample("f", Space::discontinuous(mesh, 1, basis), f));
    EXPECT_NEAR(total[0], 2.0, 4e-15);
    EXPECT_NEAR(total[1], 12.0, 1e-14);
    // |x - y/3| over the square: 2 + 2/27 by integrating |x - a| for a = y/3: int (1 + a^2) dy.
    // Linear, so exact where it changes sign inside an element too.
    EXPECT_NEAR(total[2], 2.0 + 2.0 / 27, 4e-15);
    EXPECT_NEAR(integral_abs(sample("f", Space::discontinuous(mesh, 2, basis), f))[2],
                2.0 + 2.0 / 27, 2e-3);
  }
}

TEST(L2Norm, OfPolynomials) {
  const MeshPtr mesh = field_test::straight(2, 2);
  for (int d = 3; d <= Space::max_degree; ++d)
    for (const auto& space :
         {Space::discontinuous(mesh, d), Space::discontinuous(mesh, d, Basis::physical),
          Space::continuous(mesh, d)})
      // integral of x^6 + (1+y)^2 = 4/7 + 4 + 4/3.
      EXPECT_NEAR(l2_norm(sample("f", space, formulas({"x^3", "1+y"}))),
                  std::sqrt(4.0 / 7 + 16.0 / 3), 1e-14);
}

TEST(ErrorNorms, AgainstClosedForms) {
  // Field 0, exact x^2 + y on [-1,1]^2.
  const MeshPtr mesh = field_test::straight(2);
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    const auto space = Space::discontinuous(mesh, 2, basis);
    const Field zero("zero", space, std::vector<double>(space->coefficient_count()));
    const ErrorNorms norms = error_norms(zero, formulas({"x^2 + y"}));
    EXPECT_NEAR(norms.l2, std::sqrt(4.0 / 5 + 4.0 / 3), 4e-15);
    EXPECT_NEAR(norms.l2_relative, 1.0, 1e-15);
    EXPECT_NEAR(norms.max, 2.0, 1e-15);  // at the corners, which are lattice points
    EXPECT_NEAR(norms.h1_semi, std::sqrt(16.0 / 3 + 4.0), 4e-15);  // |(2x, 1)|^2
    EXPECT_NEAR(norms.integral, -4.0 / 3, 2e-15);
  }
}

TEST(ErrorNorms, CurvedElementsAndComponents) {
  // f - exact = (x, -2): on a curved mesh the norms follow from geometry's moments.
  const MeshPtr mesh = field_test::wavy(2, 3);
  const Field field =
      sample("f", Space::discontinuous(mesh, 2, Basis::physical), formulas({"x*y + x", "y^2 - 2"}));
  double area_total = 0.0, x1 = 0.0, x2 = 0.0;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const auto control = mesh->gather(ElementId(e));
    area_total += area(3, control);
    x1 += moment(3, control, 1, 0);
    x2 += moment(3, control, 2, 0);
  }
  const ErrorNorms norms = error_norms(field, formulas({"x*y", "y^2"}));
  EXPECT_NEAR(norms.l2, std::sqrt(x2 + 4 * area_total), 1e-14);
  EXPECT_NEAR(norms.h1_semi, std::sqrt(area_total), 2e-14);
  EXPECT_NEAR(norms.integral, x1 - 2 * area_total, 2e-14);
  EXPECT_NEAR(norms.max, 2.0, 1e-14);
}

TEST(ErrorNorms, RelativeToNothing) {
  const auto space = Space::discontinuous(field_test::straight(1), 1);
  const Field zero("zero", space, std::vector<double>(6)),
      one("one", space, std::vector<double>(6, 1.0));
  EXPECT_EQ(error_norms(zero, formulas({"0*x*y"})).l2_relative, 0.0);
  EXPECT_EQ(error_norms(one, formulas({"0*x*y"})).l2_relative,
            std::numeric_limits<double>::infinity());
}

TEST(ErrorNorms, Errors) {
  const auto space = Space::discontinuous(field_test::straight(1), 1);
  const Field field("T", space, std::vector<double>(6));
  EXPECT_EQ(message_of([&] {
              (void)error_norms(field, formulas({"x", "y"}));
            }),
            "found 2 formulas, expected one for each of the 1 components of field 'T'");
  EXPECT_EQ(message_of([&] { (void)error_norms(field, formulas({"x"}), 99); }),
            "found extra degree 99, expected 0..60");
  const std::string message = message_of([&] { (void)error_norms(field, formulas({"1/(x+1)"})); });
  EXPECT_NE(message.find("formula '1/(x+1)' is inf at x = -1"), std::string::npos) << message;
}

TEST(ValueRange, KnownExtremes) {
  const MeshPtr mesh = field_test::straight(2);
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    // x^2 + y^2 on the square: 0 at the centre (a vertex), 2 at the corners.
    const Field bowl = sample("f", Space::discontinuous(mesh, 2, basis), formulas({"x^2 + y^2"}));
    const bernstein::Range range = value_range(bowl, 0, 1e-4);
    EXPECT_LE(range.lo, 0.0);
    EXPECT_GT(range.lo, -4e-4);
    EXPECT_GE(range.hi, 2.0);
    EXPECT_LT(range.hi, 2.0 + 4e-4);
    // A bump inside one element: (1-9r^2) around (1/3, -1/3) has its maximum 1 inside an element.
    const Field bump = sample("f", Space::discontinuous(mesh, 2, basis),
                              formulas({"1 - 9*((x-0.35)^2 + (y+0.3)^2)", "7"}));
    const bernstein::Range top = value_range(bump, 0, 1e-5);
    EXPECT_GE(top.hi, 1.0);
    EXPECT_LT(top.hi, 1.0 + 1e-5 * 60);
    const bernstein::Range constant = value_range(bump, 1);
    // As wide as the stated rounding of the composition: 2 d (3 + 16) u 1.8^d 7 for a physical
    // basis.
    EXPECT_LE(constant.lo, 7.0);
    EXPECT_GE(constant.hi, 7.0);
    EXPECT_LT(constant.hi - constant.lo, 4e-13);
  }
}

TEST(ElementRange, EnclosesOneElementsValues) {
  for (const int d : {2, 8}) {  // 8 x 6 exceeds the largest degree of a composition
    const MeshPtr mesh = field_test::wavy(1, 6);
    const auto space = Space::discontinuous(mesh, d, Basis::physical);
    const Field field = sample("f", space, formulas({"x", "x^2 + y"}));
    const bernstein::Range range = element_range(field, ElementId(1), 1, 1e-3);
    double lo = 1e9;
    double hi = -1e9;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        std::array<double, 2> value{};
        field.evaluate(ElementId(1), {(40 - i - j) / 40.0, i / 40.0, j / 40.0}, value);
        lo = std::min(lo, value[1]);
        hi = std::max(hi, value[1]);
      }
    }
    EXPECT_LE(range.lo, lo);
    EXPECT_GE(range.hi, hi);
    EXPECT_GT(range.lo, lo - 0.02);  // the samples see the extremes roughly
    EXPECT_LT(range.hi, hi + 0.02);
    EXPECT_THROW((void)element_range(field, ElementId(1), 2, 0.1), InputError);
    EXPECT_THROW((void)element_range(field, ElementId(1), 0, -0.1), InputError);
    EXPECT_THROW((void)element_range(field, ElementId(99), 0, 0.1), InputError);
  }
}

TEST(ValueRange, ReferencePolynomialIsTheSamePolynomial) {
  for (const auto& [g, d] :
       std::vector<std::pair<int, int>>{{2, 3}, {3, 2}, {4, 10}, {10, 4}, {1, 10}, {5, 0}}) {
    const MeshPtr mesh = field_test::wavy(2, g);
    const auto space = Space::discontinuous(mesh, d, Basis::physical);
    std::vector<double> c(space->coefficient_count() * 2);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::sin(1.3 * static_cast<double>(i * i));
    const Field field("f", space, c, 2);
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      const ReferencePolynomial p = reference_polynomial(field, ElementId(e), 1);
      EXPECT_EQ(p.degree, d * g);
      EXPECT_LT(p.error_bound, 1e-10);
      for (const Lambda& lambda : {Lambda{0.2, 0.3, 0.5}, Lambda{0, 0.4, 0.6}, Lambda{1, 0, 0}}) {
        std::array<double, 2> value{};
        field.evaluate(ElementId(e), lambda, value);
        // Two routes with rounding each; the stated bound covers the composition.
        EXPECT_NEAR(bernstein::evaluate<double>(p.degree, p.c, lambda), value[1],
                    p.error_bound + 2e-14);
      }
    }
  }
}

TEST(ValueRange, Errors) {
  const MeshPtr mesh = field_test::wavy(2, 5);
  const auto space = Space::discontinuous(mesh, 10, Basis::physical);
  const Field field("T", space, std::vector<double>(space->coefficient_count()));
  EXPECT_EQ(message_of([&] { (void)value_range(field, 1); }),
            "component 1 does not exist, field 'T' has 1");
  EXPECT_EQ(message_of([&] { (void)value_range(field, 0, -0.5); }),
            "found relative tolerance -0.5, expected 0..1");
  EXPECT_EQ(message_of([&] { (void)reference_polynomial(field, ElementId(2), 0); }),
            "triangle 2: its polynomial has degree 10 x 5 = 50 in reference coordinates, the limit "
            "is 40");
  EXPECT_EQ(message_of([&] { (void)reference_polynomial(field, ElementId(9), 0); }),
            "triangle 9 does not exist, the mesh has 8");
}

// Along a parabola, bent by 1e5 of their widths.
TEST(Norms, OfBentElementsHaveAllTheirDigits) {
  for (const int g : {2, 3}) {
    const auto mesh = test::grid_mesh(3, g, 1.0, [](const Vec2& p) {
      return Vec2{{p[0] + 1.0, 1e-6 * p[1] + 0.3 * (1.0 - p[0] * p[0])}};
    });
    const auto space = Space::discontinuous(mesh, 2);
    std::vector<double> c(space->coefficient_count(), 1.0);
    const Field one("one", space, c);
    double exact = 0.0;
    for (std::size_t e = 0; e < mesh->element_count(); ++e)
      exact += test::exact_integrals(g, mesh->gather(ElementId(e)), 0)[0].hi;
    const double norm = l2_norm(one);
    EXPECT_NEAR(norm * norm, exact, 4e-15 * exact);
    EXPECT_NEAR(integral(one)[0], exact, 4e-15 * exact);
  }
}

}  // namespace
}  // namespace bezel
