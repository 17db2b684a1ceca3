// Evaluation of Bernstein polynomials in more than double precision, beside libqd, __float128 and
// MPFR in the same run (those that were found when building). Degrees 3, 5, 8, 15; 4096 points.
//
// Counters: s_per_point; error_random and error_ill, the largest relative errors against exact
// arithmetic on two sets of points of the same degree: random coefficients at random points, and
// next to a root of high multiplicity (condition numbers up to 1e25); of_peak, the operations of
// the algorithm (a fused product one) per second over those of a loop of a third fused products and
// two thirds sums, measured right before and after; executed_of_peak, without the operations on
// zeros that the vector code skips in the first row of the scheme.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval.hpp"

#ifdef BEZEL_BENCH_QD
#include <qd/dd_real.h>
#include <qd/qd_real.h>
#endif
#ifdef BEZEL_BENCH_MPFR
#include <mpfr.h>
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compensated_bench.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace peak::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Twelve independent chains, a third fused products and two thirds sums: 12 count operations.
double operations(std::size_t count) {
  const hn::ScalableTag<double> tag;
  const auto c = hn::Set(tag, 0.999), d = hn::Set(tag, 1e-3);
  // Different starts: equal chains would be one.
  const auto start = [&](double x) { return hn::Set(tag, x); };
  auto a0 = start(0.1), a1 = start(0.2), a2 = start(0.3), a3 = start(0.4), a4 = start(0.5),
       a5 = start(0.6), a6 = start(0.7), a7 = start(0.8), a8 = start(0.9), a9 = start(1.1),
       a10 = start(1.2), a11 = start(1.3);
  for (std::size_t i = 0; i < count; ++i) {
    a0 = hn::MulAdd(a0, c, d);
    a1 = hn::Add(a1, d);
    a2 = hn::Add(a2, d);
    a3 = hn::MulAdd(a3, c, d);
    a4 = hn::Add(a4, d);
    a5 = hn::Add(a5, d);
    a6 = hn::MulAdd(a6, c, d);
    a7 = hn::Add(a7, d);
    a8 = hn::Add(a8, d);
    a9 = hn::MulAdd(a9, c, d);
    a10 = hn::Add(a10, d);
    a11 = hn::Add(a11, d);
  }
  const auto sum = hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)),
                           hn::Add(hn::Add(hn::Add(a4, a5), hn::Add(a6, a7)),
                                   hn::Add(hn::Add(a8, a9), hn::Add(a10, a11))));
  return hn::GetLane(sum);
}
std::size_t lanes() {
  return hn::Lanes(hn::ScalableTag<double>());
}

}  // namespace peak::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace peak {

HWY_EXPORT(operations);
HWY_EXPORT(lanes);

/// Double operations per second of all lanes; the median of a few short runs, now.
double per_second() {
  constexpr std::size_t count = 20000;
  std::array<double, 9> rate{};
  for (double& r : rate) {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(operations)(count));
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    r = 12.0 * count / time.count();
  }
  std::nth_element(rate.begin(), rate.begin() + 4, rate.end());
  return rate[4] * static_cast<double>(HWY_DYNAMIC_DISPATCH(lanes)());
}

}  // namespace peak

namespace {

using namespace bezel::bernstein;
using Doubles = std::vector<double>;

constexpr std::size_t points = 4096;

struct Problem {
  Doubles b, s, exact;  // exact: correctly rounded values
};

Problem finish(Doubles b, Doubles s) {
  Problem p{std::move(b), std::move(s), {}};
  const ExactPolynomial exact(p.b);
  for (const double x : p.s) p.exact.push_back(exact(bezel::Dyadic(x)).to_double());
  return p;
}

/// Uniform coefficients in [-1, 1] at uniform points.
const Problem& random_problem(int n) {
  static std::map<int, Problem> made;
  auto found = made.find(n);
  if (found == made.end()) {
    bezel::RandomStream random("compensated_bench", static_cast<std::uint64_t>(n));
    Doubles b, s;
    for (int j = 0; j <= n; ++j) b.push_back(2.0 * random.uniform() - 1.0);
    for (std::size_t q = 0; q < points; ++q) s.push_back(random.uniform());
    found = made.emplace(n, finish(std::move(b), std::move(s))).first;
  }
  return found->second;
}

/// (s - 1) (s - 3/4)^(n-1) at 3/4 -+ x, x from 2^-3 down to where the condition number is 1e25.
const Problem& ill_problem(int n) {
  static std::map<int, Problem> made;
  auto found = made.find(n);
  if (found == made.end()) {
    Doubles b{-1.0, 0.0};
    for (int k = 1; k < n; ++k) b = multiply(b, Doubles{-3.0, 1.0});  // 4 (s - 3/4)
    bezel::RandomStream random("compensated_bench ill", static_cast<std::uint64_t>(n));
    const double deepest = std::min(40.0, 80.0 / (n - 1));
    Doubles s;
    for (std::size_t q = 0; q < points; ++q) {
      const double x = std::exp2(-3.0 - deepest * random.uniform());
      s.push_back(q % 2 == 0 ? 0.75 + x : 0.75 - x);
    }
    found = made.emplace(n, finish(std::move(b), std::move(s))).first;
  }
  return found->second;
}

double largest_error(const Problem& p, const Doubles& found) {
  double largest = 0.0;
  for (std::size_t q = 0; q < found.size(); ++q)
    if (p.exact[q] != 0.0)
      largest = std::max(largest, std::fabs((found[q] - p.exact[q]) / p.exact[q]));
  return largest;
}

/// Times run(b, s, out) and records the errors; flops per point, 0 when not known, of which some
/// are skipped.
template <class Run>
void measure(benchmark::State& state, const Run& run, std::size_t count, double flops = 0.0,
             double skipped = 0.0) {
  const int n = static_cast<int>(state.range(0));
  const auto take = [&](const Problem& p) {
    return Problem{p.b, Doubles(p.s.begin(), p.s.begin() + static_cast<std::ptrdiff_t>(count)),
                   p.exact};
  };
  const Problem random = take(random_problem(n)), ill = take(ill_problem(n));
  Doubles out(count);
  const double before =
      flops > 0.0 ? peak::per_second() : 0.0;  // the clock of a busy machine drifts
  for (auto _ : state) {
    run(random.b, random.s, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.counters["s_per_point"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
  if (flops > 0.0) {
    const double rate = 0.5 * (before + peak::per_second());
    const auto share = [&](double operations) {
      return benchmark::Counter(static_cast<double>(count) * operations / rate,
                                benchmark::Counter::kIsIterationInvariantRate);
    };
    state.counters["of_peak"] = share(flops);
    state.counters["executed_of_peak"] = share(flops - skipped);
  }
  run(random.b, random.s, out);
  state.counters["error_random"] = largest_error(random, out);
  run(ill.b, ill.s, out);
  state.counters["error_ill"] = largest_error(ill, out);
}

void degrees(benchmark::internal::Benchmark* b) {
  for (const int n : {3, 5, 8, 15}) b->Arg(n);
}

void peak_rate(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(peak::operations)(10000));
  state.counters["operations_per_s"] = peak::per_second();
}
BENCHMARK(peak_rate)->Name("peak");

void plain(benchmark::State& state) {
  const double n = static_cast<double>(state.range(0));
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) { evaluate_compensated(b, s, out, 1); },
      points, 1.5 * n * (n + 1) + 1);
}
BENCHMARK(plain)->Name("bezel/plain")->Apply(degrees);

/// By Horner's scheme.
void horner(benchmark::State& state) {
  const double n = static_cast<double>(state.range(0));
  measure(
      state, [](const Doubles& b, const Doubles& s, Doubles& out) { evaluate(b, s, out); }, points,
      4 * n);
}
BENCHMARK(horner)->Name("bezel/evaluate")->Apply(degrees);

template <int K>
void compensated(benchmark::State& state) {
  const double skipped_per_update = K == 2 ? 4.0 : K == 3 ? 26.0 : 80.0;
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) { evaluate_compensated(b, s, out, K); },
      points, compensated_flops(static_cast<int>(state.range(0)), K).fused,
      skipped_per_update * static_cast<double>(state.range(0)));
}
BENCHMARK(compensated<2>)->Name("bezel/K2")->Apply(degrees);
BENCHMARK(compensated<3>)->Name("bezel/K3")->Apply(degrees);
BENCHMARK(compensated<4>)->Name("bezel/K4")->Apply(degrees);

void certified(benchmark::State& state) {
  Doubles bound(points);
  measure(
      state,
      [&](const Doubles& b, const Doubles& s, Doubles& out) {
        evaluate_certified(b, s, out, bound);
      },
      points);
}
BENCHMARK(certified)->Name("bezel/certified")->Apply(degrees);

template <int K>
void single(benchmark::State& state) {
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) {
        for (std::size_t q = 0; q < s.size(); ++q)
          out[q] = evaluate_compensated(std::span<const double>(b), s[q], K);
      },
      points);
}
BENCHMARK(single<2>)->Name("bezel/K2 one by one")->Apply(degrees);
BENCHMARK(single<4>)->Name("bezel/K4 one by one")->Apply(degrees);

void certified_single(benchmark::State& state) {
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) {
        for (std::size_t q = 0; q < s.size(); ++q) out[q] = evaluate_certified(b, s[q]).value;
      },
      points);
}
BENCHMARK(certified_single)->Name("bezel/certified one by one")->Apply(degrees);

/// De Casteljau in another number type, rounded at the end.
template <class Number, class Round>
void de_casteljau(const Doubles& b, const Doubles& s, Doubles& out, const Round& round) {
  std::array<Number, 16> w;
  for (std::size_t q = 0; q < s.size(); ++q) {
    const Number t(s[q]), r = Number(1.0) - t;
    for (std::size_t j = 0; j < b.size(); ++j) w[j] = Number(b[j]);
    for (std::size_t m = b.size() - 1; m > 0; --m)
      for (std::size_t j = 0; j < m; ++j) w[j] = r * w[j] + t * w[j + 1];
    out[q] = round(w[0]);
  }
}

#ifdef BEZEL_BENCH_QD
template <class Number>
void libqd(benchmark::State& state) {
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) {
        de_casteljau<Number>(b, s, out, [](const Number& x) { return to_double(x); });
      },
      512);
}
BENCHMARK(libqd<dd_real>)->Name("libqd/dd_real")->Apply(degrees);
BENCHMARK(libqd<qd_real>)->Name("libqd/qd_real")->Apply(degrees);
#endif

#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
void float128(benchmark::State& state) {
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) {
        de_casteljau<Quad>(b, s, out, [](const Quad& x) { return static_cast<double>(x); });
      },
      512);
}
BENCHMARK(float128)->Name("gcc/__float128")->Apply(degrees);
#endif

#ifdef BEZEL_BENCH_MPFR
template <int bits>
void mpfr(benchmark::State& state) {
  measure(
      state,
      [](const Doubles& b, const Doubles& s, Doubles& out) {
        std::array<mpfr_t, 16> w;
        mpfr_t t, r, p;
        mpfr_inits2(bits, t, r, p, static_cast<mpfr_ptr>(nullptr));
        for (auto& x : w) mpfr_init2(x, bits);
        for (std::size_t q = 0; q < s.size(); ++q) {
          mpfr_set_d(t, s[q], MPFR_RNDN);
          mpfr_ui_sub(r, 1, t, MPFR_RNDN);
          for (std::size_t j = 0; j < b.size(); ++j) mpfr_set_d(w[j], b[j], MPFR_RNDN);
          for (std::size_t m = b.size() - 1; m > 0; --m)
            for (std::size_t j = 0; j < m; ++j) {
              mpfr_mul(p, r, w[j], MPFR_RNDN);
              mpfr_mul(w[j], t, w[j + 1], MPFR_RNDN);
              mpfr_add(w[j], w[j], p, MPFR_RNDN);
            }
          out[q] = mpfr_get_d(w[0], MPFR_RNDN);
        }
        for (auto& x : w) mpfr_clear(x);
        mpfr_clears(t, r, p, static_cast<mpfr_ptr>(nullptr));
      },
      512);
}
BENCHMARK(mpfr<106>)->Name("mpfr/106 bits")->Apply(degrees);
BENCHMARK(mpfr<159>)->Name("mpfr/159 bits")->Apply(degrees);
BENCHMARK(mpfr<212>)->Name("mpfr/212 bits")->Apply(degrees);
#endif

}  // namespace
#endif  // HWY_ONCE
