#include "bezel/fit/lobatto.hpp"

#include <fmt/format.h>

#include "bezel/base/error.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::at;

// The exact difference of two doubles.
DoubleDouble difference(double a, double b) {
  const WithError d = two_sum(a, -b);
  return {d.value, d.error};
}

}  // namespace

LobattoBasis::LobattoBasis(int degree) : degree_(degree) {
  if (degree < 1 || degree > 100)
    throw InputError(fmt::format("lobatto basis of degree {}, expected 1 to 100", degree));
  const IntervalRule rule = gauss_lobatto(degree + 1);
  const int n = degree + 1;
  node_.resize(at(n));
  weight_.resize(at(n));
  barycentric_.resize(at(n));
  matrix_.assign(at(n) * at(n), 0.0);
  for (int i = 0; i < n; ++i) weight_[at(i)] = 2.0 * rule.weight[at(i)];
  for (int i = 0; 2 * i < n; ++i) {
    node_[at(i)] = 2.0 * rule.node[at(i)] - 1.0;
    node_[at(n - 1 - i)] = -node_[at(i)];
  }
  if (degree % 2 == 0) node_[at(degree / 2)] = 0.0;
  // From the rounded nodes, so that weights and matrix belong to the polynomials through them to
  // full precision. The factor 2 is one over the capacity of [-1, 1]: no over- or underflow.
  for (int j = 0; j < n; ++j) {
    double product = 1.0;
    for (int k = 0; k < n; ++k)
      if (k != j) product *= 2.0 * (node_[at(j)] - node_[at(k)]);
    barycentric_[at(j)] = 1.0 / product;
  }
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int k = 0; k < n; ++k) {
      if (k == i) continue;
      const double d = barycentric_[at(k)] / (barycentric_[at(i)] * (node_[at(i)] - node_[at(k)]));
      matrix_[row(i) + at(k)] = d;
      sum += d;
    }
    matrix_[row(i) + at(i)] = -sum;
  }
}

void LobattoBasis::values(double xi, std::span<double> out) const {
  double sum = 0.0;
  for (int k = 0; k <= degree_; ++k) {
    const double d = xi - node_[at(k)];
    if (d == 0.0) {
      for (int m = 0; m <= degree_; ++m) out[at(m)] = m == k ? 1.0 : 0.0;
      return;
    }
    out[at(k)] = barycentric_[at(k)] / d;
    sum += out[at(k)];
  }
  for (int k = 0; k <= degree_; ++k) out[at(k)] /= sum;
}

void LobattoBasis::derivatives(double xi, std::span<double> out) const {
  // l_k' = sum_i l_i(xi) l_k'(xi_i): the derivative is a polynomial of degree below d.
  std::vector<double> value(at(degree_ + 1));
  values(xi, value);
  for (int k = 0; k <= degree_; ++k) out[at(k)] = 0.0;
  for (int i = 0; i <= degree_; ++i)
    for (int k = 0; k <= degree_; ++k) out[at(k)] += value[at(i)] * matrix_[row(i) + at(k)];
}

template <int dim>
Vec<dim> LobattoBasis::evaluate(std::span<const Vec<dim>> nodal, double xi) const {
  Vec<dim> sum;
  double weight = 0.0;
  for (int k = 0; k <= degree_; ++k) {
    const double d = xi - node_[at(k)];
    if (d == 0.0) return nodal[at(k)];
    const double w = barycentric_[at(k)] / d;
    sum += w * nodal[at(k)];
    weight += w;
  }
  return (1.0 / weight) * sum;
}

template <int dim>
Vec<dim> LobattoBasis::derivative(std::span<const Vec<dim>> nodal, double xi) const {
  std::vector<double> slope(at(degree_ + 1));
  derivatives(xi, slope);
  Vec<dim> sum;
  for (int k = 0; k <= degree_; ++k) sum += slope[at(k)] * nodal[at(k)];
  return sum;
}

template <int dim>
std::vector<Vec<dim>> LobattoBasis::to_bernstein(std::span<const Vec<dim>> nodal) const {
  const int n = degree_;
  if (nodal.size() != at(n + 1))
    throw InputError(fmt::format("found {} nodal values, expected {}", nodal.size(), n + 1));
  std::vector<Vec<dim>> result(at(n + 1));
  std::vector<DoubleDouble> c(at(n + 1)), b(at(n + 1));
  for (int axis = 0; axis < dim; ++axis) {
    // Divided differences, then Horner's scheme b <- b (xi - xi_k) + c_k in Bernstein form of
    // rising degree, where xi - xi_k has the coefficients -1 - xi_k and 1 - xi_k.
    for (int i = 0; i <= n; ++i) c[at(i)] = nodal[at(i)][axis];
    for (int m = 1; m <= n; ++m)
      for (int i = n; i >= m; --i)
        c[at(i)] = (c[at(i)] - c[at(i - 1)]) / difference(node_[at(i)], node_[at(i - m)]);
    b[0] = c[at(n)];
    for (int k = n - 1, d = 0; k >= 0; --k, ++d) {
      const DoubleDouble lo = difference(-1.0, node_[at(k)]), hi = difference(1.0, node_[at(k)]);
      const DoubleDouble scale = DoubleDouble(1.0) / DoubleDouble(d + 1.0);
      for (int i = d + 1; i >= 0; --i) {
        DoubleDouble sum;
        if (i <= d) sum += DoubleDouble(d + 1.0 - i) * lo * b[at(i)];
        if (i > 0) sum += DoubleDouble(i) * hi * b[at(i - 1)];
        b[at(i)] = sum * scale + c[at(k)];
      }
    }
    for (int i = 0; i <= n; ++i) result[at(i)][axis] = b[at(i)].hi;
  }
  result.front() = nodal.front();
  result.back() = nodal.back();
  return result;
}

template Vec<2> LobattoBasis::evaluate(std::span<const Vec<2>>, double) const;
template Vec<3> LobattoBasis::evaluate(std::span<const Vec<3>>, double) const;
template Vec<2> LobattoBasis::derivative(std::span<const Vec<2>>, double) const;
template Vec<3> LobattoBasis::derivative(std::span<const Vec<3>>, double) const;
template std::vector<Vec<2>> LobattoBasis::to_bernstein(std::span<const Vec<2>>) const;
template std::vector<Vec<3>> LobattoBasis::to_bernstein(std::span<const Vec<3>>) const;

}  // namespace bezel
