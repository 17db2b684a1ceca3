#include "bezel/mesh/generate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/mesh/planar.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using planar::Domain;
using planar::Triangulation;
using short_names::at;

constexpr double pi = 3.14159265358979323846;

std::string text(double x) {
  std::string s(32, '\0');
  s.resize(at(std::snprintf(s.data(), s.size(), "%.6g", x)));
  return s;
}

void check_length(const char* what, double x) {
  if (!(x >= 1e-100 && x <= 1e100))  // squares stay far from over- and underflow
    throw InputError("found " + std::string(what) + " " + text(x) +
                     ", expected a length from 1e-100 to 1e100");
}

/// @param shortest  the shape's smallest length
void check(const GenerateOptions& o, double area, double perimeter, double shortest) {
  if (o.degree < 1 || o.degree > TriangleMesh::max_degree)
    throw InputError("found geometric degree " + std::to_string(o.degree) + ", expected 1 to " +
                     std::to_string(TriangleMesh::max_degree));
  if (!std::isfinite(o.centre[0]) || !std::isfinite(o.centre[1]))
    throw InputError("found centre (" + text(o.centre[0]) + ", " + text(o.centre[1]) +
                     "), expected finite coordinates");
  if (!(o.curve_jitter >= 0 && o.curve_jitter <= 0.5))
    throw InputError("found curve jitter " + text(o.curve_jitter) + ", expected 0 to 0.5");
  check_length("size", o.size);
  const double far = std::max(std::abs(o.centre[0]), std::abs(o.centre[1]));
  if (!(std::min(shortest, o.size) >= 1e-12 * far))
    throw InputError("found a length of " + text(std::min(shortest, o.size)) +
                     " at a distance of " + text(far) +
                     " from the origin, expected at least 1e-12 of the distance");
  const double elements = area / o.size / o.size * (4 / std::sqrt(3.0)) + perimeter / o.size;
  if (!(elements <= 5e7))
    throw InputError("size " + text(o.size) + " would give about " + text(elements) +
                     " elements, expected at most 5e7");
  const double nodes = 0.5 * elements * o.degree * o.degree;
  if (!(nodes <= 2e9))
    throw InputError("size " + text(o.size) + " and degree " + std::to_string(o.degree) +
                     " would give about " + text(nodes) + " nodes, expected at most 2e9");
}

/// How many edges of about `size` make up a length.
int pieces(double length, double size, int least) {
  return std::max(least, static_cast<int>(std::round(length / size)));
}

/// Builds with sizes that shrink until every element is valid; `build` fills a triangulation.
template <class Build>
TriangleMesh build_valid(const char* shape, const GenerateOptions& options, const Build& build) {
  constexpr int attempts = 10;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    RandomStream random(std::string("generate_") + shape,
                        options.seed * attempts + static_cast<std::uint64_t>(attempt));
    Triangulation t;
    if (!build(t, std::pow(0.8, attempt), random)) continue;
    if (auto mesh = planar::curve(t, options.degree, options.curve_jitter, random))
      return std::move(*mesh);
  }
  throw InternalError(std::string("generate_") + shape + " found no valid mesh of degree " +
                      std::to_string(options.degree) + " and size " + text(options.size));
}

/// Appends a closed loop of segments over the points first..first+n-1.
void close_loop(Triangulation& t, int first, int n, int curve) {
  for (int i = 0; i < n; ++i) t.segments.push_back({first + i, first + (i + 1) % n, curve});
}

Vec2 on_circle(const Vec2& centre, double radius, double angle) {
  return centre + Vec2{{radius * std::cos(angle), radius * std::sin(angle)}};
}

/// Cells i0..i1-1 times j0..j1-1 of a grid, each cut along its rising diagonal.
template <class Number>
void add_grid(Triangulation& t, int i0, int i1, int j0, int j1, const Number& number) {
  for (int j = j0; j < j1; ++j)
    for (int i = i0; i < i1; ++i) {
      t.triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      t.triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
}

double between(double lo, double hi, int i, int n) {
  return i == n ? hi : lo + (hi - lo) * i / n;
}

/// The boundary of a polygon with axis-parallel sides: corners[k] to corners[k+1] in n[k] edges.
void add_polygon(Triangulation& t, const std::vector<Vec2>& corners, const std::vector<int>& n,
                 const std::vector<int>& curve) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    for (int i = 0; i < n[k]; ++i) {
      const int p = static_cast<int>(t.points.size());
      t.points.push_back({{between(a[0], b[0], i, n[k]), between(a[1], b[1], i, n[k])}});
      t.segments.push_back({p, p + 1, curve[k]});
    }
  }
  t.segments.back().b = 0;
}

}  // namespace

TriangleMesh generate_rectangle(double width, double height, const GenerateOptions& options) {
  check_length("width", width);
  check_length("height", height);
  check(options, width * height, 2 * (width + height), std::min(width, height));
  const Vec2 half{{width / 2, height / 2}}, lo = options.centre - half, hi = options.centre + half;
  return build_valid(
      "rectangle", options, [&](Triangulation& t, double shrink, RandomStream& random) {
        const double size = shrink * options.size;
        const int nx = pieces(width, size, 1), ny = pieces(height, size, 1);
        t.curves = {{"bottom"}, {"right"}, {"top"}, {"left"}};
        if (options.pattern == Pattern::structured) {
          const auto number = [&](int i, int j) { return j * (nx + 1) + i; };
          for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i)
              t.points.push_back({{between(lo[0], hi[0], i, nx), between(lo[1], hi[1], j, ny)}});
          add_grid(t, 0, nx, 0, ny, number);
          for (int i = 0; i < nx; ++i) t.segments.push_back({number(i, 0), number(i + 1, 0), 0});
          for (int j = 0; j < ny; ++j) t.segments.push_back({number(nx, j), number(nx, j + 1), 1});
          for (int i = nx; i > 0; --i) t.segments.push_back({number(i, ny), number(i - 1, ny), 2});
          for (int j = ny; j > 0; --j) t.segments.push_back({number(0, j), number(0, j - 1), 3});
          return true;
        }
        add_polygon(t, {lo, {{hi[0], lo[1]}}, hi, {{lo[0], hi[1]}}}, {nx, ny, nx, ny},
                    {0, 1, 2, 3});
        Domain domain;
        domain.area = width * height;
        domain.size = size;
        // Half the longest boundary edge keeps that edge's diametral circle empty: it is Delaunay.
        domain.margin = 0.5 * std::max({size, width / nx, height / ny});
        domain.inside = [&](const Vec2& p, double margin) {
          return p[0] > lo[0] + margin && p[0] < hi[0] - margin && p[1] > lo[1] + margin &&
                 p[1] < hi[1] - margin;
        };
        domain.keep = [](const std::array<int, 3>&) { return true; };
        return planar::fill(t, domain, random);
      });
}

TriangleMesh generate_disc(double radius, const GenerateOptions& options) {
  check_length("radius", radius);
  check(options, pi * radius * radius, 2 * pi * radius, radius);
  const Vec2& centre = options.centre;
  return build_valid("disc", options, [&](Triangulation& t, double shrink, RandomStream& random) {
    const double size = shrink * options.size;
    t.curves = {{"boundary", centre, radius}};
    if (options.pattern == Pattern::structured) {
      // Rings of 6, 12, 18, … points around the centre: the triangular lattice bent into circles.
      const int rings = pieces(radius, size, 1);
      t.points.push_back(centre);
      const auto number = [](int ring, int j) {
        return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + j % (6 * ring);
      };
      for (int ring = 1; ring <= rings; ++ring)
        for (int j = 0; j < 6 * ring; ++j)
          t.points.push_back(
              on_circle(centre, between(0, radius, ring, rings), pi * j / (3 * ring)));
      for (int ring = 1; ring <= rings; ++ring)
        for (int sector = 0; sector < 6; ++sector)
          for (int j = 0; j < ring; ++j) {
            const int outer = sector * ring + j, inner = sector * (ring - 1) + j;
            t.triangles.push_back(
                {number(ring - 1, inner), number(ring, outer), number(ring, outer + 1)});
            if (j + 1 < ring)
              t.triangles.push_back(
                  {number(ring - 1, inner), number(ring, outer + 1), number(ring - 1, inner + 1)});
          }
      close_loop(t, number(rings, 0), 6 * rings, 0);
      return true;
    }
    const int n = pieces(2 * pi * radius, size, 6);
    for (int i = 0; i < n; ++i) t.points.push_back(on_circle(centre, radius, 2 * pi * i / n));
    close_loop(t, 0, n, 0);
    Domain domain;
    domain.area = pi * radius * radius;
    domain.size = std::min(size, radius);
    domain.margin = 0.5 * std::max(domain.size, 2 * pi * radius / n);
    domain.least_points = 1;  // without one, a triangle would have two sides on the circle
    domain.inside = [&](const Vec2& p, double margin) {
      return norm(p - centre) < radius * std::cos(pi / n) - margin;
    };
    // A triangle between three points of the circle that follow each other is a sliver of rounding.
    domain.keep = [](const std::array<int, 3>&) { return true; };
    return planar::fill(t, domain, random);
  });
}

TriangleMesh generate_annulus(double inner_radius, double outer_radius,
                              const GenerateOptions& options) {
  check_length("inner radius", inner_radius);
  check_length("outer radius", outer_radius);
  if (!(inner_radius < outer_radius))
    throw InputError("found inner radius " + text(inner_radius) + " and outer radius " +
                     text(outer_radius) + ", expected inner < outer");
  const double gap = outer_radius - inner_radius, area = pi * gap * (inner_radius + outer_radius);
  if (!(gap >= 1e-9 * outer_radius))
    throw InputError("found a gap of " + text(gap) +
                     " between the circles, expected at least 1e-9 of "
                     "the outer radius");
  // A chord from one circle to the next must not dip below the inner one: its angle is less than
  // acos(inner / next); half of that leaves room for the arcs.
  const auto least = [&](double next) {
    const double angle = 2 * std::asin(std::sqrt(0.5 * (next - inner_radius) / next));
    return std::max(8.0, std::ceil(2 * pi / (0.5 * angle)));
  };
  check(options, area, 2 * pi * (inner_radius + outer_radius), std::min(inner_radius, gap));
  check(options, 0, least(outer_radius) * options.size, gap);
  const Vec2& centre = options.centre;
  return build_valid(
      "annulus", options, [&](Triangulation& t, double shrink, RandomStream& random) {
        const double size = shrink * options.size;
        t.curves = {{"outer", centre, outer_radius}, {"inner", centre, inner_radius}};
        const auto ring = [&](double radius, int n) {
          const int first = static_cast<int>(t.points.size());
          for (int i = 0; i < n; ++i) t.points.push_back(on_circle(centre, radius, 2 * pi * i / n));
          return first;
        };
        const auto inner_loop = [&](int first, int n) {  // clockwise: the domain is on the left
          for (int i = n; i > 0; --i) t.segments.push_back({first + i % n, first + i - 1, 1});
        };
        if (options.pattern == Pattern::structured) {
          const int layers = pieces(gap, size, 1);
          const double second = between(inner_radius, outer_radius, 1, layers);
          const int n = pieces(pi * (inner_radius + outer_radius), size,
                               static_cast<int>(std::ceil(least(second) / shrink)));
          for (int k = 0; k <= layers; ++k) ring(between(inner_radius, outer_radius, k, layers), n);
          // Angles grow along a row and radii from row to row, so a cell seen from outside runs
          // backwards.
          add_grid(t, 0, n, 0, layers, [&](int i, int k) { return (layers - k) * n + i % n; });
          close_loop(t, layers * n, n, 0);
          inner_loop(0, n);
          return true;
        }
        int n_outer = pieces(2 * pi * outer_radius, size, static_cast<int>(std::ceil(8 / shrink)));
        int n_inner = pieces(2 * pi * inner_radius, size, static_cast<int>(std::ceil(8 / shrink)));
        if (gap <
            1.5 * std::max(size, 2 * pi * outer_radius / n_outer))  // thin: points face each other
          n_outer = n_inner =
              std::max(n_outer, static_cast<int>(std::ceil(least(outer_radius) / shrink)));
        ring(outer_radius, n_outer);
        ring(inner_radius, n_inner);
        close_loop(t, 0, n_outer, 0);
        inner_loop(n_outer, n_inner);
        Domain domain;
        domain.area = area;
        domain.size = size;
        domain.margin = 0.5 * std::max({size, 2 * pi * outer_radius / n_outer,
                                        2 * pi * inner_radius / n_inner});
        domain.inside = [&, n_outer](const Vec2& p, double margin) {
          const double r = norm(p - centre);
          return r > inner_radius + margin && r < outer_radius * std::cos(pi / n_outer) - margin;
        };
        domain.keep = [n_outer, n_inner](const std::array<int, 3>& corners) {
          return !std::all_of(corners.begin(), corners.end(),
                              [&](int v) { return v >= n_outer && v < n_outer + n_inner; });
        };
        return planar::fill(t, domain, random);
      });
}

TriangleMesh generate_lshape(double width, const GenerateOptions& options) {
  check_length("width", width);
  check(options, 0.75 * width * width, 4 * width, width);
  const Vec2& mid = options.centre;
  const Vec2 half{{width / 2, width / 2}}, lo = mid - half, hi = mid + half;
  return build_valid("lshape", options, [&](Triangulation& t, double shrink, RandomStream& random) {
    const double size = shrink * options.size;
    const int n = pieces(width / 2, size, 1);
    t.curves = {{"boundary"}};
    if (options.pattern == Pattern::structured) {
      // Row by row: rows below the middle have n + 1 points, the others 2n + 1.
      const auto number = [n](int i, int j) {
        return j < n ? j * (n + 1) + i : n * (n + 1) + (j - n) * (2 * n + 1) + i;
      };
      const auto place = [n](double a, double m, double b, int i) {
        return i <= n ? between(a, m, i, n) : between(m, b, i - n, n);
      };
      for (int j = 0; j <= 2 * n; ++j)
        for (int i = 0; i <= (j < n ? n : 2 * n); ++i)
          t.points.push_back({{place(lo[0], mid[0], hi[0], i), place(lo[1], mid[1], hi[1], j)}});
      add_grid(t, 0, n, 0, n, number);
      add_grid(t, 0, 2 * n, n, 2 * n, number);
      std::vector<std::array<int, 2>> walk;
      for (int i = 0; i < n; ++i) walk.push_back({i, 0});
      for (int j = 0; j < n; ++j) walk.push_back({n, j});
      for (int i = n; i < 2 * n; ++i) walk.push_back({i, n});
      for (int j = n; j < 2 * n; ++j) walk.push_back({2 * n, j});
      for (int i = 2 * n; i > 0; --i) walk.push_back({i, 2 * n});
      for (int j = 2 * n; j > 0; --j) walk.push_back({0, j});
      for (std::size_t k = 0; k < walk.size(); ++k) {
        const auto &a = walk[k], &b = walk[(k + 1) % walk.size()];
        t.segments.push_back({number(a[0], a[1]), number(b[0], b[1]), 0});
      }
      return true;
    }
    add_polygon(t, {lo, {{mid[0], lo[1]}}, mid, {{hi[0], mid[1]}}, hi, {{lo[0], hi[1]}}},
                {n, n, n, n, 2 * n, 2 * n}, {0, 0, 0, 0, 0, 0});
    Domain domain;
    domain.area = 0.75 * width * width;
    domain.size = size;
    domain.margin = 0.5 * std::max(size, width / 2 / n);
    domain.inside = [&](const Vec2& p, double margin) {
      return p[0] > lo[0] + margin && p[0] < hi[0] - margin && p[1] > lo[1] + margin &&
             p[1] < hi[1] - margin && (p[0] < mid[0] - margin || p[1] > mid[1] + margin);
    };
    domain.keep = [&](const std::array<int, 3>& corners) {
      Vec2 sum{};
      for (const int v : corners) sum += t.points[at(v)] - mid;
      return sum[0] < 0 || sum[1] > 0;
    };
    return planar::fill(t, domain, random);
  });
}

}  // namespace bezel
