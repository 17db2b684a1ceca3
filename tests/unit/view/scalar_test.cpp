#include "bezel/view/scalar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"

namespace bezel::view {
namespace {

TEST(ElementScalar, EqualsTheField) {
  const auto mesh = test::grid_mesh(2, 2, 1.0, test::bend(0.1, 0.1));
  const std::vector<Formula> velocity = {Formula("x+y"), Formula("x*y")};
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    const Field field = project("v", Space::discontinuous(mesh, 3, basis), velocity);
    for (const int component : {-1, 0, 1}) {
      ElementScalar scalar(field, component);
      for (std::size_t e = 0; e < mesh->element_count(); ++e) {
        const ElementId id(e);
        scalar.move_to(id);
        const std::vector<Lambda> lambda = {{0.2, 0.3, 0.5}, {1, 0, 0}};
        std::vector<Vec2> x;
        for (const Lambda& l : lambda)
          x.push_back(bernstein::evaluate<Vec2>(2, mesh->gather(id), l));
        std::vector<double> out(2);
        scalar.evaluate(lambda, x, out);
        for (std::size_t q = 0; q < 2; ++q) {
          std::array<double, 2> v{};
          field.evaluate(id, lambda[q], v);
          const double expected =
              component < 0 ? std::hypot(v[0], v[1]) : v[static_cast<std::size_t>(component)];
          EXPECT_NEAR(out[q], expected, 1e-13);
        }
      }
    }
  }
}

TEST(ScalarRange, HoldsTheValues) {
  const auto mesh = test::grid_mesh(2, 1, 1.0, test::same_place);
  const std::vector<Formula> velocity = {Formula("3*x"), Formula("4*x")};
  const Field field = project("v", Space::discontinuous(mesh, 1), velocity);
  EXPECT_NEAR(scalar_range(field, 0).lo, -3.0, 0.01);
  EXPECT_NEAR(scalar_range(field, 0).hi, 3.0, 0.01);
  EXPECT_NEAR(scalar_range(field, -1).hi, 5.0, 1e-12);
  EXPECT_NEAR(scalar_range(field, -1).lo, 0.0, 1e-12);
  EXPECT_EQ(scalar_name(field, 1), "v[1]");
  EXPECT_EQ(scalar_name(field, -1), "|v|");
}

}  // namespace
}  // namespace bezel::view
