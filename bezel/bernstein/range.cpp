// Certified enclosures of the range: best-first subdivision with outward rounding.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "bezel/bernstein/ceiling.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/range_search.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"

namespace bezel::bernstein {
namespace {

// The gap between coefficients and values shrinks like 4^-depth: beyond this depth only rounding is
// left.
constexpr int max_depth = 30;
constexpr int most_splits = 20000;

template <class Split>
Range enclose(int d, std::span<const double> b, double tol, const std::vector<std::size_t>& corners,
              const Split& split) {
  // A midpoint step 0.5 a + 0.5 b rounds once: d roundings for each split.
  const auto upper_bound = [&](std::vector<double> c) {
    return upper_bound_by_splitting(
        d, std::move(c), WithinTolerance{tol}, corners, max_depth, most_splits,
        [&](int, const std::vector<double>& piece) { return split(piece); });
  };
  if (!(tol >= 0.0))
    throw InputError("range tolerance is " + std::to_string(tol) + ", expected at least 0");
  if (tol == 0.0 || d == 0) {
    const auto [lo, hi] = std::minmax_element(b.begin(), b.end());
    return {*lo, *hi};
  }
  std::vector<double> negated(b.begin(), b.end());
  for (double& c : negated) c = -c;
  return {-upper_bound(std::move(negated)), upper_bound({b.begin(), b.end()})};
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

namespace {

std::array<std::vector<double>, 4> split_triangle(int d, const std::vector<double>& c) {
  std::array<std::vector<double>, 4> child;
  std::array<double*, 4> place{};
  for (std::size_t i = 0; i < 4; ++i) {
    child[i].resize(c.size());
    place[i] = child[i].data();
  }
  kernel::subdivide_triangle<double, double>(d, c.data(), place);
  return child;
}

}  // namespace

Range range(int d, std::span<const double> b, double tol) {
  checks::triangle(d, b);
  const std::vector<std::size_t> corners{0, static_cast<std::size_t>(d), b.size() - 1};
  return enclose(d, b, tol, corners,
                 [d](const std::vector<double>& c) { return split_triangle(d, c); });
}

double upper_bound(int d, std::span<const double> b, double ceiling, double tol, int max_splits) {
  checks::triangle(d, b);
  if (!(tol >= 0.0) || std::isnan(ceiling))
    throw InputError("upper bound: found ceiling " + std::to_string(ceiling) + " and tolerance " +
                     std::to_string(tol) + ", expected a number and at least 0");
  const std::array<std::size_t, 3> corners{0, static_cast<std::size_t>(d), b.size() - 1};
  const auto enough = [&](double bound, double attained) {
    return bound <= ceiling ||
           bound - attained <= std::max(tol, excess_tolerance * (attained - ceiling));
  };
  return upper_bound_by_splitting(
      d, {b.begin(), b.end()}, enough, corners, max_depth, max_splits,
      [d](int, const std::vector<double>& piece) { return split_triangle(d, piece); });
}

}  // namespace bezel::bernstein
