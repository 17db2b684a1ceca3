// Transfer on straight meshes beside FreeFEM, where it is installed: processor time, error and mass
// defect on the same meshes with the same field. README.md here says how to read it.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#ifdef BEZEL_FREEFEM
#include "peers/freefem.hpp"
#endif

namespace {

using namespace bezel;

struct Meshes {
  std::shared_ptr<const TriangleMesh> donor, target;
};

/// Two straight meshes of one square with about `elements` triangles each.
const Meshes& meshes(int elements) {
  static std::map<int, Meshes> made;
  Meshes& m = made[elements];
  if (!m.donor) {
    GenerateOptions options;
    options.size = std::sqrt(4.0 / (0.433 * elements));
    options.seed = 1;
    m.donor = std::make_shared<const TriangleMesh>(generate_rectangle(2.0, 2.0, options));
    options.seed = 2;
    m.target = std::make_shared<const TriangleMesh>(generate_rectangle(2.0, 2.0, options));
  }
  return m;
}

/// The whole of transfer() on straight meshes, report and all, as the peers are timed.
void straight_bezel(benchmark::State& state) {
  const Meshes& m = meshes(static_cast<int>(state.range(1)));
  const Formula wave("exp(x^2) + 2*y");
  const Field field = sample(
      "wave", Space::discontinuous(m.donor, static_cast<int>(state.range(0)), Basis::physical),
      {&wave, 1});
  TransferOptions options;
  options.threads = 1;
  TransferResult result;
  for (auto _ : state) result = transfer({&field, 1}, m.target, options);
  state.counters["l2_error"] = error_norms(result.fields[0], {&wave, 1}).l2_relative;
  state.counters["mass_defect"] = result.report.fields[0].relative_mass_defect;
}

#ifdef BEZEL_FREEFEM
/// One run of FreeFEM serves both methods: the least of three rounds, one round for large meshes.
const std::array<peers::Transferred, 2>& freefem_results(int p, int elements) {
  static std::map<std::array<int, 2>, std::array<peers::Transferred, 2>> done;
  if (!done.count({p, elements})) {
    const Meshes& m = meshes(elements);
    done[{p, elements}] = peers::freefem_transfer(*m.donor, *m.target, p, elements > 10000 ? 1 : 3);
  }
  return done[{p, elements}];
}

/// method 0: values at the nodes, 1: projection.
template <std::size_t method>
void straight_freefem(benchmark::State& state) {
  const peers::Transferred& t =
      freefem_results(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)))[method];
  for (auto _ : state) state.SetIterationTime(t.seconds);
  state.counters["l2_error"] = t.l2_relative;
  state.counters["mass_defect"] = t.mass_defect;
}
#endif

}  // namespace

BENCHMARK(straight_bezel)
    ->Name("straight/bezel")
    ->ArgNames({"p", "elements"})
    ->ArgsProduct({{1, 2, 3}, {1000, 10000, 100000}})
    ->Unit(benchmark::kMillisecond);
#ifdef BEZEL_FREEFEM
BENCHMARK(straight_freefem<0>)
    ->Name("straight/freefem interpolation")
    ->ArgNames({"p", "elements"})
    ->ArgsProduct({{1, 2, 3}, {1000, 10000, 100000}})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(straight_freefem<1>)
    ->Name("straight/freefem projection")
    ->ArgNames({"p", "elements"})
    ->ArgsProduct({{1, 2, 3}, {1000, 10000, 100000}})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
#endif
