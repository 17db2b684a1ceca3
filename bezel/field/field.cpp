#include "bezel/field/field.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/numeric/finite.hpp"

namespace bezel {
namespace {

using field_detail::ElementMap;
using field_detail::largest_size;

constexpr std::size_t buffer_size = static_cast<std::size_t>(largest_size);

void check_element(const TriangleMesh& mesh, ElementId e) {
  if (!e.valid() || e.index() >= mesh.element_count())
    throw InputError(
        fmt::format("triangle {} does not exist, the mesh has {}", e.value, mesh.element_count()));
}

void check_size(std::size_t found, std::size_t expected) {
  if (found != expected)
    throw InputError(fmt::format("found room for {} values, expected {}", found, expected));
}

}  // namespace

Field::Field(std::string name, std::shared_ptr<const Space> space, std::vector<double> coefficients,
             int components)
    : name_(std::move(name)),
      space_(std::move(space)),
      coefficients_(std::move(coefficients)),
      components_(components) {
  if (name_.empty()) throw InputError("a field needs a name, found an empty one");
  if (!space_)
    throw InputError(fmt::format("field '{}' needs a space, found a null pointer", name_));
  if (components_ < 1 || components_ > max_components)
    throw InputError(fmt::format("field '{}' has {} components, expected 1..{}", name_, components_,
                                 max_components));
  const std::size_t n = static_cast<std::size_t>(components_);
  if (coefficients_.size() != space_->coefficient_count() * n)
    throw InputError(
        fmt::format("field '{}' has {} values, expected {} (coefficients {} x components {})",
                    name_, coefficients_.size(), space_->coefficient_count() * n,
                    space_->coefficient_count(), components_));
  if (all_finite(coefficients_)) return;
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    if (std::isfinite(coefficients_[i])) continue;
    // The element that owns it: the last whose offset is not above i / n.
    std::size_t lo = 0, hi = mesh().element_count();
    while (hi - lo > 1) {
      const std::size_t middle = lo + (hi - lo) / 2;
      (space_->offset(ElementId(middle)) <= i / n ? lo : hi) = middle;
    }
    throw InputError({{}, 0, "triangle", static_cast<std::int64_t>(lo)},
                     fmt::format("field '{}' has a value that is not finite", name_));
  }
}

std::span<const double> Field::coefficients(ElementId e) const {
  check_element(mesh(), e);
  const std::size_t n = static_cast<std::size_t>(components_);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(space_->degree(e)));
  return {coefficients_.data() + space_->offset(e) * n, size * n};
}

void Field::evaluate(ElementId e, const Lambda& lambda, std::span<double> out) const {
  const std::span<const double> c = coefficients(e);
  const std::size_t n = static_cast<std::size_t>(components_);
  check_size(out.size(), n);
  Lambda own = lambda;
  if (space_->basis() == Basis::physical)
    own = space_->frame(e).lambda(ElementMap(mesh(), e)(lambda));
  const int d = space_->degree(e);
  std::array<double, buffer_size> basis;
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(d));
  bernstein::basis(d, own, {basis.data(), size});
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += basis[i] * c[i * n + k];
    out[k] = sum;
  }
}

void Field::evaluate(ElementId e, std::span<const Lambda> lambda, std::span<double> out) const {
  const std::span<const double> c = coefficients(e);
  const std::size_t n = static_cast<std::size_t>(components_);
  check_size(out.size(), lambda.size() * n);
  const int d = space_->degree(e);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(d));
  const bool physical = space_->basis() == Basis::physical;

  std::array<double, buffer_size * max_components> split;  // one component after the other
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < size; ++i) split[k * size + i] = c[i * n + k];
  std::array<double, buffer_size> control_x, control_y;
  std::size_t nodes = 0;
  if (physical) {
    const ElementMap map(mesh(), e);
    nodes = map.control().size();
    for (std::size_t i = 0; i < nodes; ++i) {
      control_x[i] = map.control()[i].x();
      control_y[i] = map.control()[i].y();
    }
  }

  constexpr std::size_t block = 64;
  std::array<double, block> u, v, x, y, value;
  for (std::size_t start = 0; start < lambda.size(); start += block) {
    const std::size_t m = std::min(block, lambda.size() - start);
    for (std::size_t q = 0; q < m; ++q) {
      u[q] = lambda[start + q][1];
      v[q] = lambda[start + q][2];
    }
    if (physical) {
      const Frame& frame = space_->frame(e);
      const int g = mesh().degree();
      bernstein::evaluate(g, std::span<const double>(control_x.data(), nodes),
                          std::span<const double>(u.data(), m),
                          std::span<const double>(v.data(), m), std::span<double>(x.data(), m));
      bernstein::evaluate(g, std::span<const double>(control_y.data(), nodes),
                          std::span<const double>(u.data(), m),
                          std::span<const double>(v.data(), m), std::span<double>(y.data(), m));
      for (std::size_t q = 0; q < m; ++q) {
        const std::array<double, 3> own = frame.lambda(Vec2{x[q], y[q]});
        u[q] = own[1];
        v[q] = own[2];
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      bernstein::evaluate(d, std::span<const double>(split.data() + k * size, size),
                          std::span<const double>(u.data(), m),
                          std::span<const double>(v.data(), m), std::span<double>(value.data(), m));
      for (std::size_t q = 0; q < m; ++q) out[(start + q) * n + k] = value[q];
    }
  }
}

void Field::gradient(ElementId e, const Lambda& lambda, std::span<double> out) const {
  const std::span<const double> c = coefficients(e);
  const std::size_t n = static_cast<std::size_t>(components_);
  check_size(out.size(), 2 * n);
  const int d = space_->degree(e);
  if (d == 0) {
    for (double& value : out) value = 0.0;
    return;
  }
  const ElementMap map(mesh(), e);
  const bool physical = space_->basis() == Basis::physical;
  const field_detail::MapPoint at = map.derivatives(lambda);
  const Lambda own = physical ? space_->frame(e).lambda(at.x) : lambda;
  // d p / d lambda_m = d * sum over |alpha| = d-1 of B_alpha c_(alpha + e_m).
  std::array<double, buffer_size> basis;
  bernstein::basis(d - 1, own,
                   {basis.data(), static_cast<std::size_t>(bernstein::triangle_size(d - 1))});
  for (std::size_t k = 0; k < n; ++k) {
    double along0 = 0.0, along1 = 0.0, along2 = 0.0;
    std::size_t i = 0;
    for (int row = 0; row < d; ++row)
      for (int j = 0; j + row < d; ++j, ++i) {
        const auto here = static_cast<std::size_t>(bernstein::triangle_index(d, j, row));
        const auto above = static_cast<std::size_t>(bernstein::triangle_index(d, j, row + 1));
        along0 += basis[i] * c[here * n + k];
        along1 += basis[i] * c[(here + 1) * n + k];
        along2 += basis[i] * c[above * n + k];
      }
    const double du = d * (along1 - along0), dv = d * (along2 - along0);
    Vec2 result;
    if (physical) {
      const Frame& frame = space_->frame(e);
      result = du * frame.gradient[1] + dv * frame.gradient[2];  // gradient 0 = -(1 + 2)
    } else {
      result = field_detail::to_physical(at, du, dv);
    }
    out[2 * k] = result.x();
    out[2 * k + 1] = result.y();
  }
}

Field Field::renamed(std::string name) const {
  return Field(std::move(name), space_, coefficients_, components_);
}

}  // namespace bezel
