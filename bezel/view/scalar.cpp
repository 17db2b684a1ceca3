#include "bezel/view/scalar.hpp"

#include <algorithm>
#include <cmath>

namespace bezel::view {

ElementScalar::ElementScalar(const Field& field, int component)
    : field_(field), component_(component) {
  coefficients_.resize(component < 0 ? static_cast<std::size_t>(field.components()) : 1);
}

void ElementScalar::move_to(ElementId e) {
  element_ = e;
  degree_ = field_.space().degree(e);
  const std::span<const double> all = field_.coefficients(e);
  const auto components = static_cast<std::size_t>(field_.components());
  for (std::size_t c = 0; c < coefficients_.size(); ++c) {
    const std::size_t source = component_ < 0 ? c : static_cast<std::size_t>(component_);
    coefficients_[c].clear();
    for (std::size_t i = source; i < all.size(); i += components)
      coefficients_[c].push_back(all[i]);
  }
}

void ElementScalar::evaluate(std::span<const Lambda> lambda, std::span<const Vec2> x,
                             std::span<double> out) {
  const std::size_t n = out.size();
  u_.resize(n);
  v_.resize(n);
  if (field_.space().basis() == Basis::physical) {
    const Frame& frame = field_.space().frame(element_);
    for (std::size_t q = 0; q < n; ++q) {
      const auto l = frame.lambda(x[q]);
      u_[q] = l[1];
      v_[q] = l[2];
    }
  } else {
    for (std::size_t q = 0; q < n; ++q) {
      u_[q] = lambda[q][1];
      v_[q] = lambda[q][2];
    }
  }
  if (component_ >= 0) {
    bernstein::evaluate(degree_, std::span<const double>(coefficients_[0]), u_, v_, out);
    return;
  }
  std::fill(out.begin(), out.end(), 0.0);
  value_.resize(n);
  for (const std::vector<double>& c : coefficients_) {
    bernstein::evaluate(degree_, std::span<const double>(c), u_, v_, value_);
    for (std::size_t q = 0; q < n; ++q) out[q] = std::hypot(out[q], value_[q]);
  }
}

bernstein::Range scalar_range(const Field& field, int component) {
  if (component >= 0) return value_range(field, component);
  const TriangleMesh& mesh = field.mesh();
  ElementScalar scalar(field, component);
  bernstein::Range range{INFINITY, -INFINITY};
  std::vector<Lambda> lambda;
  std::vector<Vec2> x;
  std::vector<double> value;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const ElementId id(e);
    const int n = 2 * field.space().degree(id) + 4;
    const std::vector<Vec2> control = mesh.gather(id);
    lambda.clear();
    x.clear();
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n - k; ++j) {
        lambda.push_back({static_cast<double>(n - j - k) / n, static_cast<double>(j) / n,
                          static_cast<double>(k) / n});
        x.push_back(bernstein::evaluate<Vec2>(mesh.degree(), std::span<const Vec2>(control),
                                              lambda.back()));
      }
    value.resize(x.size());
    scalar.move_to(id);
    scalar.evaluate(lambda, x, value);
    const auto [lo, hi] = std::minmax_element(value.begin(), value.end());
    range.lo = std::min(range.lo, *lo);
    range.hi = std::max(range.hi, *hi);
  }
  return range;
}

std::string scalar_name(const Field& field, int component) {
  if (component < 0) return "|" + field.name() + "|";
  if (field.components() == 1) return field.name();
  return field.name() + "[" + std::to_string(component) + "]";
}

}  // namespace bezel::view
