// Laplace's equation on the unit square by one spectral element: time and error of one solve.

#include <benchmark/benchmark.h>

#include <cmath>

#include "bezel/solve/spectral.hpp"

namespace {

using namespace bezel;

double u(double x, double y) {
  return std::exp(x) * std::sin(y);
}
Vec2 grad(double x, double y) {
  return {std::exp(x) * std::sin(y), std::exp(x) * std::cos(y)};
}

/// [-1, 1]^2 with a top side bent by `height`.
GordonHall bent_square(int degree, double height) {
  const LobattoBasis basis(degree);
  QuadSides sides;
  for (const double xi : basis.nodes()) {
    sides.bottom.push_back(Vec2{xi, -1.0});
    sides.top.push_back(Vec2{xi, 1.0 + height * (1.0 - xi * xi)});
    sides.left.push_back(Vec2{-1.0, xi});
    sides.right.push_back(Vec2{1.0, xi});
  }
  return GordonHall(sides);
}

void solve_one(benchmark::State& state) {
  const int degree = static_cast<int>(state.range(0));
  SpectralOptions options;
  options.threads = 1;
  double height = 0.1;
  for (auto _ : state) {
    height = height < 0.3 ? height + 0.01 : 0.1;  // not the same numbers each time
    benchmark::DoNotOptimize(solve_poisson(bent_square(degree, height), {u}, options));
  }
  state.counters["energy_error"] =
      solve_poisson(bent_square(degree, 0.2), {u}, options).errors(u, grad).energy;
}
BENCHMARK(solve_one)->Arg(8)->Arg(16)->Arg(24)->Unit(benchmark::kMillisecond);

void solve_grid(benchmark::State& state) {
  const int cells = static_cast<int>(state.range(0));
  std::vector<GordonHall> maps;
  const double h = 2.0 / cells;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Vec2 a{i * h - 1.0, j * h - 1.0}, x{h, 0.0}, y{0.0, h};
      maps.push_back(GordonHall({{a, a + x}, {a + x, a + x + y}, {a + y, a + x + y}, {a, a + y}}));
    }
  const QuadMesh mesh = join(maps);
  SpectralOptions options;
  options.degree = 8;
  options.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(solve_poisson(mesh, {u}, options));
  const SpectralSolution solution = solve_poisson(mesh, {u}, options);
  state.counters["unknowns"] = static_cast<double>(solution.unknown_count());
  state.counters["energy_error"] = solution.errors(u, grad).energy;
}
BENCHMARK(solve_grid)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);

void validity(benchmark::State& state) {
  const std::vector<Vec2> control = bent_square(static_cast<int>(state.range(0)), 0.2).control();
  const int degree = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(check_quad_validity(degree, control));
}
BENCHMARK(validity)->Arg(2)->Arg(8)->Arg(24)->Unit(benchmark::kMicrosecond);

}  // namespace
