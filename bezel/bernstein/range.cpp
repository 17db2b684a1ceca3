// Certified enclosures of the range: best-first subdivision with outward rounding.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

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
constexpr int max_splits = 20000;

template <class Split>
Range enclose(int d, std::span<const double> b, double tol, const std::vector<std::size_t>& corners,
              const Split& split) {
  // A midpoint step 0.5 a + 0.5 b rounds once: d roundings for each split.
  const auto upper_bound = [&](std::vector<double> c) {
    return upper_bound_by_splitting(
        d, std::move(c), tol, corners, max_depth, max_splits,
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
