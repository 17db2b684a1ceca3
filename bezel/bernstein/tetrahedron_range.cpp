// Certified enclosure of the range on the tetrahedron.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/range_search.hpp"
#include "bezel/bernstein/tetrahedron.hpp"
#include "bezel/bernstein/tetrahedron_kernel.hpp"

namespace bezel::bernstein::tetrahedron {
namespace {

// Three levels halve the edges, and the gap between coefficients and values shrinks like the
// square: beyond 30 halvings of the edges only rounding is left.
constexpr int max_depth = 90;
constexpr int max_splits = 20000;

}  // namespace

Range range(int d, std::span<const double> b, double tol) {
  checks::tetrahedron(d, b);
  if (!(tol >= 0.0))
    throw InputError("range tolerance is " + std::to_string(tol) + ", expected at least 0");
  if (tol == 0.0 || d == 0) {
    const auto [lo, hi] = std::minmax_element(b.begin(), b.end());
    return {*lo, *hi};
  }
  const kernel::Bisection bisection(d);
  const auto split = [&](int depth, const std::vector<double>& c) {
    std::array<std::vector<double>, 2> child{std::vector<double>(c.size()),
                                             std::vector<double>(c.size())};
    bisection.split(depth, c.data(), child[0].data(), child[1].data());
    return child;
  };
  const std::array<std::size_t, 4> corners{0, static_cast<std::size_t>(tetrahedron_corner(d, 1)),
                                           static_cast<std::size_t>(tetrahedron_corner(d, 2)),
                                           b.size() - 1};
  const auto upper_bound = [&](std::vector<double> c) {
    return upper_bound_by_splitting(d, std::move(c), WithinTolerance{tol}, corners, max_depth,
                                    max_splits, split);
  };
  std::vector<double> negated(b.begin(), b.end());
  for (double& c : negated) c = -c;
  return {-upper_bound(std::move(negated)), upper_bound({b.begin(), b.end()})};
}

}  // namespace bezel::bernstein::tetrahedron
