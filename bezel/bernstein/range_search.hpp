#pragma once
// Upper bounds of polynomials by best-first subdivision with outward rounding: the search, for any
// domain.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace bezel::bernstein {

/// Upper bound of the maximum of the polynomial b: the first for which enough(bound, attained)
/// holds, where the maximum lies in [attained, bound], or the bound so far after max_splits splits.
/// `corners` are the coefficients that are values; split(depth, b) gives the children of a piece,
/// as a range of vectors.
///
/// A split by halves may round each coefficient `roundings` times by at most u |result| <= u M
/// (halving is exact, or off by 2^-1075 when subnormal), M the largest |coefficient|, up to a
/// relative 2^-40 for second-order terms: at depth n a coefficient is off by n times that.
template <class Enough, class Split>
double upper_bound_by_splitting(int roundings, std::vector<double> b, const Enough& enough,
                                std::span<const std::size_t> corners, int max_depth, int max_splits,
                                const Split& split) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  struct Piece {
    std::vector<double> b;
    double bound;
    int depth;
    bool operator<(const Piece& other) const { return bound < other.bound; }
  };
  const double top = *std::max_element(b.begin(), b.end());
  double magnitude = 0.0;
  for (const double c : b) magnitude = std::max(magnitude, std::fabs(c));
  const double slack_per_split = roundings * (magnitude * 0x1.0000000001p-53 + 0x1p-1073);

  double attained = -infinity;  // a proven lower bound of the maximum
  std::priority_queue<Piece> queue;
  const auto add = [&](std::vector<double> c, int depth) {
    const double slack = depth * slack_per_split;
    for (const std::size_t corner : corners) {
      const double value = c[corner];
      attained = std::max(attained, depth == 0 ? value : std::nextafter(value - slack, -infinity));
    }
    const double largest = *std::max_element(c.begin(), c.end());
    const double bound =
        depth == 0 ? largest : std::min(top, std::nextafter(largest + slack, infinity));
    queue.push({std::move(c), bound, depth});
  };
  add(std::move(b), 0);
  for (int splits = 0;; ++splits) {
    const Piece piece = queue.top();
    if (enough(piece.bound, attained) || piece.depth >= max_depth || splits >= max_splits)
      return piece.bound;
    queue.pop();
    for (std::vector<double>& child : split(piece.depth, piece.b))
      add(std::move(child), piece.depth + 1);
  }
}

/// What range() asks of a bound: the maximum lies at most tol below it.
struct WithinTolerance {
  double tol;
  bool operator()(double bound, double attained) const { return bound <= attained + tol; }
};

}  // namespace bezel::bernstein
