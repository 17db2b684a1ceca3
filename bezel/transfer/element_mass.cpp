#include "bezel/transfer/element_mass.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "bezel/field/element_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"

namespace bezel::detail {

using field_detail::ElementMap;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

ElementMass::ElementMass(std::shared_ptr<const Space> space, int other_degree, int weight_degree)
    : space_(std::move(space)) {
  rule_.resize(static_cast<std::size_t>(space_->highest_degree()) + 1);
  std::vector<char> used(rule_.size(), 0);
  for (std::size_t e = 0; e < space_->mesh()->element_count(); ++e)
    used[static_cast<std::size_t>(space_->degree(ElementId(e)))] = 1;
  for (std::size_t p = 0; p < rule_.size(); ++p) {
    if (used[p] == 0) continue;
    const int degree = static_cast<int>(p) + std::max(static_cast<int>(p), other_degree);
    rule_[p] = field_detail::rule_of_degree(field_detail::integrand_degree(*space_, degree) +
                                            weight_degree);
  }
}

void ElementMass::prepare(ElementId e, Element& out) const {
  const int p = space_->degree(e);
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  ElementMap map(*space_->mesh(), e);
  const AreaMap to_round = map.make_round_for_det();
  const bool physical = space_->basis() == Basis::physical;
  const Frame frame = physical ? field_detail::moved(to_round, space_->frame(e)) : Frame();
  const TriangleRule& rule = rule_[static_cast<std::size_t>(p)];
  out.points = rule.lambda;
  out.measure.resize(rule.weight.size());
  out.basis.resize(rule.weight.size() * n);
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    const Lambda& lambda = rule.lambda[q];
    const Lambda place = physical ? frame.lambda(map(lambda)) : lambda;
    basis_at(p, place[1], place[2], out.basis.data() + q * n);
    out.measure[q] = rule.weight[q] * map.det(lambda);
  }
}

void ElementMass::weigh(std::span<const double> weight, Element& out) {
  const std::size_t n = out.basis.size() / out.measure.size();
  out.mass.assign(n * n, 0.0);
  out.integrals.assign(n, 0.0);
  for (std::size_t q = 0; q < out.measure.size(); ++q) {
    const double* phi = out.basis.data() + q * n;
    const double w = weight.empty() ? out.measure[q] : out.measure[q] * weight[q];
    for (std::size_t i = 0; i < n; ++i) {
      const double wi = w * phi[i];
      out.integrals[i] += wi;
      for (std::size_t j = 0; j < n; ++j) out.mass[i * n + j] += wi * phi[j];
    }
  }
}

void ElementMass::load(const Element& element, std::span<const double> f, std::span<double> out) {
  const std::size_t points = element.measure.size();
  const std::size_t n = element.basis.size() / points;
  const std::size_t columns = f.size() / points;
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t q = 0; q < points; ++q) {
    for (std::size_t i = 0; i < n; ++i) {
      const double wi = element.measure[q] * element.basis[q * n + i];
      for (std::size_t c = 0; c < columns; ++c) out[i * columns + c] += wi * f[q * columns + c];
    }
  }
}

bool ElementMass::solve(const Element& element, std::span<double> rhs) {
  const auto n = static_cast<Eigen::Index>(element.integrals.size());
  const Eigen::Map<const Matrix> mass(element.mass.data(), n, n);
  const Eigen::LLT<Eigen::MatrixXd> factor(mass);
  if (factor.info() != Eigen::Success) return false;
  Eigen::Map<Matrix> x(rhs.data(), n, static_cast<Eigen::Index>(rhs.size()) / n);
  const Eigen::MatrixXd b = x;
  Eigen::MatrixXd found = factor.solve(b);
  found += factor.solve(b - mass * found);
  x = found;
  return true;
}

}  // namespace bezel::detail
