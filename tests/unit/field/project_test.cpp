// sample() and project() of bezel/field/field.hpp, and the solver behind them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bezel/field/field.hpp"
#include "bezel/field/mass_kernel.hpp"
#include "checks.hpp"
#include "meshes.hpp"

namespace bezel {
namespace {

using field_test::formulas;
using field_test::MeshPtr;
using field_test::message_of;

/// (1 + x/2 - y/3)^d + x^d / 2 - x y^(d-1) / 4: every power of degree d, values of size about 1 to
/// 100.
std::string polynomial(int d) {
  const std::string n = std::to_string(d);
  if (d == 0) return "0.7 + 0*x + 0*y";
  return "(1 + x/2 - y/3)^" + n + " + x^" + n + "/2 - x*y^" + std::to_string(d - 1) + "/4";
}

double largest(const Field& field) {
  double m = 0.0;
  for (const double c : field.coefficients()) m = std::max(m, std::abs(c));
  return m;
}

TEST(SampleAndProject, ReproducePolynomialsOfXAndYInThePhysicalBasis) {
  // On curved elements, at every degree: zeta is in the space. Both agree with it to rounding.
  for (const MeshPtr& mesh : {field_test::two_quadratic(), field_test::wavy(2, 3)})
    for (int d = 0; d <= Space::max_degree; ++d) {
      const auto space = Space::discontinuous(mesh, d, Basis::physical);
      const auto exact = formulas({polynomial(d).c_str()});
      const ErrorNorms sampled = error_norms(sample("f", space, exact), exact, 2);
      EXPECT_LT(sampled.l2_relative, 1e-14) << "degree " << d;
      const ErrorNorms projected = error_norms(project("f", space, exact, 2), exact, 2);
      EXPECT_LT(projected.l2_relative, 1e-14) << "degree " << d;
    }
}

TEST(SampleAndProject, ReproducePolynomialsOnStraightElements) {
  const MeshPtr mesh = field_test::straight(2, 2);
  for (int d = 1; d <= Space::max_degree; ++d)
    for (const auto& space : {Space::discontinuous(mesh, d), Space::continuous(mesh, d),
                              Space::discontinuous(mesh, d, Basis::physical)}) {
      const auto exact = formulas({polynomial(d).c_str(), "2 - 3*y + x"});
      const ErrorNorms sampled = error_norms(sample("f", space, exact), exact);
      EXPECT_LT(sampled.l2_relative, 2e-14) << "degree " << d;
      const ErrorNorms projected = error_norms(project("f", space, exact), exact);
      EXPECT_LT(projected.l2_relative, 1e-14) << "degree " << d;
      EXPECT_LT(projected.max, 1e-12) << "degree " << d;
      EXPECT_LT(projected.h1_semi, 1e-11) << "degree " << d;
    }
}

TEST(SampleAndProject, ReferenceBasisHoldsPolynomialsOfDegreePOverG) {
  // A polynomial of degree q in x and y has degree q g in reference coordinates.
  for (int g = 2; g <= 5; ++g) {
    const MeshPtr mesh = field_test::wavy(2, g);
    for (int q = 1; q * g <= Space::max_degree; ++q)
      for (const auto& space :
           {Space::discontinuous(mesh, q * g), Space::continuous(mesh, q * g)}) {
        const auto exact = formulas({polynomial(q).c_str()});
        EXPECT_LT(error_norms(sample("f", space, exact), exact).l2_relative, 2e-14)
            << g << " " << q;
        EXPECT_LT(error_norms(project("f", space, exact), exact).l2_relative, 1e-14)
            << g << " " << q;
      }
  }
}

TEST(SampleAndProject, CubicOfTheTransferStudy) {
  // zeta = 5y^3 + x^2 + 2y + 3, in the space of physical cubics on cubic elements.
  const auto space = Space::discontinuous(field_test::wavy(4, 3), 3, Basis::physical);
  const auto exact = formulas({"5*y^3 + x^2 + 2*y + 3"});
  EXPECT_LT(error_norms(project("f", space, exact), exact).l2_relative, 1e-15);
  EXPECT_LT(error_norms(sample("f", space, exact), exact).l2_relative, 1e-15);
}

TEST(Sample, TakesTheNodalValues) {
  const MeshPtr mesh = field_test::wavy(2, 3);
  const auto exact = formulas({"exp(x) * cos(3*y)"});
  for (int d = 0; d <= 6; ++d)
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      const auto space = Space::discontinuous(mesh, d, basis);
      const Field field = sample("f", space, exact);
      for (std::size_t e = 0; e < mesh->element_count(); ++e)
        for (int i = 0; i < bernstein::triangle_size(d); ++i) {
          const auto w = bernstein::triangle_multi_index(std::max(d, 1), i);
          const Lambda node = d == 0 ? Lambda{1.0 / 3, 1.0 / 3, 1.0 / 3}
                                     : Lambda{w[0] / double(d), w[1] / double(d), w[2] / double(d)};
          double value = 0.0;
          field.evaluate(ElementId(e), node, {&value, 1});
          const Vec2 p = bernstein::evaluate<Vec2>(3, mesh->gather(ElementId(e)), node);
          EXPECT_NEAR(value, exact[0](p.x(), p.y()), 2e-14) << d;
        }
    }
}

TEST(Project, ResidualIsOrthogonalToTheSpace) {
  // The error of the projection has no component along constants: the integral is conserved,
  // element by element.
  const MeshPtr mesh = field_test::wavy(2, 2);
  const auto exact = formulas({"exp(x*y) + sin(3*x)"});
  for (const Basis basis : {Basis::reference, Basis::physical})
    for (int d = 0; d <= 6; ++d) {
      const Field field = project("f", Space::discontinuous(mesh, d, basis), exact, 20);
      EXPECT_NEAR(error_norms(field, exact, 20).integral, 0.0, 2e-14) << d;
    }
  // Over the continuous space only the whole integral is.
  const Field field = project("f", Space::continuous(mesh, 3), exact, 20);
  EXPECT_NEAR(error_norms(field, exact, 20).integral, 0.0, 2e-14);
}

TEST(Project, ConvergesWithOrderDegreePlusOne) {
  // Smooth maps: the mesh of n cells has elements of size 1/n under one fixed map interpolated to
  // high degree.
  const auto exact = formulas({"sin(2*x + 0.3) * exp(y/2)"});
  for (int d = 0; d <= 4; ++d) {
    const auto error = [&](int n, int kind) {
      const MeshPtr mesh = kind == 1 ? field_test::straight(n) : field_test::wavy(n, 2, 0.05);
      const auto space = kind == 0   ? Space::discontinuous(mesh, d)
                         : kind == 1 ? Space::continuous(mesh, std::max(d, 1))
                                     : Space::discontinuous(mesh, d, Basis::physical);
      return error_norms(project("f", space, exact), exact).l2;
    };
    for (int kind = 0; kind < 3; ++kind) {
      const int p = kind == 1 ? std::max(d, 1) : d;
      const double order = std::log2(error(4, kind) / error(8, kind));
      EXPECT_GT(order, p + 0.8) << "kind " << kind << " degree " << d;
      EXPECT_LT(order, p + 1.5) << "kind " << kind << " degree " << d;
    }
  }
}

TEST(SampleAndProject, ContinuousFieldsHaveOneValueOnEdges) {
  const MeshPtr mesh = field_test::wavy(3, 3);
  const auto f = formulas({"exp(x) * cos(4*y) + x^7"});
  int reversed = 0;
  for (int d = 1; d <= Space::max_degree; ++d) {
    const auto space = Space::continuous(mesh, d);
    for (const Field& field : {sample("f", space, f), project("f", space, f)})
      for (std::size_t e = 0; e < mesh->edge_count(); ++e) {
        const auto sides = mesh->adjacent(EdgeId(e));
        if (sides.size() != 2) continue;
        reversed += sides[0].reversed != sides[1].reversed;
        std::array<std::vector<double>, 2> along;
        for (std::size_t k = 0; k < 2; ++k) {
          const auto c = field.coefficients(sides[k].element);
          for (int m = 0; m <= d; ++m)
            along[k].push_back(c[static_cast<std::size_t>(
                bernstein::triangle_side_index(d, sides[k].side, sides[k].reversed ? d - m : m))]);
        }
        EXPECT_EQ(along[0], along[1]) << "edge " << e;  // bit for bit: the dofs are shared
        // And as values, at the same point of the edge seen from both sides.
        for (const double s : {0.0, 0.17, 0.5, 0.9}) {
          std::array<double, 2> value{};
          for (std::size_t k = 0; k < 2; ++k) {
            const double t = sides[k].reversed ? 1 - s : s;
            Lambda lambda{0, 0, 0};
            lambda[static_cast<std::size_t>(sides[k].side)] = 1 - t;
            lambda[static_cast<std::size_t>((sides[k].side + 1) % 3)] = t;
            field.evaluate(sides[k].element, lambda, {&value[k], 1});
          }
          EXPECT_NEAR(value[0], value[1], 1e-14 * largest(field));
        }
      }
  }
  EXPECT_GT(reversed, 50);
}

TEST(SampleAndProject, SameBitsForAnyNumberOfThreads) {
  const MeshPtr mesh = field_test::wavy(6, 2);
  const auto f = formulas({"exp(x)*sin(5*y)", "x^2-y"});
  for (const auto& space :
       {Space::discontinuous(mesh, 3), Space::discontinuous(mesh, 3, Basis::physical),
        Space::continuous(mesh, 3)}) {
    const Field one = sample("f", space, f, 1), many = sample("f", space, f, 7);
    EXPECT_TRUE(std::equal(one.coefficients().begin(), one.coefficients().end(),
                           many.coefficients().begin()));
    const Field first = project("f", space, f, 6, 1), second = project("f", space, f, 6, 5);
    EXPECT_TRUE(std::equal(first.coefficients().begin(), first.coefficients().end(),
                           second.coefficients().begin()));
    EXPECT_EQ(integral(first, 1), integral(first, 6));
    EXPECT_EQ(integral_abs(first, 1), integral_abs(first, 6));
    EXPECT_EQ(l2_norm(first, 1), l2_norm(first, 6));
    EXPECT_EQ(error_norms(first, f, 8, 1).l2, error_norms(first, f, 8, 6).l2);
  }
}

// Elements of one degree share a matrix; beside one of another degree each has its own.
TEST(Project, StraightElementsTogetherAreThoseAlone) {
  const MeshPtr mesh = field_test::straight(6, 3);
  const auto f = formulas({"exp(x)*sin(5*y)", "x^2-y"});
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    for (const int d : {0, 1, 4, Space::max_degree}) {
      std::vector<int> degrees(mesh->element_count(), d);
      degrees.back() = d == 0 ? 1 : d - 1;
      const Field together = project("f", Space::discontinuous(mesh, d, basis), f, 6, 3),
                  alone = project("f", Space::discontinuous(mesh, degrees, basis), f);
      for (std::size_t e = 0; e + 1 < degrees.size(); ++e) {
        const auto a = together.coefficients(ElementId(e)), b = alone.coefficients(ElementId(e));
        for (std::size_t i = 0; i < a.size(); ++i)
          EXPECT_NEAR(a[i], b[i], 4e-15 * std::ldexp(1.0, d));
      }
      const Field one = project("f", Space::discontinuous(mesh, d, basis), f, 6, 1);
      EXPECT_TRUE(std::ranges::equal(one.coefficients(), together.coefficients()));
    }
  }
}

TEST(SampleAndProject, Errors) {
  const auto space = Space::discontinuous(field_test::straight(1), 1);
  const auto f = formulas({"log(x)"});
  const std::string sampled = message_of([&] { sample("f", space, f); });
  EXPECT_EQ(sampled,
            "triangle 0: formula 'log(x)' is nan at x = -1, y = -1, expected a finite value");
  // Many straight elements at once: the one at fault is named, here the first above the middle.
  const auto above = formulas({"log(0.1 - y)"});
  EXPECT_EQ(message_of([&] {
              (void)project("f", Space::discontinuous(field_test::straight(2), 1), above);
            }).substr(0, 39),
            "triangle 4: formula 'log(0.1 - y)' is n");
  EXPECT_EQ(message_of([&] { sample("f", nullptr, f); }),
            "a field needs a space, found a null pointer");
  EXPECT_EQ(message_of([&] { project("f", space, {}); }), "found 0 formulas, expected 1..9");
  const std::vector<Formula> many(10, Formula("x"));
  EXPECT_EQ(message_of([&] { project("f", space, many); }), "found 10 formulas, expected 1..9");
  const std::vector<Formula> wrong{Formula("x + t", {"x", "y", "t"})};
  EXPECT_EQ(message_of([&] { sample("f", space, wrong); }),
            "formula 'x + t' has 3 variables, expected 2 (x and y)");
  EXPECT_EQ(message_of([&] { project("f", space, formulas({"x"}), -1); }),
            "found extra degree -1, expected 0..60");
  EXPECT_EQ(message_of([&] { project("f", space, formulas({"x"}), 61); }),
            "found extra degree 61, expected 0..60");
  // A clockwise triangle.
  const auto inverted = std::make_shared<TriangleMesh>(
      1, std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}, {-1, -1}},
      std::vector<NodeId>{NodeId(0), NodeId(1), NodeId(2), NodeId(0), NodeId(1), NodeId(3)});
  for (const Basis basis : {Basis::reference, Basis::physical})
    EXPECT_EQ(message_of(
                  [&] { project("f", Space::discontinuous(inverted, 2, basis), formulas({"x"})); }),
              "triangle 1: its mass matrix is not positive definite, expected an element that is "
              "not inverted or flat");
  EXPECT_EQ(message_of([&] { project("f", Space::continuous(inverted, 2), formulas({"x"})); }),
            "the mass matrix is not positive definite, expected a mesh without inverted or flat "
            "elements");
}

TEST(MassSolve, ConjugateGradientsAgreeWithCholesky) {
  // A finite-element-like matrix with entries of very different size on the diagonal.
  const int n = 200;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    const double scale = std::exp(0.1 * (i % 50));
    entries.emplace_back(i, i, 4.0 * scale);
    if (i > 0) {
      entries.emplace_back(i, i - 1, 1.0);
      entries.emplace_back(i - 1, i, 1.0);
    }
  }
  Eigen::SparseMatrix<double> a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd x(n, 3);
  for (int i = 0; i < n; ++i) x.row(i) << std::sin(i), 0.0, 1.0 / (i + 1);
  const Eigen::MatrixXd rhs = a * x;
  const Eigen::MatrixXd direct = field_detail::MassSolver(a).solve(rhs);
  const Eigen::MatrixXd iterative = field_detail::MassSolver(a, 0).solve(rhs);
  EXPECT_LT((direct - x).cwiseAbs().maxCoeff(), 2e-15);
  EXPECT_LT((iterative - x).cwiseAbs().maxCoeff(), 1e-13);
  a.coeffRef(3, 3) = -1.0;
  const std::string message =
      "the mass matrix is not positive definite, expected a mesh without inverted or flat elements";
  EXPECT_EQ(message_of([&] { field_detail::MassSolver(a).solve(rhs); }), message);
  EXPECT_EQ(message_of([&] { field_detail::MassSolver(a, 0).solve(rhs); }), message);
}

}  // namespace
}  // namespace bezel
