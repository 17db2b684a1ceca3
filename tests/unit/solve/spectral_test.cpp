#include "bezel/solve/spectral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/formula/formula.hpp"
#include "support/message_of.hpp"
#include "support/quad_maps.hpp"

namespace bezel {
namespace {

using std::numbers::pi;
using test::message_of;
using test::ring_map;
using test::segment;
using test::side;
using test::straight_map;

double harmonic(double x, double y) {
  return std::exp(x) * std::sin(y);
}
Vec2 harmonic_gradient(double x, double y) {
  return {std::exp(x) * std::sin(y), std::exp(x) * std::cos(y)};
}

GordonHall square(int degree) {
  return straight_map(degree, {-1, -1}, {1, -1}, {1, 1}, {-1, 1});
}

std::vector<GordonHall> grid(int cells, int degree) {
  std::vector<GordonHall> maps;
  const double h = 1.0 / cells;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i)
      maps.push_back(straight_map(degree, {i * h, j * h}, {(i + 1) * h, j * h},
                                  {(i + 1) * h, (j + 1) * h}, {i * h, (j + 1) * h}));
  return maps;
}

TEST(Spectral, EnergyErrorsOnTheSquare) {
  // The published check of the method: 3.4e-7 and 1.8e-12.
  const auto error = [](int degree) {
    return solve_poisson(square(degree), {harmonic}).errors(harmonic, harmonic_gradient).energy;
  };
  EXPECT_NEAR(error(8), 3.4e-7, 0.05e-7);
  EXPECT_NEAR(error(12), 1.8e-12, 0.05e-12);
}

TEST(Spectral, PolynomialsAreReproducedOnAffineMaps) {
  // u of degree 4 in each direction: the rule of degree 6 is exact for the products with f.
  const auto u = [](double x, double y) { return x * x * x * y - 2 * x * y * y + 0.3 * y + 1.7; };
  const auto grad = [](double x, double y) {
    return Vec2{3 * x * x * y - 2 * y * y, x * x * x - 4 * x * y + 0.3};
  };
  const auto f = [](double x, double y) { return -6 * x * y + 4 * x; };
  const GordonHall map = straight_map(1, {0.1, 0.2}, {1.3, 0.6}, {1.1, 1.7}, {-0.1, 1.3});
  SpectralOptions options;
  options.degree = 6;
  const SpectralSolution solution = solve_poisson(map, {u, f}, options);
  EXPECT_EQ(solution.degree(), 6);
  EXPECT_EQ(solution.unknown_count(), 25u);
  const SpectralErrors errors = solution.errors(u, grad);
  EXPECT_LT(errors.max, 1e-14);
  EXPECT_LT(errors.energy, 1e-13);
  const SpectralValue at = solution.evaluate(ElementId(0), 0.3, -0.6);
  EXPECT_LT(norm(at.point - map(0.3, -0.6)), 1e-15);
  EXPECT_NEAR(at.value, u(at.point.x(), at.point.y()), 1e-14);
  EXPECT_LT(norm(at.gradient - grad(at.point.x(), at.point.y())), 1e-13);
}

TEST(Spectral, LowDegreesHaveNoOrFewUnknowns) {
  SpectralOptions options;
  options.degree = 1;
  const SpectralSolution one = solve_poisson(square(1), {harmonic}, options);
  EXPECT_EQ(one.unknown_count(), 0u);
  EXPECT_EQ(one.values(ElementId(0))[3], harmonic(1, 1));
  // Bilinear elements on a grid: second order.
  const auto error = [&](int cells) {
    return solve_poisson(join(grid(cells, 1)), {harmonic}, options)
        .errors(harmonic, harmonic_gradient, 4)
        .l2;
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

TEST(Spectral, VariableCoefficientAndSourceConvergeOnManyElements) {
  const auto u = [](double x, double y) { return std::sin(x) * std::cos(2 * y); };
  const auto grad = [](double x, double y) {
    return Vec2{std::cos(x) * std::cos(2 * y), -2 * std::sin(x) * std::sin(2 * y)};
  };
  const PoissonProblem problem{u, Formula("5*(1 + x^2)*sin(x)*cos(2*y) - 2*x*cos(x)*cos(2*y)"),
                               [](double x, double) { return 1 + x * x; }};
  const QuadMesh mesh = join(grid(3, 1));
  double last = 1.0;
  for (const int degree : {2, 4, 6, 8}) {
    SpectralOptions options;
    options.degree = degree;
    const SpectralErrors errors = solve_poisson(mesh, problem, options).errors(u, grad);
    EXPECT_LT(errors.energy, last / (degree == 2 ? 50 : 400)) << degree;
    last = errors.energy;
  }
  EXPECT_LT(last, 2e-11);
}

TEST(Spectral, OneElementAndItsPartsAgree) {
  // The same curved region as one map and as four, whose lines xi = 0, eta = 0 are the map's.
  const int n = 16;
  const auto top = [](double t) { return Vec2{t, 1.2 + 0.1 * std::cos(2 * t)}; };
  const Vec2 a{-1, 0}, b{1, 0};
  const std::vector<Vec2> t = side(n, top);
  const GordonHall whole({segment(n, a, b), segment(n, b, t.back()), t, segment(n, a, t.front())});
  const auto part = [&](double x0, double x1, double y0, double y1) {
    const auto at = [=, &whole](double p0, double q0, double p1, double q1) {
      return side(n, [=, &whole](double s) {
        return whole(0.5 * (1 - s) * p0 + 0.5 * (1 + s) * p1,
                     0.5 * (1 - s) * q0 + 0.5 * (1 + s) * q1);
      });
    };
    return GordonHall(
        {at(x0, y0, x1, y0), at(x1, y0, x1, y1), at(x0, y1, x1, y1), at(x0, y0, x0, y1)});
  };
  const std::vector<GordonHall> parts{part(-1, 0, -1, 0), part(0, 1, -1, 0), part(-1, 0, 0, 1),
                                      part(0, 1, 0, 1)};
  const QuadMesh mesh = join(parts);
  EXPECT_EQ(mesh.vertex_count(), 9u);
  const PoissonProblem problem{[](double, double) { return 0.0; },
                               [](double x, double y) { return std::exp(x - y); }};
  SpectralOptions options;
  options.degree = n;
  const SpectralSolution one = solve_poisson(whole, problem, options);
  const SpectralSolution four = solve_poisson(mesh, problem, options);
  for (const double xi : {-0.8, -0.25, 0.4})
    for (const double eta : {-0.6, 0.3}) {
      const ElementId e((xi > 0 ? 1 : 0) + (eta > 0 ? 2 : 0));
      const SpectralValue ours = one.evaluate(ElementId(0), xi, eta);
      const SpectralValue theirs =
          four.evaluate(e, 2 * xi + (xi > 0 ? -1 : 1), 2 * eta + (eta > 0 ? -1 : 1));
      EXPECT_LT(norm(ours.point - theirs.point), 1e-12);
      EXPECT_NEAR(ours.value, theirs.value, 2e-7);
    }
}

TEST(Spectral, ARingWithReversedAndTurnedEdges) {
  // Three maps around a ring; log r is harmonic and not constant along the inner edges.
  const std::vector<GordonHall> maps{ring_map(12, 0.0, 2 * pi / 3),
                                     ring_map(12, 2 * pi / 3, 4 * pi / 3),
                                     ring_map(12, 4 * pi / 3, 2 * pi)};
  const QuadMesh mesh = join(maps);
  const auto u = [](double x, double y) { return 0.5 * std::log(x * x + y * y) + x * y; };
  const auto grad = [](double x, double y) {
    const double r2 = x * x + y * y;
    return Vec2{x / r2 + y, y / r2 + x};
  };
  SpectralOptions options;
  options.degree = 20;
  const SpectralSolution solution = solve_poisson(mesh, {u}, options);
  const SpectralErrors errors = solution.errors(u, grad);
  EXPECT_LT(errors.max, 2e-12);
  EXPECT_LT(errors.energy, 1e-10);
}

TEST(Spectral, TheFieldOnTrianglesIsTheSolution) {
  const std::vector<GordonHall> maps{ring_map(16, 0.0, pi), ring_map(16, pi, 2 * pi)};
  const Formula log("log(x^2 + y^2)/2");
  const SpectralSolution solution = solve_poisson(join(maps), {log});
  const Field field = solution.field("u", 4, 5);
  const TriangleMesh& mesh = field.mesh();
  EXPECT_EQ(mesh.element_count(), 2u * 2u * 16u);
  // A ring: as many vertices and triangles as edges, 16 edges on the boundary.
  EXPECT_EQ(mesh.vertex_count() + mesh.element_count(), mesh.edge_count());
  std::size_t boundary = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e)
    boundary += mesh.is_boundary(EdgeId(e)) ? 1 : 0;
  EXPECT_EQ(boundary, 16u);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    EXPECT_EQ(check_validity(5, mesh.gather(ElementId(e))).status, Validity::valid);
  // Interpolation of fifth degree is of sixth order, in the region too.
  const Field fine = solution.field("u", 8, 5);
  const auto area_error = [](const TriangleMesh& of) {
    double area = 0;
    for (std::size_t e = 0; e < of.element_count(); ++e)
      area += bezel::area(5, of.gather(ElementId(e)));
    return std::fabs(area - 3 * pi);
  };
  const auto error = [&](const Field& of) { return error_norms(of, std::span(&log, 1)).l2; };
  EXPECT_GT(std::log2(area_error(mesh) / area_error(fine.mesh())), 5.5);
  EXPECT_NEAR(std::log2(error(field) / error(fine)), 6.0, 0.5);
  EXPECT_EQ(message_of([&] { (void)solution.field("u", 0, 2); }),
            "0 cells on 2 elements, expected at least 1 and no more than 1000000 triangles");
  EXPECT_EQ(message_of([&] { (void)solution.field("u", 1000, 2); }),
            "1000 cells on 2 elements, expected at least 1 and no more than 1000000 triangles");
  EXPECT_EQ(message_of([&] { (void)solution.field("u", 2, 11); }),
            "triangles of degree 11, expected 1 to 10");
}

TEST(Spectral, TheSameBitsForAnyNumberOfThreads) {
  const QuadMesh mesh = join(grid(3, 2));
  SpectralOptions options;
  options.degree = 5;
  options.threads = 1;
  const SpectralSolution one = solve_poisson(mesh, {harmonic}, options);
  options.threads = 4;
  const SpectralSolution four = solve_poisson(mesh, {harmonic}, options);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t k = 0; k < 36; ++k)
      ASSERT_EQ(one.values(ElementId(e))[k], four.values(ElementId(e))[k]);
}

TEST(Spectral, BadInput) {
  SpectralOptions options;
  EXPECT_EQ(message_of([&] { solve_poisson(square(2), {}); }),
            "the boundary values are empty, expected a function");
  options.degree = 61;
  EXPECT_EQ(message_of([&] { solve_poisson(square(2), {harmonic}, options); }),
            "a solution of degree 61, expected 1 to 60");
  EXPECT_EQ(message_of([&] { solve_poisson(square(2), {Formula("1/(x + y)")}); }),
            "the boundary value is inf at x = 1, y = -1, expected a finite value");
  EXPECT_EQ(message_of([&] {
              solve_poisson(square(2), {harmonic, [](double, double) { return std::nan(""); }});
            }),
            "the source is nan at x = -1, y = -1, expected a finite value");
  EXPECT_EQ(message_of([&] {
              solve_poisson(square(2), {harmonic, {}, [](double x, double) { return x + 1; }});
            }),
            "the coefficient is 0 at x = -1, y = -1, expected above 0");
  EXPECT_EQ(message_of([&] {
              solve_poisson(straight_map(2, {0, 0}, {0, 1}, {1, 1}, {1, 0}), {harmonic});
            }).substr(0, 40),
            "the jacobian determinant is -0.25 at xi ");
  const SpectralSolution solution = solve_poisson(square(2), {harmonic});
  EXPECT_EQ(message_of([&] { (void)solution.values(ElementId(1)); }),
            "element 1 does not exist, the solution has 1");
  EXPECT_EQ(message_of([&] { solution.evaluate(ElementId(0), std::nan(""), 0); }),
            "a parameter is not finite, expected finite xi and eta");
  EXPECT_EQ(message_of([&] { solution.errors({}, harmonic_gradient); }),
            "the exact solution or its gradient is empty, expected functions of x and y");
  EXPECT_EQ(message_of([&] { solution.errors(harmonic, harmonic_gradient, 181); }),
            "an error rule of degree 181, expected 1 to 180, or 0");
  // Three elements at one edge: a square, its neighbour, and the neighbour once more.
  const QuadMesh branching(1, {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {2, 2}, {3, 1}},
                           {NodeId(0), NodeId(1), NodeId(3), NodeId(4), NodeId(1), NodeId(2),
                            NodeId(4), NodeId(5), NodeId(1), NodeId(7), NodeId(4), NodeId(6)});
  EXPECT_EQ(message_of([&] { solve_poisson(branching, {harmonic}); }),
            "edge 1 has 3 elements, expected one or two");
}

}  // namespace
}  // namespace bezel
