// Transfer on straight meshes beside FreeFEM, where it is installed: processor time, error and mass
// defect on the same meshes with the same field. README.md here says how to read it.

#include <benchmark/benchmark.h>

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
/// method 0: values at the nodes, 1: projection. FreeFEM takes the least of three rounds.
template <std::size_t method>
void straight_freefem(benchmark::State& state) {
  const int p = static_cast<int>(state.range(0)), elements = static_cast<int>(state.range(1));
  peers::Transferred t{};
  for (auto _ : state) {
    const Meshes& m = meshes(elements);
    t = peers::freefem_transfer(*m.donor, *m.target, p, 3)[method];
    state.SetIterationTime(t.seconds);
  }
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
