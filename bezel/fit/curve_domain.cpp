#include "bezel/fit/curve_domain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/mesh/planar.hpp"

namespace bezel {
namespace {

constexpr double most_edges = 1e5, most_tests = 1e8;  // of a point against a boundary edge
constexpr int samples_per_part = 256, most_breaks = 16;
constexpr double growth = 0.3;  // of the edge length along the curve

struct Vertex {
  Vec2 point;
  int curve;  // of the edge that starts here
};
using Loop = std::vector<Vertex>;

/// Parameters of the vertices on a curve, ends included.
std::vector<double> spread(const SmoothCurve<2>& curve, double size, double turn) {
  std::vector<double> ends = {-1.0};
  const auto breaks = curve.breakpoints();
  if (breaks.size() <= most_breaks) ends.insert(ends.end(), breaks.begin(), breaks.end());
  ends.push_back(1.0);
  std::vector<double> out = {-1.0};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double lo = ends[k], hi = ends[k + 1];
    const double dt = (hi - lo) / samples_per_part;
    std::vector<double> t, speed, edge;
    for (int i = 0; i <= samples_per_part; ++i) {
      t.push_back(i == samples_per_part ? hi : lo + i * dt);
      // Derivatives from inside the part.
      const double inside = std::clamp(t.back(), lo + 1e-9 * (hi - lo), hi - 1e-9 * (hi - lo));
      const CurveJet<2> jet = curve(inside);
      speed.push_back(norm(jet.d1));
      const double bend = std::fabs(cross(jet.d1, jet.d2)) / std::pow(speed.back(), 3);
      edge.push_back(bend * size > turn ? turn / bend : size);
    }
    for (std::size_t i = 1; i < t.size(); ++i)
      edge[i] = std::min(edge[i], edge[i - 1] + growth * speed[i] * dt);
    for (std::size_t i = t.size() - 1; i-- > 0;)
      edge[i] = std::min(edge[i], edge[i + 1] + growth * speed[i] * dt);
    std::vector<double> count = {0.0};
    for (std::size_t i = 1; i < t.size(); ++i)
      count.push_back(count.back() + 0.5 * dt * (speed[i - 1] / edge[i - 1] + speed[i] / edge[i]));
    if (!(count.back() < most_edges))
      throw InputError("a curve would have more than 100000 edges, expected a larger size");
    const int n = std::max(1, static_cast<int>(std::ceil(count.back() - 0.01)));
    std::size_t at = 0;
    for (int i = 1; i < n; ++i) {
      const double wanted = count.back() * i / n;
      while (count[at + 1] < wanted) ++at;
      const double part = (wanted - count[at]) / (count[at + 1] - count[at]);
      out.push_back(t[at] + part * (t[at + 1] - t[at]));
    }
    out.push_back(hi);
  }
  return out;
}

/// Chains curves whose ends meet into closed loops, in the order of their first curves.
std::vector<std::vector<std::pair<std::size_t, bool>>> chain(
    std::span<const SmoothCurve<2>> curves) {
  const std::size_t n = curves.size();
  std::vector<Vec2> end;  // 2 k: start of curve k; 2 k + 1: its end
  Box2 box;
  for (const SmoothCurve<2>& curve : curves)
    for (const double t : {-1.0, 1.0}) {
      end.push_back(curve(t).x);
      box.include(end.back());
    }
  for (const SmoothCurve<2>& curve : curves)
    for (int i = 1; i < 16; ++i) box.include(curve(-1.0 + 0.125 * i).x);
  const double tolerance = 1e-9 * box.diameter();
  const auto partner = [&](std::size_t i) {
    std::size_t best = 2 * n;
    double least = INFINITY;
    for (std::size_t j = 0; j < 2 * n; ++j) {
      if (j == i) continue;
      const double gap = norm(end[j] - end[i]);
      if (gap < least) {
        least = gap;
        best = j;
      }
    }
    if (!(least <= tolerance))
      throw InputError("the " + std::string(i % 2 == 0 ? "start" : "end") + " of curve " +
                       std::to_string(i / 2) + " meets no other end; the nearest is " +
                       std::to_string(least) + " away, expected closed chains of curves");
    return best;
  };
  std::vector<char> used(n, 0);
  std::vector<std::vector<std::pair<std::size_t, bool>>> loops;
  for (std::size_t first = 0; first < n; ++first) {
    if (used[first] != 0) continue;
    auto& loop = loops.emplace_back();
    std::size_t leaving = 2 * first + 1;
    for (;;) {
      const std::size_t curve = leaving / 2;
      used[curve] = 1;
      loop.emplace_back(curve, leaving % 2 == 0);
      const std::size_t next = partner(leaving);
      if (next / 2 == first) break;
      if (used[next / 2] != 0)
        throw InputError("three curves meet at the end of curve " + std::to_string(curve) +
                         ", expected two");
      leaving = next ^ 1U;
    }
  }
  return loops;
}

double signed_area(const Loop& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += cross(loop[i].point - loop[0].point, loop[(i + 1) % loop.size()].point - loop[0].point);
  return 0.5 * sum;
}

bool inside(const Loop& loop, const Vec2& p) {
  bool odd = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i].point, &b = loop[(i + 1) % loop.size()].point;
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const double side = cross(b - a, p - a);
    if ((side > 0.0) == (b.y() > a.y())) odd = !odd;
  }
  return odd;
}

double distance_to(const Loop& loop, const Vec2& p) {
  double least = INFINITY;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i].point, &b = loop[(i + 1) % loop.size()].point;
    const Vec2 along = b - a;
    const double s = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
    least = std::min(least, norm(a + s * along - p));
  }
  return least;
}

/// Outer loops counter-clockwise, holes clockwise.
void orient(std::vector<Loop>& loops) {
  std::vector<char> hole(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t j = 0; j < loops.size(); ++j)
      if (i != j && inside(loops[j], loops[i][0].point)) hole[i] ^= 1;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if ((signed_area(loops[i]) > 0.0) != (hole[i] != 0)) continue;
    // The curve of an edge belongs to its start: it moves along.
    Loop back;
    const std::size_t n = loops[i].size();
    for (std::size_t k = n; k-- > 0;)
      back.push_back({loops[i][k].point, loops[i][(k + n - 1) % n].curve});
    loops[i] = std::move(back);
  }
}

std::vector<Loop> make_loops(std::span<const SmoothCurve<2>> curves, double size, double turn) {
  std::vector<Loop> loops;
  for (const auto& parts : chain(curves)) {
    // At least three vertices per loop.
    Loop loop;
    for (double used = size; loop.size() < 3; used *= 0.5) {
      loop.clear();
      for (const auto& [k, backwards] : parts) {
        std::vector<double> t = spread(curves[k], used, turn);
        if (backwards) std::reverse(t.begin(), t.end());
        for (std::size_t i = 0; i + 1 < t.size(); ++i)
          loop.push_back({curves[k](t[i]).x, static_cast<int>(k)});
      }
    }
    loops.push_back(std::move(loop));
  }
  orient(loops);
  return loops;
}

void check(std::span<const SmoothCurve<2>> curves, const CurveDomainOptions& options,
           std::span<const std::string> names) {
  if (curves.empty()) throw InputError("found no curves, expected at least one");
  if (!names.empty() && names.size() != curves.size())
    throw InputError("found " + std::to_string(names.size()) + " names and " +
                     std::to_string(curves.size()) + " curves, expected as many");
  if (!(options.size > 0.0) || !std::isfinite(options.size))
    throw InputError("found size " + std::to_string(options.size) + ", expected a positive length");
  if (!(options.turn >= 0.05 && options.turn <= 1.0))
    throw InputError("found a turn of " + std::to_string(options.turn) +
                     " radians per edge, expected 0.05 to 1");
}

}  // namespace

TriangleMesh mesh_curve_domain(std::span<const SmoothCurve<2>> curves,
                               const CurveDomainOptions& options,
                               std::span<const std::string> names) {
  check(curves, options, names);
  constexpr int attempts = 8;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const double size = options.size * std::pow(0.8, attempt);
    const std::vector<Loop> loops = make_loops(curves, size, options.turn);
    planar::Triangulation t;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      planar::Curve straight;
      straight.name = names.empty() ? "curve " + std::to_string(k) : names[k];
      t.curves.push_back(std::move(straight));
    }
    planar::Domain domain;
    double longest = size;
    for (const Loop& loop : loops) {
      const auto first = static_cast<int>(t.points.size()), n = static_cast<int>(loop.size());
      for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        t.points.push_back(loop[k].point);
        t.segments.push_back({first + i, first + (i + 1) % n, loop[k].curve});
        longest = std::max(longest, norm(loop[(k + 1) % loop.size()].point - loop[k].point));
      }
      domain.area += signed_area(loop);
    }
    const double triangles = domain.area / (std::sqrt(3.0) / 4.0 * size * size);
    if (!(triangles < most_edges && triangles * static_cast<double>(t.points.size()) < most_tests))
      throw InputError("size " + std::to_string(options.size) + " would give " +
                       std::to_string(triangles) + " triangles and " +
                       std::to_string(t.points.size()) +
                       " boundary edges, expected less than 100000, and a product below 1e8");
    domain.size = size;
    domain.margin = 0.5 * longest;
    const auto contains = [&](const Vec2& p) {
      bool odd = false;
      for (const Loop& loop : loops) odd ^= inside(loop, p);
      return odd;
    };
    domain.inside = [&](const Vec2& p, double margin) {
      return contains(p) && std::all_of(loops.begin(), loops.end(), [&](const Loop& loop) {
               return distance_to(loop, p) > margin;
             });
    };
    domain.keep = [&](const std::array<int, 3>& corner) {
      Vec2 sum{};
      for (const int v : corner) sum += t.points[static_cast<std::size_t>(v)];
      return contains((1.0 / 3.0) * sum);
    };
    RandomStream random("mesh_curve_domain",
                        options.seed * attempts + static_cast<std::uint64_t>(attempt));
    if (!planar::fill(t, domain, random)) continue;
    if (auto mesh = planar::curve(t, 1, 0.0, random)) return std::move(*mesh);
  }
  throw InputError(
      "the curves bound no region that can be meshed at size " + std::to_string(options.size) +
      ": they touch or cross as polygons, or come too close; expected chains that stay apart, or a "
      "smaller size");
}

}  // namespace bezel
