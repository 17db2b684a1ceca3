// Fields continued beyond the donor mesh, by good elements and by slivers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bezel/transfer/operator.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::grid_mesh;
using test::one;

constexpr std::array<Basis, 2> bases = {Basis::physical, Basis::reference};

/// [-1, 1]^2 with a last column of triangles of the given width; 0.5 is that of all others.
std::shared_ptr<const TriangleMesh> with_last_column(int g, double width) {
  return grid_mesh(4, g, 1.0, [width](const Vec2& p) {
    const double x =
        p[0] <= 0.5 ? -1.0 + (p[0] + 1.0) * (2.0 - width) / 1.5 : 1.0 - (1.0 - p[0]) * 2.0 * width;
    return Vec2{{x, p[1] + 0.05 * std::sin(3.0 * p[0])}};
  });
}

/// Reaches 0.4 beyond it.
std::shared_ptr<const TriangleMesh> beyond(int g) {
  return grid_mesh(4, g, 1.0, [](const Vec2& p) {
    return Vec2{{1.0 + (p[0] > 0.0 ? 0.4 : 1.0) * p[0], 0.8 * p[1]}};
  });
}

Field constant_field(const std::shared_ptr<const Space>& space) {
  return Field("constant", space, std::vector<double>(space->coefficient_count(), 3.25));
}

TransferOptions extending() {
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  return options;
}

class Extension : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, Extension, ::testing::Values(1, 2, 3, 5, 8));

TEST_P(Extension, ConstantsStayConstantWhateverTheDonor) {
  const int p = GetParam();
  for (const int g : {1, 2}) {
    for (const double width : {0.5, 1e-3, 1e-6}) {
      for (const Basis basis : bases) {
        const auto space = Space::discontinuous(with_last_column(g, width), p, basis);
        const Field f = constant_field(space);
        std::vector<TransferResult> results = {transfer({&f, 1}, beyond(g), extending())};
        if (width == 1e-6 && p <= 5)
          results.push_back(TransferOperator(space, beyond(g), extending()).transfer({&f, 1}));
        for (const TransferResult& r : results) {
          const std::string at = "g" + std::to_string(g) + " width " + std::to_string(width);
          EXPECT_LE(error_norms(r.fields[0], one(Formula("3.25"))).max, 1e-13) << at;
          EXPECT_LE(r.report.fields[0].relative_mass_defect, 1e-14) << at;
        }
      }
    }
  }
}

// 3 is the growth of a donor 0.25 wide 0.25 away; those behind the slivers are twice as far.
TEST_P(Extension, PolynomialsAreContinuedAsWellAsByGoodDonors) {
  const int p = GetParam();
  const Formula polynomial(p < 3 ? "1 + x + 2*y" : "x^3 - x*y^2 + y + 1");
  double error[2][2] = {};
  for (std::size_t b = 0; b < 2; ++b) {
    for (std::size_t thin = 0; thin < 2; ++thin) {
      const auto space =
          Space::discontinuous(with_last_column(1, thin == 0 ? 0.5 : 1e-6), p, bases[b]);
      const std::vector<Field> fields = {sample("u", space, one(polynomial)),
                                         project("w", space, one(Formula("exp(x)*cos(y)")))};
      const TransferResult r = transfer(fields, beyond(1), extending());
      EXPECT_LE(error_norms(r.fields[0], one(polynomial)).max,
                p < 4 ? 1e-13 : 1e-15 * std::pow(5.0, p))
          << p;
      error[b][thin] = error_norms(r.fields[1], one(Formula("exp(x)*cos(y)"))).max;
      EXPECT_EQ(r.report.extension_held_area, 0.0);
      if (thin == 0) {
        EXPECT_EQ(r.report.extension_moved_area, 0.0);
        EXPECT_LE(r.report.extension_growth, std::pow(3.1, p));
      } else {
        EXPECT_NEAR(r.report.extension_moved_area, r.report.uncovered_area, 1e-3);
      }
    }
    EXPECT_LE(error[b][1], 10.0 * error[b][0]) << p;
  }
}

TEST_P(Extension, ValuesAreHeldWhereNoDonorReaches) {
  const int p = GetParam();
  const auto donor = grid_mesh(4, 1, 1.0, [](const Vec2& x) { return Vec2{{1e-6 * x[0], x[1]}}; });
  for (const Basis basis : bases) {
    const auto space = Space::discontinuous(donor, p, basis);
    const std::vector<Field> fields = {constant_field(space),
                                       project("w", space, one(Formula("2 + cos(y)")))};
    const TransferResult r = transfer(fields, beyond(1), extending());
    EXPECT_LE(error_norms(r.fields[0], one(Formula("3.25"))).max, 1e-13);
    EXPECT_GE(r.report.extension_held_area, 0.9 * r.report.uncovered_area);
    EXPECT_LE(r.report.extension_growth, 0x1p20);
    EXPECT_GE(r.report.fields[1].min_after, 0.0);
    EXPECT_LE(r.report.fields[1].max_after, 5.0);
  }
}

// The moments of a sliver across the target's coordinates lose what the donor's slope multiplies.
TEST(ThinDonors, PolynomialsComeBackThroughThem) {
  const Formula cubic("x^3 - x*y^2 + y + 1");
  for (const int g : {1, 2}) {
    const auto target = grid_mesh(4, g, 1.0, [](const Vec2& p) {
      return Vec2{{0.5 + 0.5 * p[0], 0.8 * p[1]}};
    });
    const auto space = Space::discontinuous(with_last_column(g, 1e-6), 3, Basis::physical);
    const std::vector<Field> fields = {sample("u", space, one(cubic)),
                                       test::checkerboard(space->mesh(), 3, Basis::physical)};
    const TransferResult r = transfer(fields, target, extending());
    EXPECT_LE(error_norms(r.fields[0], one(cubic)).max, 1e-12);
    for (const FieldReport& f : r.report.fields) EXPECT_LE(f.relative_mass_defect, 1e-14) << f.name;
  }
}

// Geometric degree, field degree.
class ThinAcross : public ::testing::TestWithParam<std::pair<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Degrees, ThinAcross,
                         ::testing::Values(std::pair(1, 3), std::pair(1, 5), std::pair(2, 5),
                                           std::pair(2, 8), std::pair(4, 4)));

// Interpolated in a box around a region that lies across the axes, a sliver's polynomial would be
// taken far outside it: a constant came back as 1e22 at degree 8.
TEST_P(ThinAcross, TheAxes) {
  const auto [g, p] = GetParam();
  const Formula cubic("x^3 - x*y^2 + y + 1"), linear("1 + x + 2*y");
  const auto target = grid_mesh(2, g, 0.6, test::bend(0.1, 0.1));
  for (const double width : {1e-2, 1e-6}) {
    const auto donor = grid_mesh(4, g, 1.0, [width](const Vec2& at) {
      const double off = std::abs(at[0]);
      const double x = off <= 0.5 ? 2.0 * width * at[0]
                                  : std::copysign(width + (2.0 * off - 1.0) * (1.0 - width), at[0]);
      return Vec2{{0.8 * x - 0.6 * at[1], 0.6 * x + 0.8 * at[1]}};
    });
    for (const Basis basis : bases) {
      const bool plane = basis == Basis::physical || g == 1;
      const Formula& polynomial = plane ? cubic : linear;
      const auto space = Space::discontinuous(donor, p, basis);
      const std::vector<Field> fields = {constant_field(space), sample("u", space, one(polynomial)),
                                         test::checkerboard(donor, p, basis)};
      const TransferResult r = transfer(fields, target, extending());
      EXPECT_LE(error_norms(r.fields[0], one(Formula("3.25"))).max, 1e-13) << plane << width;
      // Compositions are interpolated, here to 2e-8.
      EXPECT_LE(error_norms(r.fields[1], one(polynomial)).max, plane ? 2e-12 : 1e-7)
          << plane << width;
      for (const FieldReport& f : r.report.fields)
        EXPECT_LE(f.relative_mass_defect, 1e-14) << plane << width << ' ' << f.name;
    }
  }
}

// Far from the target's boundary elements go a shorter way, which some regions leave.
TEST(ThinDonors, PolynomialsComeBackInTheMiddleOfMeshes) {
  const Formula cubic("x^3 - x*y^2 + y + 1");
  for (const int g : {1, 2}) {
    const auto target = grid_mesh(10, g, 0.6, test::bend(0.1, 0.1));
    for (const double width : {8e-3, 4e-3, 2e-3}) {
      const auto donor = grid_mesh(16, g, 1.0, [width](const Vec2& at) {
        const double off = std::abs(at[0]);
        const double x = off <= 0.125
                             ? 8.0 * width * at[0]
                             : std::copysign(width + (off - 0.125) / 0.875 * (1.0 - width), at[0]);
        return Vec2{{0.8 * x - 0.6 * at[1], 0.6 * x + 0.8 * at[1]}};
      });
      const auto space = Space::discontinuous(donor, 3, Basis::physical);
      const std::vector<Field> fields = {constant_field(space), sample("u", space, one(cubic))};
      const TransferResult r = transfer(fields, target);
      EXPECT_LE(error_norms(r.fields[0], one(Formula("3.25"))).max, 1e-13) << g << ' ' << width;
      EXPECT_LE(error_norms(r.fields[1], one(cubic)).max, 2e-12) << g << ' ' << width;
    }
  }
}

// A gap of 1e-10 of the element around its corner: donors that jump along it count as little.
TEST(ThinGaps, AroundACornerHardlyChangeTheField) {
  const auto donor = grid_mesh(4, 1, 1.0, test::same_place);
  const auto space = Space::discontinuous(donor, 3, Basis::physical);
  std::vector<double> c(space->coefficient_count());
  RandomStream random("thin gaps", 1);
  for (double& x : c) x = random.uniform(-1, 1);
  const Field jumps("jumps", space, c);
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const auto on = [&](double half) {
    return transfer({&jumps, 1}, grid_mesh(3, 2, half, test::same_place), options);
  };
  const TransferResult inside = on(1.0), beyond = on(1.0 + 1e-10);
  EXPECT_GT(beyond.report.uncovered_elements.size(), 0U);
  const auto a = inside.fields[0].coefficients(), b = beyond.fields[0].coefficients();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n], b[n], 1e-6) << n;
}

}  // namespace
}  // namespace bezel
