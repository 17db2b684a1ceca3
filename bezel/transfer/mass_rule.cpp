#include "bezel/transfer/mass_rule.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/numeric/binomial.hpp"
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

namespace {

double multinomial(const std::array<int, 3>& i) {
  return binomial(i[0] + i[1] + i[2], i[2]) * binomial(i[0] + i[1], i[1]);
}

/// Integral over the reference triangle of the product of Bernstein polynomials with these
/// multi-indices, the first without its multinomial: of degree n in all, it is a multiple of one of
/// degree n, whose integral is 1 / ((n + 1) (n + 2)).
double product_integral(std::span<const std::array<int, 3>> factors) {
  std::array<int, 3> sum{};
  double factor = 1.0;
  for (const auto& i : factors) {
    if (&i != factors.data()) factor *= multinomial(i);
    for (std::size_t k = 0; k < 3; ++k) sum[k] += i[k];
  }
  const int n = sum[0] + sum[1] + sum[2];
  return factor / multinomial(sum) / ((n + 1.0) * (n + 2.0));
}

}  // namespace

MappedMass::MappedMass(int with_geometric_degree, int with_degree)
    : geometric_degree(with_geometric_degree),
      degree(with_degree),
      size(static_cast<std::size_t>(bernstein::triangle_size(with_degree))) {
  const int e = 2 * (geometric_degree - 1);
  for (int d = 0; d < bernstein::triangle_size(e); ++d) {
    const auto det = bernstein::triangle_multi_index(e, d);
    for (int i = 0; i < static_cast<int>(size); ++i) {
      const auto row = bernstein::triangle_multi_index(degree, i);
      integrals.push_back(product_integral(std::array{det, row}));
      for (int j = 0; j <= i; ++j)
        products.push_back(
            product_integral(std::array{det, row, bernstein::triangle_multi_index(degree, j)}));
    }
  }
}

void MappedMass::compute(std::span<const Vec2> control, std::span<double> mass,
                         std::span<double> integral) const {
  // det = cross(d/du, d/dv): products of Bernstein polynomials of degree g - 1.
  const int g = geometric_degree, lower = g - 1;
  std::array<double, static_cast<std::size_t>(bernstein::triangle_size(18))> det{};
  std::array<Vec2, static_cast<std::size_t>(bernstein::triangle_size(9))> du, dv;
  std::size_t n = 0;
  const auto factors = multinomials(lower);
  for (int k = 0; k <= lower; ++k) {
    for (int j = 0; j <= lower - k; ++j, ++n) {
      const auto at = [&](int jj, int kk) {
        return control[static_cast<std::size_t>(bernstein::triangle_index(g, jj, kk))];
      };
      du[n] = (at(j + 1, k) - at(j, k)) * (g * factors[n]);
      dv[n] = (at(j, k + 1) - at(j, k)) * (g * factors[n]);
    }
  }
  std::size_t first = 0;
  for (int k = 0; k <= lower; ++k) {
    for (int j = 0; j <= lower - k; ++j, ++first) {
      std::size_t second = 0;
      for (int l = 0; l <= lower; ++l)
        for (int i = 0; i <= lower - l; ++i, ++second)
          det[static_cast<std::size_t>(bernstein::triangle_index(2 * lower, j + i, k + l))] +=
              cross(du[first], dv[second]);
    }
  }
  add_up(std::span(det).first(static_cast<std::size_t>(bernstein::triangle_size(2 * lower))), mass,
         integral);
}

void MappedMass::compute_from(std::span<const double> jacobian, std::span<double> mass,
                              std::span<double> integral) const {
  std::vector<double> det(jacobian.begin(), jacobian.end());
  for (int d = 0; d < static_cast<int>(det.size()); ++d)
    det[static_cast<std::size_t>(d)] *=
        multinomial(bernstein::triangle_multi_index(2 * (geometric_degree - 1), d));
  add_up(det, mass, integral);
}

void MappedMass::add_up(std::span<const double> det, std::span<double> mass,
                        std::span<double> integral) const {
  const std::size_t packed = size * (size + 1) / 2;
  std::fill(integral.begin(), integral.end(), 0.0);
  std::fill(mass.begin(), mass.begin() + static_cast<std::ptrdiff_t>(packed), 0.0);
  for (std::size_t d = 0; d < det.size(); ++d) {
    const double value = det[d];
    const double* of = integrals.data() + d * size;
    for (std::size_t i = 0; i < size; ++i) integral[i] += value * of[i];
    const double* product = products.data() + d * packed;
    for (std::size_t i = 0; i < packed; ++i) mass[i] += value * product[i];
  }
  // From rows one after the other to a square, the last first.
  for (std::size_t i = size; i-- > 1;) {
    for (std::size_t j = i + 1; j-- > 0;) mass[i * size + j] = mass[i * (i + 1) / 2 + j];
  }
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
