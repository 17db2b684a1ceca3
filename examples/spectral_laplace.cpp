// Laplace's equation in a region with a curved top: map, proof that it is valid, solution, error.
#include <cmath>
#include <cstdio>

#include "bezel/solve/spectral.hpp"

int main() {
  using namespace bezel;
  const auto u = [](double x, double y) { return std::exp(x) * std::sin(y); };
  const auto gradient = [](double x, double y) {
    return Vec2{std::exp(x) * std::sin(y), std::exp(x) * std::cos(y)};
  };
  // Curves on [-1, 1] with their first and second derivatives.
  const auto segment = [](Vec2 a, Vec2 b) {
    return PlaneCurve([=](double t) {
      return CurveJet<2>{0.5 * (1 - t) * a + 0.5 * (1 + t) * b, 0.5 * (b - a), Vec2{0.0, 0.0}};
    });
  };
  const PlaneCurve top([](double t) {  // Runge's function
    const double y = 1 / (1 + 16 * t * t), d = -32 * t * y * y;
    return CurveJet<2>{Vec2{t, y}, Vec2{1.0, d}, Vec2{0.0, -32 * y * y - 64 * t * y * d}};
  });
  const QuadCurves sides{segment({-1, -1}, {1, -1}), segment({1, -1}, top(1).x), top,
                         segment({-1, -1}, top(-1).x)};
  const double area = 2 + 0.5 * std::atan(4.0);

  for (const CurveMethod method : {CurveMethod::standard, CurveMethod::best}) {
    const GordonHall map = gordon_hall(sides, 16, method);
    const bool valid = check_quad_validity(16, map.control()).status == Validity::valid;
    const SpectralSolution solution = solve_poisson(map, {u});
    std::printf("%-8s  valid %s  area error %.0e  energy error %.0e\n", name(method).data(),
                valid ? "yes" : "no", std::fabs(map.area() - area),
                solution.errors(u, gradient).energy);
  }
}
