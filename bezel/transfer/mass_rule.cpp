#include "bezel/transfer/mass_rule.hpp"

#include <cmath>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"

namespace bezel::detail {

MassRule make_mass_rule(int geometric_degree, int degree) {
  const int g = geometric_degree;
  const TriangleRule points = field_detail::rule_of_degree(degree);
  MassRule made{degree, {}, {}, {}};
  std::vector<double> lower(static_cast<std::size_t>(bernstein::triangle_size(g - 1)));
  std::vector<double> value(static_cast<std::size_t>(bernstein::triangle_size(g)));
  for (std::size_t q = 0; q < points.weight.size(); ++q) {
    const auto& l = points.lambda[q];
    made.place.push_back({l[1], l[2]});
    made.weight.push_back(points.weight[q]);
    basis_at(g, l[1], l[2], value.data());
    basis_at(g - 1, l[1], l[2], lower.data());
    // d/du B_ijk = g (B_{i,j-1,k} - B_{i-1,j,k}), both of degree g-1; the same for v with k.
    int n = 0;
    for (int k = 0; k <= g; ++k) {
      for (int j = 0; j <= g - k; ++j, ++n) {
        const auto at = [&](int jj, int kk) {
          return jj < 0 || kk < 0 || jj + kk > g - 1
                     ? 0.0
                     : lower[static_cast<std::size_t>(bernstein::triangle_index(g - 1, jj, kk))];
        };
        const double first = at(j, k);
        made.map.push_back({value[static_cast<std::size_t>(n)], g * (at(j - 1, k) - first),
                            g * (at(j, k - 1) - first)});
      }
    }
  }
  return made;
}

bool cholesky(std::size_t n, std::span<double> lower) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = lower[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i * n + k] * lower[j * n + k];
      if (i == j) {
        if (!(sum > 0.0)) return false;
        lower[j * n + j] = std::sqrt(sum);
      } else {
        lower[i * n + j] = sum / lower[j * n + j];
      }
    }
  }
  return true;
}

}  // namespace bezel::detail
