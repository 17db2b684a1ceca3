#include "bezel/transfer/limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::detail {
namespace {

using short_names::infinity;
using short_names::u;

/// A frame's barycentrics reach 1e-14 below 0 on its element: a polynomial of degree 10 may leave
/// its coefficients' range by less than this fraction of the largest.
constexpr double outside_frame = 1e-12;
/// A mass that does not fit by less than this fraction is rounding.
constexpr double mass_rounding = 1e-13;

void for_chunks(std::size_t n, int threads, const std::function<void(std::size_t)>& body) {
  constexpr std::size_t chunk = 32;
  parallel_for((n + chunk - 1) / chunk,
               [&](std::size_t c) {
                 for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) body(i);
               },
               threads);
}

double largest(std::span<const double> values) {
  double m = 0.0;
  for (const double x : values) m = std::max(m, std::abs(x));
  return m;
}

/// The deviation q = p - mean of the polynomials of one component, element by element.
class Deviation {
 public:
  Deviation(const Field& field, int component, std::span<const double> mean)
      : q_(make(field, component, mean)) {}

  std::span<const double> coefficients(ElementId e) const { return q_.coefficients(e); }

  /// Certified: q lies in -below..above on the element, sharp where it exceeds room_below or
  /// room_above.
  struct Reach {
    double below, above;
  };
  Reach reach(ElementId e, double room_below, double room_above) const {
    const std::span<const double> q = q_.coefficients(e);
    const auto [least, most] = std::minmax_element(q.begin(), q.end());
    const double size = std::max(-*least, *most);
    const double slack = q_.space().basis() == Basis::reference ? 0.0 : outside_frame * size;
    const Reach hull{slack - *least, slack + *most};
    if (hull.below <= room_below && hull.above <= room_above) return hull;
    const int degree = q_.space().degree(e);
    if (q_.space().basis() == Basis::physical &&
        degree * q_.mesh().degree() > bernstein::max_triangle_degree) {
      const auto range = element_range(q_, e, 0, range_tolerance * size);
      return {-range.lo, range.hi};
    }
    ReferencePolynomial p = reference_polynomial(q_, e, 0);
    const double tol = range_tolerance * size;
    const double above =
        bernstein::upper_bound(p.degree, p.c, room_above - p.error_bound, tol) + p.error_bound;
    for (double& x : p.c) x = -x;
    const double below =
        bernstein::upper_bound(p.degree, p.c, room_below - p.error_bound, tol) + p.error_bound;
    return {below, above};
  }

 private:
  static Field make(const Field& field, int component, std::span<const double> mean) {
    const Space& space = field.space();
    const auto nc = static_cast<std::size_t>(field.components());
    std::vector<double> q(space.coefficient_count());
    for (std::size_t e = 0; e < mean.size(); ++e) {
      const std::span<const double> all = field.coefficients(ElementId(e));
      const std::size_t begin = space.offset(ElementId(e));
      for (std::size_t i = 0; i * nc < all.size(); ++i)
        q[begin + i] = all[i * nc + static_cast<std::size_t>(component)] - mean[e];
    }
    return {field.name(), field.space_ptr(), std::move(q), 1};
  }
  Field q_;
};

/// Neighbours across edges.
Neighbours across_edges(const TriangleMesh& mesh) {
  return [&mesh](std::int32_t e, std::vector<std::int32_t>& out) {
    for (const SideEdge& side : mesh.edges(ElementId(e)))
      for (const ElementSide& other : mesh.adjacent(side.edge)) out.push_back(other.element.value);
  };
}

}  // namespace

std::string component_name(const Field& field, int component) {
  return fmt::format("field '{}'{}", field.name(),
                     field.components() > 1 ? fmt::format(", component {}", component) : "");
}

void check_room(const std::string& what, const ValueBounds& bounds, std::span<const double> weight,
                std::span<const double> value, const Redistribution& done) {
  double mass = 0.0;
  double size = 0.0;
  double least = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    mass += value[i] * weight[i];
    size += std::abs(value[i]) * weight[i];
    least += bounds.least(i) * weight[i];
    most += bounds.most(i) * weight[i];
  }
  if (std::abs(done.left_over) <= mass_rounding * size) return;
  throw NumericsError(
      fmt::format("{}: its mass {:.6g} does not fit into the bounds, which allow {:.6g} to {:.6g}",
                  what, mass, least, most));
}

Limited limit_discontinuous(const Field& field, int component, const ValueBounds& bounds,
                            std::span<const double> area, int threads) {
  const Space& space = field.space();
  const std::size_t elements = area.size();
  const auto nc = static_cast<std::size_t>(field.components());
  const auto coefficient = [&](std::size_t e, std::size_t i) {
    return field.coefficients()[(space.offset(ElementId(e)) + i) * nc +
                                static_cast<std::size_t>(component)];
  };
  const auto size_of = [&](std::size_t e) {
    return static_cast<std::size_t>(bernstein::triangle_size(space.degree(ElementId(e))));
  };

  const std::vector<double> mass = element_integrals(field, threads);
  std::vector<double> mean(elements);
  std::vector<char> inside(elements);  // the coefficients are within the bounds
  for_chunks(elements, threads, [&](std::size_t e) {
    mean[e] = mass[e * nc + static_cast<std::size_t>(component)] / area[e];
    double least = infinity;
    double most = -infinity;
    for (std::size_t i = 0; i < size_of(e); ++i) {
      least = std::min(least, coefficient(e, i));
      most = std::max(most, coefficient(e, i));
    }
    inside[e] = least >= bounds.least(e) && most <= bounds.most(e) ? 1 : 0;
    // Then the mean is within them too, but for the rounding of the integral.
    if (inside[e] != 0) mean[e] = std::clamp(mean[e], bounds.least(e), bounds.most(e));
  });
  std::vector<double> moved = mean;
  const Redistribution redistribution =
      redistribute(moved, area, bounds, across_edges(field.mesh()));
  Limited result;
  result.report.mass_moved = redistribution.moved;
  check_room(component_name(field, component), bounds, area, mean, redistribution);

  double scale = 0.0;  // of the whole field
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t i = 0; i < size_of(e); ++i)
      scale = std::max(scale, std::abs(coefficient(e, i)));
  const Deviation deviation(field, component, mean);
  result.coefficients.resize(space.coefficient_count());
  std::vector<bernstein::Range> range(elements);
  std::vector<char> limited(elements);
  for_chunks(elements, threads, [&](std::size_t e) {
    const std::span<double> out(result.coefficients.data() + space.offset(ElementId(e)),
                                size_of(e));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = coefficient(e, i);
    if (moved[e] == mean[e] && inside[e] != 0) {
      const auto [least, most] = std::minmax_element(out.begin(), out.end());
      range[e] = {*least, *most};
      return;
    }
    const double m = moved[e];
    const auto q = deviation.coefficients(ElementId(e));
    const double size = std::max({largest(out), std::abs(m), std::abs(mean[e])});
    // Rounding of q = c - mean and of m + theta q, in units of the values.
    const double rounding = 8.0 * u * size;
    const double room_below = m - bounds.least(e) - rounding;
    const double room_above = bounds.most(e) - m - rounding;
    const Deviation::Reach reach = deviation.reach(ElementId(e), room_below, room_above);
    double theta = 1.0;
    if (reach.above > room_above) theta = std::min(theta, room_above / reach.above);
    if (reach.below > room_below) theta = std::min(theta, room_below / reach.below);
    theta = std::max(0.0, theta < 1.0 ? theta * (1.0 - 4.0 * u) : theta);
    double change = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double c = m + theta * q[i];
      change = std::max(change, std::abs(c - out[i]));
      if (theta < 1.0 || m != mean[e]) out[i] = c;
    }
    limited[e] = change > counted_change * scale ? 1 : 0;
    const double spread = theta > 0.0 ? rounding : 0.0;
    range[e] = {std::max(bounds.least(e), m - theta * reach.below - spread),
                std::min(bounds.most(e), m + theta * reach.above + spread)};
  });
  result.range = range[0];
  for (std::size_t e = 0; e < elements; ++e) {
    result.range.lo = std::min(result.range.lo, range[e].lo);
    result.range.hi = std::max(result.range.hi, range[e].hi);
    result.report.elements_limited += limited[e];
  }
  return result;
}

Field with_coefficients(const Field& field, std::span<const Limited> components) {
  const std::size_t nc = components.size();
  std::vector<double> all(field.coefficients().size());
  for (std::size_t c = 0; c < nc; ++c) {
    for (std::size_t i = 0; i * nc < all.size(); ++i)
      all[i * nc + c] = components[c].coefficients[i];
  }
  return {field.name(), field.space_ptr(), std::move(all), field.components()};
}

}  // namespace bezel::detail
