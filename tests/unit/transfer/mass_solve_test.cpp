#include "bezel/transfer/mass_solve.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/field/field.hpp"
#include "bezel/geometry/triangle.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

using test::bend;
using test::grid_mesh;

constexpr MassMethod cholesky = MassMethod::cholesky, gradients = MassMethod::conjugate_gradients;

std::vector<double> random_values(std::size_t n, const char* name) {
  RandomStream random(name, 1);
  std::vector<double> values(n);
  for (double& v : values) v = random.uniform(-1, 1);
  return values;
}

double size(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

double difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return size(a);
}

/// A^T M c with the elements' matrices as element_matrix() has them.
std::vector<double> plain_load(const ContinuousMass& mass, const std::vector<double>& c) {
  const Space& space = *mass.space();
  std::vector<double> y(space.dof_count(), 0.0);
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(space.uniform_degree()));
  std::vector<double> matrix(n * n);
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e) {
    mass.element_matrix(e, matrix);
    const auto dofs = space.dofs(ElementId(e));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        y[static_cast<std::size_t>(dofs[i])] += matrix[i * n + j] * c[e * n + j];
  }
  return y;
}

// The matrix of |f|^2 is tested against the L2 norm, which has its own quadrature.
TEST(ContinuousMass, ElementMatricesGiveTheNorm) {
  for (int g = 1; g <= 4; ++g) {
    for (int p = 1; p <= 5; ++p) {
      const auto mesh = grid_mesh(3, g, 1.0, bend(0.2, 0.15));
      ContinuousMass mass(Space::continuous(mesh, p), {}, 1);
      const auto space = Space::discontinuous(mesh, p);
      const std::vector<double> c = random_values(space->coefficient_count(), "norm");
      const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
      std::vector<double> matrix(n * n);
      double squared = 0.0;
      double integrals = 0.0;
      for (std::size_t e = 0; e < mesh->element_count(); ++e) {
        mass.element_matrix(e, matrix);
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t j = 0; j < n; ++j)
            squared += matrix[i * n + j] * c[e * n + i] * c[e * n + j];
          integrals += mass.integrals()[e * n + i] * c[e * n + i];
        }
      }
      const Field f("f", space, c);
      const double norm = l2_norm(f);
      EXPECT_NEAR(squared, norm * norm, 1e-13 * norm * norm) << "g " << g << " p " << p;
      EXPECT_NEAR(integrals, integral(f)[0], 1e-14) << "g " << g << " p " << p;
    }
  }
}

TEST(ContinuousMass, WeightedMatricesGiveWeightedIntegrals) {
  const Formula weight("2 + x - 0.5*y + 0.3*x*y");
  for (int g = 1; g <= 3; ++g) {
    const auto mesh = grid_mesh(3, g, 1.0, bend(0.2, 0.15));
    const Field w = project("w", Space::discontinuous(mesh, 2, Basis::physical), {&weight, 1});
    ContinuousMass mass(Space::continuous(mesh, 2), {}, 1, gradients, &w);
    double total = 0.0;
    for (const double i : mass.integrals()) total += i;
    EXPECT_NEAR(total, integral(w)[0], 1e-13);
    // f = r . (1, 2) in physical coordinates is in the space when the elements are straight.
    if (g > 1) continue;
    const Formula f("x + 2*y");
    const Formula product("(2 + x - 0.5*y + 0.3*x*y) * (x + 2*y)^2");
    const Field values = sample("f", Space::discontinuous(mesh, 2), {&f, 1});
    const auto c = values.coefficients();
    std::vector<double> matrix(36);
    double squared = 0.0;
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      mass.element_matrix(e, matrix);
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
          squared += matrix[i * 6 + j] * c[e * 6 + i] * c[e * 6 + j];
    }
    EXPECT_NEAR(squared, integral(project("p", Space::discontinuous(mesh, 4), {&product, 1}))[0],
                1e-13);
  }
}

TEST(ContinuousMass, LoadAndApplyAreTheAssembledMatrix) {
  for (const int g : {1, 2, 3}) {
    for (const int p : {1, 2, 3, 4}) {
      const auto mesh = grid_mesh(3, g, 1.0, bend(0.2, 0.15));
      ContinuousMass mass(Space::continuous(mesh, p), {}, 1);
      const std::vector<double> c = random_values(mass.space()->coefficient_count(), "load");
      std::vector<double> y(mass.space()->dof_count());
      mass.load(c, y);
      EXPECT_LE(difference(y, plain_load(mass, c)), 1e-14 * size(y));
      const std::vector<double> x = random_values(mass.space()->dof_count(), "apply");
      mass.apply(x, y);
      EXPECT_LE(difference(y, plain_load(mass, mass.space()->expand(x))), 1e-14 * size(y));
    }
  }
}

// <P a, b> == <a, P b> and <P a, a> > 0: what conjugate gradients ask of a preconditioner.
TEST(ContinuousMass, PreconditionerIsSymmetricAndPositive) {
  for (const int g : {1, 3}) {
    for (const int p : {1, 3, 6}) {
      const auto mesh = grid_mesh(3, g, 1.0, bend(0.2, 0.15));
      ContinuousMass mass(Space::continuous(mesh, p), {}, 1);
      const std::size_t n = mass.space()->dof_count();
      const std::vector<double> a = random_values(n, "a");
      const std::vector<double> b = random_values(n, "b");
      std::vector<double> pa(n);
      std::vector<double> pb(n);
      mass.precondition(a, pa);
      mass.precondition(b, pb);
      double ab = 0.0, ba = 0.0, aa = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        ab += pa[i] * b[i];
        ba += a[i] * pb[i];
        aa += pa[i] * a[i];
      }
      EXPECT_NEAR(ab, ba, 1e-13 * size(pa) * size(b));
      EXPECT_GT(aa, 0.0);
    }
  }
}

TEST(ContinuousMass, GradientsEqualCholeskyAndSatisfyTheEquations) {
  for (const int g : {1, 2, 4}) {
    for (int p = 1; p <= 6; ++p) {
      const auto mesh = grid_mesh(4, g, 1.0, bend(0.2, 0.15));
      const auto space = Space::continuous(mesh, p);
      const std::vector<double> c = random_values(space->coefficient_count(), "solve");
      ContinuousMass direct(space, {}, 1, cholesky);
      ContinuousMass iterative(space, {}, 1, gradients);
      const MassSolution a = direct.solve(c);
      const MassSolution b = iterative.solve(c);
      EXPECT_EQ(a.iterations, 0);
      EXPECT_GT(b.iterations, 0);
      EXPECT_LE(difference(a.dofs, b.dofs), 1e-12 * size(a.dofs)) << "g " << g << " p " << p;
      std::vector<double> gap = space->expand(b.dofs);
      for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = c[i] - gap[i];
      const double right = size(plain_load(direct, c));
      const double residual = size(plain_load(direct, gap));
      EXPECT_LE(residual, 1e-15 * right) << "g " << g << " p " << p;
      EXPECT_NEAR(b.relative_residual * right, residual, 5e-16 * right);
    }
  }
}

TEST(ContinuousMass, StepsDoNotGrowWithTheMesh) {
  for (int p = 1; p <= 4; ++p) {
    std::vector<int> steps;
    for (const int n : {6, 12, 24}) {
      const auto space = Space::continuous(grid_mesh(n, 2, 1.0, bend(0.2, 0.15)), p);
      ContinuousMass mass(space, {}, 1, gradients);
      steps.push_back(mass.solve(random_values(space->coefficient_count(), "steps")).iterations);
    }
    EXPECT_LE(steps[2], steps[0] + 3) << "degree " << p;
    EXPECT_LE(steps[2], 50) << "degree " << p;
  }
}

// Neighbours that differ six times in size, elements that differ 200000 times.
TEST(ContinuousMass, StepsDoNotGrowOnGradedMeshes) {
  const auto grade = [](double t) {
    return (std::exp(14.0 * (t + 1) / 2) - 1) / (std::exp(14.0) - 1);
  };
  for (int p = 1; p <= 4; ++p) {
    const auto mesh = grid_mesh(8, 1, 1.0, [&](const Vec2& x) {
      return Vec2{{grade(x[0]), x[1]}};
    });
    const auto space = Space::continuous(mesh, p);
    const std::vector<double> c = random_values(space->coefficient_count(), "graded");
    ContinuousMass direct(space, {}, 1, cholesky);
    ContinuousMass iterative(space, {}, 1, gradients);
    const MassSolution a = direct.solve(c);
    const MassSolution b = iterative.solve(c);
    EXPECT_LE(b.iterations, 50) << "degree " << p;
    for (std::size_t d = 0; d < a.dofs.size(); ++d) EXPECT_NEAR(a.dofs[d], b.dofs[d], 1e-11);
  }
}

TEST(ContinuousMass, ContinuousCoefficientsStay) {
  for (const MassMethod method : {cholesky, gradients}) {
    const auto space = Space::continuous(grid_mesh(4, 3, 1.0, bend(0.2, 0.15)), 3);
    const std::vector<double> x = random_values(space->dof_count(), "stay");
    ContinuousMass mass(space, {}, 1, method);
    EXPECT_LE(difference(mass.solve(space->expand(x)).dofs, x), 1e-15 * size(x));
  }
}

TEST(ContinuousMass, ZeroStaysZero) {
  const auto space = Space::continuous(grid_mesh(2, 2, 1.0, bend(0.2, 0.15)), 2);
  ContinuousMass mass(space, {}, 1, gradients);
  const MassSolution s = mass.solve(std::vector<double>(space->coefficient_count(), 0.0));
  for (const double x : s.dofs) EXPECT_EQ(x, 0.0);
  EXPECT_EQ(s.relative_residual, 0.0);
}

// The rest is the best for the given values: its equations hold, whatever the fixed dofs are.
TEST(ContinuousMass, FixedDofsKeepTheirValues) {
  const auto space = Space::continuous(grid_mesh(4, 2, 1.0, bend(0.2, 0.15)), 3);
  const std::vector<double> c = random_values(space->coefficient_count(), "fixed");
  const std::vector<double> given = random_values(space->dof_count(), "given");
  std::vector<char> fixed(space->dof_count(), 0);
  for (std::size_t d = 0; d < fixed.size(); d += 3) fixed[d] = 1;
  std::vector<std::vector<double>> found;
  for (const MassMethod method : {cholesky, gradients}) {
    ContinuousMass mass(space, fixed, 1, method);
    const MassSolution s = mass.solve(c, given);
    std::vector<double> gap = space->expand(s.dofs);
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = c[i] - gap[i];
    const std::vector<double> residual = plain_load(mass, gap);
    const double right = size(plain_load(mass, c));
    for (std::size_t d = 0; d < fixed.size(); ++d) {
      if (fixed[d]) {
        EXPECT_EQ(s.dofs[d], given[d]);
      } else {
        EXPECT_LE(std::abs(residual[d]), 1e-14 * right);
      }
    }
    found.push_back(s.dofs);
  }
  EXPECT_LE(difference(found[0], found[1]), 1e-12 * size(found[0]));
}

TEST(ContinuousMass, PetscAgreesWhereThereIsPetsc) {
  const auto space = Space::continuous(grid_mesh(4, 2, 1.0, bend(0.2, 0.15)), 3);
  if (!is_available(MassMethod::petsc)) {
    EXPECT_THROW(ContinuousMass(space, {}, 1, MassMethod::petsc), InputError);
    return;
  }
  const std::vector<double> c = random_values(space->coefficient_count(), "petsc");
  const std::vector<double> given = random_values(space->dof_count(), "given");
  for (const bool some : {false, true}) {
    std::vector<char> fixed(some ? space->dof_count() : 0);
    for (std::size_t d = 0; d < fixed.size(); d += 5) fixed[d] = 1;
    ContinuousMass ours(space, fixed, 1, gradients);
    ContinuousMass theirs(space, fixed, 1, MassMethod::petsc);
    const MassSolution a = ours.solve(c, given);
    const MassSolution b = theirs.solve(c, given);
    EXPECT_GT(b.iterations, 0);
    EXPECT_LE(b.relative_residual, 1e-14);
    EXPECT_LE(difference(a.dofs, b.dofs), 1e-12 * size(a.dofs));
  }
}

TEST(ContinuousMass, SameBitsForAnyNumberOfThreads) {
  const auto space = Space::continuous(grid_mesh(24, 2, 1.0, bend(0.2, 0.15)), 3);
  const std::vector<double> c = random_values(space->coefficient_count(), "threads");
  ContinuousMass one(space, {}, 1, gradients);
  const MassSolution a = one.solve(c);
  for (const int threads : {2, 3, 8}) {
    ContinuousMass several(space, {}, threads, gradients);
    const MassSolution b = several.solve(c);
    EXPECT_EQ(a.dofs, b.dofs);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.relative_residual, b.relative_residual);
  }
}

TEST(ContinuousMass, InvertedElementsAreNamed) {
  for (const int g : {1, 2}) {
    const auto mesh = grid_mesh(2, g, 1.0, [](const Vec2& p) { return Vec2{{p[1], p[0]}}; });
    try {
      ContinuousMass mass(Space::continuous(mesh, 2), {}, 2);
      FAIL() << "expected NumericsError";
    } catch (const NumericsError& error) {
      EXPECT_EQ(std::string(error.what()).find("triangle 0: its mass matrix"), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace bezel::detail
