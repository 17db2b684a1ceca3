// Cost of conservative transfer: element pairs per second by mesh size, geometric degree, field
// degree and basis. Error and conservation are reported beside the time.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"

namespace {

using namespace bezel;

struct Meshes {
  std::shared_ptr<const TriangleMesh> donor, target;
};

/// A square and a disc inside it with about `elements` triangles each.
const Meshes& meshes(int donor_degree, int target_degree, int elements) {
  static std::map<std::array<int, 3>, Meshes> made;
  Meshes& m = made[{donor_degree, target_degree, elements}];
  if (!m.donor) {
    GenerateOptions options;
    options.degree = donor_degree;
    options.curve_jitter = donor_degree > 1 ? 0.05 : 0.0;
    options.seed = 1;
    options.size = std::sqrt(2.125 * 2.125 / (0.433 * elements));
    m.donor = std::make_shared<const TriangleMesh>(generate_rectangle(2.125, 2.125, options));
    options.degree = target_degree;
    options.curve_jitter = target_degree > 1 ? 0.05 : 0.0;
    options.seed = 2;
    options.size = std::sqrt(3.14159 / (0.433 * elements));
    m.target = std::make_shared<const TriangleMesh>(generate_disc(1.0, options));
  }
  return m;
}

/// The middle of some numbers: an iteration that something else on the machine slowed down does not
/// count.
class Median {
 public:
  void add(double x) { all_.push_back(x); }
  double value() const {
    std::vector<double> sorted = all_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  std::vector<double> all_;
};

/// Times by phase of many transfers. Mpairs_per_s counts the time of the kernels (overlay,
/// integration, solution), whole_Mpairs_per_s all time from the call to the result.
class Phases {
 public:
  void add(const TransferReport& report) {
    const TransferReport::Seconds& s = report.seconds;
    const std::array<double, 7> seconds = {
        s.overlay, s.integrate, s.solve, s.prepare, s.report, s.overlay + s.integrate + s.solve,
        s.total};
    for (std::size_t i = 0; i < seconds.size(); ++i) phase_[i].add(seconds[i]);
    pairs_ = static_cast<double>(report.pairs);
  }
  void write(benchmark::State& state) const {
    constexpr std::array<const char*, 5> names = {"overlay", "integrate", "solve", "prepare",
                                                  "report"};
    state.counters["pairs"] = pairs_;
    state.counters["Mpairs_per_s"] = 1e-6 * pairs_ / phase_[5].value();
    state.counters["whole_Mpairs_per_s"] = 1e-6 * pairs_ / phase_[6].value();
    for (std::size_t i = 0; i < names.size(); ++i) {
      state.counters[std::string(names[i]) + "_ns_per_pair"] = 1e9 * phase_[i].value() / pairs_;
    }
  }

 private:
  std::array<Median, 7> phase_;
  double pairs_ = 0.0;
};

void run(benchmark::State& state, const Meshes& m, int donor_degree, Basis from,
         const TransferOptions& options) {
  const Formula wave("exp(x^2) + 2*y");
  const Field field =
      project("wave", Space::discontinuous(m.donor, donor_degree, from), {&wave, 1});
  TransferResult result;
  Phases phases;
  for (auto _ : state) {
    result = transfer({&field, 1}, m.target, options);
    phases.add(result.report);
  }
  phases.write(state);
  state.counters["mass_defect"] = result.report.fields[0].relative_mass_defect;
  state.counters["partition"] = result.report.max_partition_residual;
  state.counters["l2_error"] = error_norms(result.fields[0], {&wave, 1}).l2_relative;
}

Basis basis_of(std::int64_t reference) {
  return reference == 0 ? Basis::physical : Basis::reference;
}

void transfer_pairs(benchmark::State& state) {
  const int g = static_cast<int>(state.range(0));
  TransferOptions options;
  options.threads = 1;
  run(state, meshes(g, g, static_cast<int>(state.range(3))), static_cast<int>(state.range(1)),
      basis_of(state.range(2)), options);
}

/// Another geometric degree, field degree and basis on the target.
void transfer_mixed(benchmark::State& state) {
  TransferOptions options;
  options.threads = 1;
  options.degree = static_cast<int>(state.range(4));
  options.same_basis = false;
  options.basis = basis_of(state.range(5));
  run(state,
      meshes(static_cast<int>(state.range(0)), static_cast<int>(state.range(3)),
             static_cast<int>(state.range(6))),
      static_cast<int>(state.range(1)), basis_of(state.range(2)), options);
}

/// Many fields in one pass: time per field against that of one.
void transfer_fields(benchmark::State& state) {
  const Meshes& m =
      meshes(static_cast<int>(state.range(0)), static_cast<int>(state.range(0)), 10000);
  const auto space =
      Space::discontinuous(m.donor, static_cast<int>(state.range(1)), Basis::physical);
  std::vector<Field> fields;
  for (int k = 0; k < state.range(2); ++k) {
    std::string text = "exp(x^2) + 2*y + sin(x*";
    text.append(std::to_string(k)).append(")");
    const Formula wave(text);
    fields.push_back(sample(text, space, {&wave, 1}));
  }
  TransferOptions options;
  options.threads = 1;
  double defect = 0.0;
  Phases phases;
  for (auto _ : state) {
    const TransferResult result = transfer(fields, m.target, options);
    phases.add(result.report);
    for (const FieldReport& f : result.report.fields)
      defect = std::max(defect, f.relative_mass_defect);
  }
  phases.write(state);
  state.counters["mass_defect"] = defect;
}

}  // namespace

BENCHMARK(transfer_fields)
    ->ArgNames({"g", "p", "fields"})
    ->ArgsProduct({{1}, {1, 2, 3}, {1, 30}})
    ->ArgsProduct({{2}, {2}, {1, 30}})
    ->ArgsProduct({{3}, {3}, {1, 30}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(transfer_pairs)
    ->ArgNames({"g", "p", "reference", "elements"})
    ->ArgsProduct({{1}, {1, 2, 3}, {0}, {1000, 10000}})
    ->Args({2, 2, 0, 1000})
    ->Args({2, 2, 0, 10000})
    ->Args({3, 3, 0, 1000})
    ->Args({3, 3, 0, 10000})
    ->Args({2, 2, 1, 1000})
    ->Args({3, 3, 1, 1000})
    ->Args({2, 2, 1, 10000})
    ->Args({3, 3, 1, 10000})
    ->Args({4, 2, 0, 1000})
    ->Args({5, 3, 0, 1000})
    ->Args({2, 4, 0, 1000})
    ->Args({2, 6, 0, 1000})
    ->Args({1, 8, 0, 1000})
    ->Args({1, 1, 0, 100000})
    ->Args({1, 2, 0, 100000})
    ->Args({1, 3, 0, 100000})
    ->Args({2, 2, 0, 100000})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(transfer_mixed)
    ->ArgNames({"g", "p", "reference", "to_g", "to_p", "to_reference", "elements"})
    ->Args({2, 2, 1, 2, 2, 0, 10000})
    ->Args({2, 2, 0, 2, 2, 1, 10000})
    ->Args({3, 3, 1, 3, 3, 0, 10000})
    ->Args({3, 3, 0, 3, 3, 1, 10000})
    ->Args({2, 3, 0, 2, 2, 0, 10000})
    ->Args({3, 2, 0, 2, 2, 0, 10000})
    ->Args({3, 3, 1, 2, 2, 1, 10000})
    ->Unit(benchmark::kMillisecond);
