#pragma once
// Fields for tests of bounds and transfers.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/field/field.hpp"

namespace bezel::test {

/// 0 or 1 on each element.
inline Field checkerboard(const std::shared_ptr<const TriangleMesh>& mesh, int degree,
                          Basis basis) {
  auto space = Space::discontinuous(mesh, degree, basis);
  std::vector<double> c(space->coefficient_count());
  RandomStream random("checkerboard", 7);
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const double value = random.uniform() < 0.5 ? 0.0 : 1.0;
    for (int i = 0; i < bernstein::triangle_size(degree); ++i) {
      c[space->offset(ElementId(e)) + static_cast<std::size_t>(i)] = value;
    }
  }
  return Field("zero or one", space, c);
}

inline std::span<const Formula> one(const Formula& f) {
  return {&f, 1};
}

/// Whether two fields have as many coefficients and each the same value.
inline bool same_coefficients(const Field& a, const Field& b) {
  return std::ranges::equal(a.coefficients(), b.coefficients());
}

/// Largest difference of two fields of one component on one mesh, at a lattice of points in each
/// element.
inline double largest_difference(const Field& a, const Field& b) {
  double largest = 0.0;
  double va = 0.0;
  double vb = 0.0;
  for (std::size_t e = 0; e < a.mesh().element_count(); ++e) {
    for (int k = 0; k <= 4; ++k) {
      for (int j = 0; j <= 4 - k; ++j) {
        const Lambda l{(4 - j - k) / 4.0, j / 4.0, k / 4.0};
        a.evaluate(ElementId(e), l, {&va, 1});
        b.evaluate(ElementId(e), l, {&vb, 1});
        largest = std::max(largest, std::abs(va - vb));
      }
    }
  }
  return largest;
}

/// Least and largest value of a field of one component at the points of a lattice in each element.
inline std::pair<double, double> sampled_range(const Field& f, int n) {
  double lo = std::numeric_limits<double>::infinity();
  double hi = -lo;
  double v = 0.0;
  const double step = 1.0 / n;
  for (std::size_t e = 0; e < f.mesh().element_count(); ++e) {
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j <= n - k; ++j) {
        f.evaluate(ElementId(e), {(n - j - k) * step, j * step, k * step}, {&v, 1});
        lo = std::min(lo, v);
        hi = std::max(hi, v);
      }
    }
  }
  return {lo, hi};
}

}  // namespace bezel::test
