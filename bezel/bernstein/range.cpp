// Certified enclosures of the range: best-first subdivision with outward rounding.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"

namespace bezel::bernstein {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// The gap between coefficients and values shrinks like 4^-depth: beyond this depth only rounding is
// left.
constexpr int max_depth = 30;
constexpr int max_splits = 20000;

double up(double x) {
  return std::nextafter(x, infinity);
}
double down(double x) {
  return std::nextafter(x, -infinity);
}

// A part of the domain: its coefficients and a proven upper bound of the values on it.
struct Part {
  std::vector<double> b;
  double bound;
  int depth;
  bool operator<(const Part& other) const { return bound < other.bound; }
};

// Upper bound of the maximum, within tol (and rounding) of it. `corners` are the coefficients that
// are values; `split` gives the children.
//
// Slack: a midpoint step 0.5 a + 0.5 b rounds once by at most u |result| <= u M (halving is exact,
// or off by 2^-1075 when subnormal), so d steps move a coefficient by at most d (u M + 2^-1074);
// `depth` splits by depth times that, M the largest |coefficient|, up to a relative 2^-40 for
// second-order terms.
template <class Split>
double upper_bound(int d, std::vector<double> b, double tol,
                   const std::vector<std::size_t>& corners, const Split& split) {
  const double top = *std::max_element(b.begin(), b.end());
  double magnitude = 0.0;
  for (const double c : b) magnitude = std::max(magnitude, std::fabs(c));
  const double slack_per_split = d * (magnitude * 0x1.0000000001p-53 + 0x1p-1073);

  double attained = -infinity;  // a proven lower bound of the maximum
  std::priority_queue<Part> queue;
  const auto add = [&](std::vector<double> c, int depth) {
    const double slack = depth * slack_per_split;
    for (const std::size_t corner : corners)
      attained = std::max(attained, depth == 0 ? c[corner] : down(c[corner] - slack));
    const double largest = *std::max_element(c.begin(), c.end());
    queue.push({std::move(c), depth == 0 ? largest : std::min(top, up(largest + slack)), depth});
  };
  add(std::move(b), 0);
  for (int splits = 0;; ++splits) {
    const Part part = queue.top();
    if (part.bound <= attained + tol || part.depth >= max_depth || splits >= max_splits)
      return part.bound;
    queue.pop();
    for (std::vector<double>& child : split(part.b)) add(std::move(child), part.depth + 1);
  }
}

template <class Split>
Range enclose(int d, std::span<const double> b, double tol, const std::vector<std::size_t>& corners,
              const Split& split) {
  if (!(tol >= 0.0))
    throw InputError("range tolerance is " + std::to_string(tol) + ", expected at least 0");
  if (tol == 0.0 || d == 0) {
    const auto [lo, hi] = std::minmax_element(b.begin(), b.end());
    return {*lo, *hi};
  }
  std::vector<double> negated(b.begin(), b.end());
  for (double& c : negated) c = -c;
  return {-upper_bound(d, std::move(negated), tol, corners, split),
          upper_bound(d, {b.begin(), b.end()}, tol, corners, split)};
}

}  // namespace

Range range(std::span<const double> b, double tol) {
  const int d = checks::interval(b);
  return enclose(d, b, tol, {0, b.size() - 1}, [d](const std::vector<double>& c) {
    std::array<std::vector<double>, 2> child{std::vector<double>(c.size()),
                                             std::vector<double>(c.size())};
    kernel::subdivide(d, c.data(), 0.5, child[0].data(), child[1].data());
    return child;
  });
}

Range range(int d, std::span<const double> b, double tol) {
  checks::triangle(d, b);
  const std::vector<std::size_t> corners{0, static_cast<std::size_t>(d), b.size() - 1};
  return enclose(d, b, tol, corners, [d](const std::vector<double>& c) {
    std::array<std::vector<double>, 4> child;
    std::array<double*, 4> place{};
    for (std::size_t i = 0; i < 4; ++i) {
      child[i].resize(c.size());
      place[i] = child[i].data();
    }
    kernel::subdivide_triangle<double, double>(d, c.data(), place);
    return child;
  });
}

}  // namespace bezel::bernstein
