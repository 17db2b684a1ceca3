#include "bezel/transfer/weight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"

namespace bezel::detail {
namespace {

/// A formula this near to its projection, relative to its size, is that polynomial.
constexpr double polynomial_rounding = 1e-12;
/// Values this far below zero, relative to the weight's size, are rounding.
constexpr double zero_rounding = 1e-13;

Field projected(const Formula& weight, int degree, const std::shared_ptr<const TriangleMesh>& mesh,
                int threads) {
  return project("weight", Space::discontinuous(mesh, degree, Basis::physical), {&weight, 1}, 6,
                 threads);
}

double size_of(const Field& field) {
  const bernstein::Range range = value_range(field, 0);
  return std::max(std::abs(range.lo), std::abs(range.hi));
}

/// By how much rounding of the frames of thin elements moves points in barycentric coordinates.
double frame_rounding(const Space& space) {
  double largest = 0.0;
  for (const Frame& f : space.frames()) {
    for (const Vec2& g : f.gradient) largest = std::max(largest, norm(g) * norm(f.centre));
  }
  return 0x1p-52 * largest;
}

std::vector<double> component(std::span<const double> interleaved, std::size_t components,
                              std::size_t c) {
  std::vector<double> out(interleaved.size() / components);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = interleaved[i * components + c];
  return out;
}

}  // namespace

int weight_degree(const Formula& weight, const std::shared_ptr<const TriangleMesh>& mesh,
                  const std::string& what, int threads) {
  double misses = 0.0;
  for (int degree = 0; degree <= max_weight_degree; ++degree) {
    const Field field = projected(weight, degree, mesh, threads);
    misses = error_norms(field, {&weight, 1}, 8, threads).max;
    const double rounding = std::max(polynomial_rounding, frame_rounding(field.space()));
    if (misses <= rounding * size_of(field)) return degree;
  }
  throw InputError(fmt::format(
      "weight '{}' is no polynomial of degree 0 to {} on the {} mesh: the nearest one misses it by "
      "{:.3g}",
      weight.text(), max_weight_degree, what, misses));
}

Field weight_field(const Formula& weight, int degree,
                   const std::shared_ptr<const TriangleMesh>& mesh, const std::string& what,
                   int threads) {
  Field field = projected(weight, degree, mesh, threads);
  const double rounding = zero_rounding * size_of(field);
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const ReferencePolynomial p = reference_polynomial(field, ElementId(e), 0);
    const auto [lowest, highest] = std::ranges::minmax(p.c);
    if (highest <= rounding && lowest >= -rounding)
      throw InputError(fmt::format("weight '{}' is zero on all of triangle {} of the {} mesh",
                                   weight.text(), e, what));
    if (lowest >= -rounding) continue;
    const double low = bernstein::range(p.degree, p.c, 1e-3 * (highest - lowest)).lo;
    // The coefficients reach below the values; look closer before refusing.
    const double closer = low >= -rounding ? low : bernstein::range(p.degree, p.c, rounding).lo;
    if (closer < -2.0 * rounding)
      throw InputError(
          fmt::format("weight '{}' is negative in triangle {} of the {} mesh: {:.3g}, expected 0 "
                      "or more",
                      weight.text(), e, what, closer));
  }
  return field;
}

Field in_coordinates_of(const Space& space, const Field& physical) {
  const auto& mesh = space.mesh();
  const int degree = physical.space().uniform_degree();
  if (space.basis() == Basis::reference) {
    const auto mapped = Space::discontinuous(mesh, degree * mesh->degree(), Basis::reference);
    std::vector<double> c;
    c.reserve(mapped->coefficient_count());
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      const ReferencePolynomial p = reference_polynomial(physical, ElementId(e), 0);
      c.insert(c.end(), p.c.begin(), p.c.end());
    }
    return Field(physical.name(), mapped, std::move(c));
  }
  const auto framed =
      Space::discontinuous(mesh, std::vector<int>(mesh->element_count(), degree),
                           std::vector<Frame>(space.frames().begin(), space.frames().end()));
  std::vector<double> c;
  c.reserve(framed->coefficient_count());
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const Frame& from = physical.space().frame(ElementId(e));
    std::array<Lambda, 3> corner{};
    const auto corners = framed->frame(ElementId(e)).corners();
    for (std::size_t k = 0; k < 3; ++k) corner[k] = from.lambda(corners[k]);
    const auto own =
        bernstein::specialize<double>(degree, physical.coefficients(ElementId(e)), corner);
    c.insert(c.end(), own.begin(), own.end());
  }
  return Field(physical.name(), framed, std::move(c));
}

Field product(const Field& scalar, const Field& f, std::span<const double> shift,
              const std::shared_ptr<const Space>& into) {
  const auto nc = static_cast<std::size_t>(f.components());
  std::vector<double> out(into->coefficient_count() * nc);
  for (std::size_t e = 0; e < f.mesh().element_count(); ++e) {
    const ElementId id(e);
    const int a = scalar.space().degree(id);
    const int b = f.space().degree(id);
    double* place = out.data() + into->offset(id) * nc;
    for (std::size_t c = 0; c < nc; ++c) {
      std::vector<double> own = component(f.coefficients(id), nc, c);
      if (!shift.empty()) {
        for (double& x : own) x -= shift[e * nc + c];
      }
      const auto both = bernstein::multiply(a, scalar.coefficients(id), b, own);
      const auto raised = bernstein::elevate<double>(a + b, both, into->degree(id) - a - b);
      for (std::size_t n = 0; n < raised.size(); ++n) place[n * nc + c] = raised[n];
    }
  }
  return Field(f.name(), into, std::move(out), f.components());
}

}  // namespace bezel::detail
