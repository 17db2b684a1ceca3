// Intersection of Bezier curves, evaluation at many points and point location, beside lyon_geom and
// lib2geom in the same run (those that were found when building): see README.md here.
//
// Counters of the intersections: s_per_pair; roots, the true ones; missed and extra ones; failed,
// calls that threw or panicked; unresolved, boxes and tangencies that Bezel reported; error_median,
// error_99 and error_max, parameter errors of the roots found, in units of u * condition.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/triangle.hpp"
#include "intersection_truth.hpp"
#include "peers/peers.hpp"

namespace {

using bezel::Lambda;
using bezel::Vec2;
using peers::Parameters;
using truth::Curve;

// -- Intersection

struct Bezel {
  bezel::CurveIntersections out;
  std::size_t unresolved = 0;

  bool operator()(Curve a, Curve b, std::vector<Parameters>& found) {
    bezel::intersect(a, b, {}, out);
    found.clear();
    for (const bezel::Crossing& c : out.crossings) found.push_back({c.s, c.t});
    unresolved += out.unresolved.size() + out.tangencies.size() + out.overlaps.size();
    return true;
  }
};
#ifdef BEZEL_BENCH_LYON
struct Lyon {
  std::size_t unresolved = 0;
  bool operator()(Curve a, Curve b, std::vector<Parameters>& found) {
    return peers::lyon_intersect(a, b, found);
  }
};
#endif
#ifdef BEZEL_BENCH_LIB2GEOM
template <int digits>
struct Lib2geom {
  std::size_t unresolved = 0;
  bool operator()(Curve a, Curve b, std::vector<Parameters>& found) {
    constexpr double precision = digits == 0 ? peers::lib2geom_default : 1e-12;
    return peers::lib2geom_intersect(a, b, precision, found);
  }
};
#endif

struct Problem {
  truth::Pairs pairs;
  std::vector<std::vector<truth::TrueRoot>> roots;
};

Problem make_problem(int degree, int bits, std::size_t count) {
  Problem p{truth::random_pairs(degree, count, bits), {}};
  std::vector<Parameters> found;
  for (std::size_t i = 0; i < p.pairs.size(); ++i) {
    const truth::Pair pair = p.pairs[i];
    std::vector<truth::TrueRoot> roots;
    const auto take = [&](auto&& library) {
      if (!library(pair.a, pair.b, found)) return;
      for (const Parameters& f : found) truth::add_root(pair, f, roots);
    };
    take(Bezel{});
#ifdef BEZEL_BENCH_LYON
    if (degree == 2 || degree == 3) take(Lyon{});
#endif
#ifdef BEZEL_BENCH_LIB2GEOM
    take(Lib2geom<0>{});
    take(Lib2geom<12>{});
#endif
    p.roots.push_back(std::move(roots));
  }
  return p;
}

/// Arguments: degree, bits (0: unrelated curves, else see random_pairs), number of pairs.
const Problem& problem(const benchmark::State& state) {
  static std::map<std::array<std::int64_t, 3>, Problem> made;
  const std::array<std::int64_t, 3> key{state.range(0), state.range(1), state.range(2)};
  auto found = made.find(key);
  if (found == made.end())
    found = made.emplace(key, make_problem(static_cast<int>(key[0]), static_cast<int>(key[1]),
                                           static_cast<std::size_t>(key[2])))
                .first;
  return found->second;
}

template <class Library>
void intersect(benchmark::State& state) {
  const Problem& p = problem(state);
  Library library;
  std::vector<Parameters> found;
  for (auto _ : state)
    for (std::size_t i = 0; i < p.pairs.size(); ++i) {
      benchmark::DoNotOptimize(library(p.pairs[i].a, p.pairs[i].b, found));
      benchmark::DoNotOptimize(found.data());
    }
  state.counters["s_per_pair"] = benchmark::Counter(
      static_cast<double>(p.pairs.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  truth::Score score;
  std::size_t failed = 0;
  library.unresolved = 0;
  for (std::size_t i = 0; i < p.pairs.size(); ++i) {
    if (!library(p.pairs[i].a, p.pairs[i].b, found)) ++failed;
    score.add(p.roots[i], found);
  }
  state.counters["roots"] = static_cast<double>(score.roots);
  state.counters["missed"] = static_cast<double>(score.missed);
  state.counters["extra"] = static_cast<double>(score.extra);
  state.counters["failed"] = static_cast<double>(failed);
  state.counters["unresolved"] = static_cast<double>(library.unresolved);
  state.counters["error_median"] = score.error_of(0.5);
  state.counters["error_99"] = score.error_of(0.99);
  state.counters["error_max"] = score.error_of(1.0);
}

constexpr int random_count = 100000, close_count = 1000;
void low_degrees(benchmark::internal::Benchmark* b) {
  b->ArgNames({"degree", "bits", "pairs"})->Unit(benchmark::kMillisecond);
  for (const int degree : {2, 3}) b->Args({degree, 0, random_count});
  for (const int degree : {2, 3}) b->Args({degree, 20, close_count});
}
void all_degrees(benchmark::internal::Benchmark* b) {
  low_degrees(b);
  b->Args({5, 0, random_count})->Args({5, 20, close_count});
}
BENCHMARK(intersect<Bezel>)->Name("bezel/intersect")->Apply(all_degrees);
#ifdef BEZEL_BENCH_LYON
BENCHMARK(intersect<Lyon>)->Name("lyon_geom/intersect")->Apply(low_degrees);
#endif
#ifdef BEZEL_BENCH_LIB2GEOM
BENCHMARK(intersect<Lib2geom<0>>)->Name("lib2geom/intersect")->Apply(all_degrees);
BENCHMARK(intersect<Lib2geom<12>>)->Name("lib2geom/intersect to 1e-12")->Apply(all_degrees);
#endif

// -- Points of a plane curve. Counters: s_per_point (both coordinates); error_max, in u of the
// largest coordinate, against a compensated evaluation.

constexpr std::size_t sample_count = 4096;

std::vector<Vec2> curve_of(int degree) {
  const truth::Pairs pairs = truth::random_pairs(degree, 1, 0);
  return {pairs[0].a.begin(), pairs[0].a.end()};
}
std::vector<double> samples() {
  bezel::RandomStream random("geometry_bench samples", 1);
  std::vector<double> s(sample_count);
  for (double& x : s) x = random.uniform();
  return s;
}

/// run(curve, s) returns the points.
template <class Run>
void evaluate(benchmark::State& state, const Run& run) {
  const std::vector<Vec2> c = curve_of(static_cast<int>(state.range(0)));
  const std::vector<double> s = samples();
  std::vector<Vec2> out(s.size());
  run(state, c, s, out);
  state.counters["s_per_point"] = benchmark::Counter(
      static_cast<double>(s.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  double worst = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      std::vector<double> x;
      for (const Vec2& p : c) x.push_back(p[k]);
      const double exact =
          bezel::bernstein::evaluate_compensated(std::span<const double>(x), s[i], 2);
      worst = std::max(
          worst, std::fabs(out[i][k] - exact) / (0x1p-53 * *std::max_element(x.begin(), x.end())));
    }
  state.counters["error_max"] = worst;
}
void evaluate_bezel(benchmark::State& state) {
  evaluate(state, [](benchmark::State& loop, const std::vector<Vec2>& c,
                     const std::vector<double>& s, std::vector<Vec2>& out) {
    std::vector<double> px(s.size()), py(s.size());
    for (auto _ : loop) {
      bezel::bernstein::evaluate(c, s, px, py);
      benchmark::DoNotOptimize(px.data());
      benchmark::DoNotOptimize(py.data());
      benchmark::ClobberMemory();
    }
    for (std::size_t i = 0; i < s.size(); ++i) out[i] = Vec2{{px[i], py[i]}};
  });
}
BENCHMARK(evaluate_bezel)->Name("bezel/evaluate")->ArgName("degree")->Arg(3)->Arg(10);
#ifdef BEZEL_BENCH_LYON
void evaluate_lyon(benchmark::State& state) {
  evaluate(state, [](benchmark::State& loop, const std::vector<Vec2>& c,
                     const std::vector<double>& s, std::vector<Vec2>& out) {
    for (auto _ : loop) {
      peers::peer_lyon_sample(c[0].c.data(), s.data(), s.size(), out[0].c.data());
      benchmark::ClobberMemory();
    }
  });
}
BENCHMARK(evaluate_lyon)->Name("lyon_geom/evaluate")->ArgName("degree")->Arg(3);
#endif
#ifdef BEZEL_BENCH_LIB2GEOM
void evaluate_lib2geom(benchmark::State& state) {
  evaluate(state, [](benchmark::State& loop, const std::vector<Vec2>& c,
                     const std::vector<double>& s, std::vector<Vec2>& out) {
    for (auto _ : loop) {
      peers::lib2geom_evaluate(c, s, out);
      benchmark::ClobberMemory();
    }
  });
}
BENCHMARK(evaluate_lib2geom)->Name("lib2geom/evaluate")->ArgName("degree")->Arg(3)->Arg(10);
#endif

// -- Points inside curved triangles. Counters: s_per_point; missed, points not found inside;
// residual_max, distance of the point found from the one asked for, in u (the triangles' size is
// 1).

/// The unit triangle's nodes, each moved by up to 0.15 / g.
std::vector<Vec2> triangle_of(bezel::RandomStream& random, int g) {
  std::vector<Vec2> net;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j) {
      const double dx = random.uniform(-0.15, 0.15), dy = random.uniform(-0.15, 0.15);
      net.push_back(Vec2{{(j + dx) / g, (k + dy) / g}});
    }
  return net;
}
Vec2 point_inside(bezel::RandomStream& random, int g, const std::vector<Vec2>& net) {
  double l1 = random.uniform(), l2 = random.uniform();
  if (l1 + l2 > 1) {
    l1 = 1 - l1;
    l2 = 1 - l2;
  }
  const Lambda lambda{1 - l1 - l2, l1, l2};
  Vec2 p;
  for (int k = 0; k < 2; ++k) {
    std::vector<double> x;
    for (const Vec2& c : net) x.push_back(c[k]);
    p[k] = bezel::bernstein::evaluate(g, std::span<const double>(x), lambda);
  }
  return p;
}

void report_points(benchmark::State& state, std::size_t count) {
  state.counters["s_per_point"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}
void report_located(benchmark::State& state, const std::vector<bezel::LocateResult>& found) {
  report_points(state, found.size());
  double missed = 0, worst = 0;
  for (const bezel::LocateResult& r : found) {
    missed += r.status == bezel::Location::inside ? 0.0 : 1.0;
    worst = std::max(worst, r.residual);
  }
  state.counters["missed"] = missed;
  state.counters["residual_max"] = worst / 0x1p-53;
}

/// One point in each of many triangles, in random order.
void locate(benchmark::State& state) {
  const int g = static_cast<int>(state.range(0));
  bezel::RandomStream random("geometry_bench locate", static_cast<std::uint64_t>(g));
  std::vector<std::vector<Vec2>> nets;
  for (int i = 0; i < 256; ++i) nets.push_back(triangle_of(random, g));
  std::vector<std::size_t> which;
  std::vector<Vec2> points;
  for (int i = 0; i < 4096; ++i) {
    which.push_back(static_cast<std::size_t>(random.below(nets.size())));
    points.push_back(point_inside(random, g, nets[which.back()]));
  }
  std::vector<bezel::LocateResult> out(points.size());
  for (auto _ : state) {
    for (std::size_t i = 0; i < points.size(); ++i)
      out[i] = bezel::locate(g, nets[which[i]], points[i]);
    benchmark::ClobberMemory();
  }
  report_located(state, out);
}
BENCHMARK(locate)->Name("bezel/locate")->ArgName("g")->DenseRange(1, 4);

/// Points in one triangle, `many` of them in one call or one by one.
template <bool many>
void one_triangle(benchmark::State& state) {
  const int g = static_cast<int>(state.range(0));
  bezel::RandomStream random("geometry_bench one_triangle", static_cast<std::uint64_t>(g));
  const std::vector<Vec2> net = triangle_of(random, g);
  std::vector<Vec2> points;
  for (int i = 0; i < 1000; ++i) points.push_back(point_inside(random, g, net));
  std::vector<bezel::LocateResult> out(points.size());
  for (auto _ : state) {
    if (many)
      bezel::locate(g, net, points, out);
    else
      for (std::size_t i = 0; i < points.size(); ++i) out[i] = bezel::locate(g, net, points[i]);
    benchmark::ClobberMemory();
  }
  report_located(state, out);
}
BENCHMARK(one_triangle<true>)->Name("bezel/locate many")->ArgName("g")->DenseRange(1, 5);
BENCHMARK(one_triangle<false>)->Name("bezel/locate one by one")->ArgName("g")->DenseRange(1, 5);

/// The same by `invert`, from the middle of the triangle.
template <bool many>
void invert_points(benchmark::State& state) {
  const int g = static_cast<int>(state.range(0));
  bezel::RandomStream random("geometry_bench one_triangle", static_cast<std::uint64_t>(g));
  const std::vector<Vec2> net = triangle_of(random, g);
  std::vector<Vec2> points;
  for (int i = 0; i < 1000; ++i) points.push_back(point_inside(random, g, net));
  const std::vector<Lambda> start(points.size(), Lambda{1.0 / 3, 1.0 / 3, 1.0 / 3});
  std::vector<bezel::InverseResult> out(points.size());
  for (auto _ : state) {
    if (many)
      bezel::invert(g, net, points, start, out);
    else
      for (std::size_t i = 0; i < points.size(); ++i)
        out[i] = bezel::invert(g, net, points[i], start[i]);
    benchmark::ClobberMemory();
  }
  report_points(state, points.size());
  double missed = 0;
  for (const bezel::InverseResult& r : out) missed += r.converged ? 0.0 : 1.0;
  state.counters["missed"] = missed;
}
BENCHMARK(invert_points<true>)->Name("bezel/invert many")->ArgName("g")->DenseRange(1, 5);
BENCHMARK(invert_points<false>)->Name("bezel/invert one by one")->ArgName("g")->DenseRange(1, 5);

}  // namespace
