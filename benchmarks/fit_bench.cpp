// Curve interpolation on the five cases of [bjontegaard2009]: time, iterations and the error
// reached. The degree follows the case: fit/equal_tangent/2/15 is case 2 with degree 15.

#include <benchmark/benchmark.h>

#include "bezel/fit/curve_interpolation.hpp"
#include "support/smooth_curves.hpp"

namespace {

using bezel::CurveInterpolator;
using bezel::CurveMethod;

void place(benchmark::State& state, CurveMethod method) {
  const CurveInterpolator interpolator;
  const bezel::PlaneCurve curve = bezel::testing::paper_curve(static_cast<int>(state.range(0)));
  const int degree = static_cast<int>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(interpolator.place(curve, degree, method));
  const auto found = interpolator.interpolate(curve, degree, method);
  state.counters["newton"] = found.nodes.newton_iterations;
  state.counters["least_squares"] = found.nodes.distance_iterations;
  state.counters["d2"] = found.errors.distance_l2;
  state.counters["error4"] = found.errors.l2;
}
void arguments(benchmark::internal::Benchmark* bench) {
  for (const int number : {1, 2, 3, 4, 5})
    for (const int degree : {5, 10, 15, 20, 30}) bench->Args({number, degree});
  bench->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(place, arc_length, CurveMethod::arc_length)->Apply(arguments);
BENCHMARK_CAPTURE(place, equal_tangent, CurveMethod::equal_tangent)->Apply(arguments);
BENCHMARK_CAPTURE(place, best, CurveMethod::best)->Apply(arguments);

void report(benchmark::State& state) {
  const CurveInterpolator interpolator;
  const bezel::PlaneCurve curve = bezel::testing::paper_curve(2);
  const auto found =
      interpolator.interpolate(curve, static_cast<int>(state.range(0)), CurveMethod::arc_length);
  for (auto _ : state) benchmark::DoNotOptimize(interpolator.errors<2>(curve, found.nodal));
}
BENCHMARK(report)->Arg(5)->Arg(15)->Arg(30)->Unit(benchmark::kMicrosecond);

void tables(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(CurveInterpolator(static_cast<int>(state.range(0))));
}
BENCHMARK(tables)->Arg(5)->Arg(10)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace
