#include "bezel/transfer/element_mass.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "bezel/field/element_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"

namespace bezel::detail {

using field_detail::ElementMap;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

ElementMass::ElementMass(std::shared_ptr<const Space> space, int weight_degree)
    : space_(std::move(space)), weight_degree_(weight_degree) {
  rule_.resize(static_cast<std::size_t>(space_->highest_degree()) + 1);
  std::vector<char> used(rule_.size(), 0);
  for (std::size_t e = 0; e < space_->mesh()->element_count(); ++e)
    used[static_cast<std::size_t>(space_->degree(ElementId(e)))] = 1;
  for (std::size_t p = 0; p < rule_.size(); ++p) {
    if (used[p] == 0) continue;
    rule_[p] = field_detail::rule_of_degree(
        field_detail::integrand_degree(*space_, 2 * static_cast<int>(p)) + weight_degree);
  }
}

void ElementMass::compute(ElementId e, std::span<const double> weight, Matrices& out) const {
  const int p = space_->degree(e);
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  const ElementMap map(*space_->mesh(), e);
  const TriangleRule& rule = rule_[static_cast<std::size_t>(p)];
  out.mass.assign(n * n, 0.0);
  out.integrals.assign(n, 0.0);
  std::vector<double> phi(n);
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    const Lambda& lambda = rule.lambda[q];
    const Lambda place = field_detail::own_lambda(*space_, e, map, lambda);
    basis_at(p, place[1], place[2], phi.data());
    double w = rule.weight[q] * map.derivatives(lambda).det();
    if (!weight.empty()) w *= bernstein::evaluate<double>(weight_degree_, weight, lambda);
    for (std::size_t i = 0; i < n; ++i) {
      const double wi = w * phi[i];
      out.integrals[i] += wi;
      for (std::size_t j = 0; j < n; ++j) out.mass[i * n + j] += wi * phi[j];
    }
  }
}

bool ElementMass::solve(const Matrices& system, std::size_t columns, std::span<double> rhs) {
  const auto n = static_cast<Eigen::Index>(system.integrals.size());
  const Eigen::Map<const Matrix> mass(system.mass.data(), n, n);
  const Eigen::LLT<Eigen::MatrixXd> factor(mass);
  if (factor.info() != Eigen::Success) return false;
  Eigen::Map<Matrix> x(rhs.data(), n, static_cast<Eigen::Index>(columns));
  const Eigen::MatrixXd b = x;
  Eigen::MatrixXd found = factor.solve(b);
  found += factor.solve(b - mass * found);
  x = found;
  return true;
}

}  // namespace bezel::detail
