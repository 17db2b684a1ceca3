#include "bezel/field/piece_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::field_detail {
namespace {

using bernstein::Range;
using short_names::at;
using short_names::u;

constexpr int piece_depth = 12;

}  // namespace

double largest(std::span<const double> c) {
  double m = 0.0;
  for (const double x : c) m = std::max(m, std::abs(x));
  return m;
}

void check_component(const Field& field, int component) {
  if (component < 0 || component >= field.components())
    throw InputError(fmt::format("component {} does not exist, field '{}' has {}", component,
                                 field.name(), field.components()));
}

std::vector<double> component_of(const Field& field, ElementId e, int component) {
  const std::span<const double> all = field.coefficients(e);
  const std::size_t n = at(field.components());
  std::vector<double> c(all.size() / n);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = all[i * n + at(component)];
  return c;
}

bool composable(const Field& field, ElementId e) {
  return field.space().basis() == Basis::reference ||
         field.space().degree(e) * field.mesh().degree() <= bernstein::max_triangle_degree;
}

Known known_from(std::span<const double> c, int d, double slack) {
  Known k{c[0], c[0], c[0], c[0], slack};
  for (const double x : c) {
    k.lo = std::min(k.lo, x);
    k.hi = std::max(k.hi, x);
  }
  for (int corner = 0; corner < 3; ++corner) {
    const double x = c[at(bernstein::triangle_corner(d, corner))];
    k.attained_lo = std::min(k.attained_lo, x);
    k.attained_hi = std::max(k.attained_hi, x);
  }
  return k;
}

PieceBounds::PieceBounds(const Frame& frame, int g, int d, std::vector<double> c)
    : frame_(frame), g_(g), d_(d), c_(std::move(c)), scale_(largest(c_)) {}

Known PieceBounds::operator()(std::span<const Vec2> control) const {
  const double infinity = std::numeric_limits<double>::infinity();
  Lambda least{infinity, infinity, infinity};
  for (const Vec2& p : control) {
    const Lambda l = frame_.lambda(p);
    for (std::size_t k = 0; k < 3; ++k) least[k] = std::min(least[k], l[k]);
  }
  // Rounding of lambda() is below 8u for the points of an element; the triangle is widened by
  // that.
  for (double& l : least) l -= 8.0 * u;
  const double size = 1.0 - (least[0] + least[1] + least[2]);
  std::array<Lambda, 3> corner{least, least, least};
  double growth = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k][k] += size;
    growth =
        std::max(growth, std::abs(corner[k][0]) + std::abs(corner[k][1]) + std::abs(corner[k][2]));
  }
  const double slack = 16.0 * (d_ + 1) * u * std::pow(growth, d_) * scale_;
  Known known = known_from(bernstein::specialize<double>(d_, c_, corner), d_, slack);
  known.lo -= slack;
  known.hi += slack;
  known.attained_lo = infinity;
  known.attained_hi = -infinity;
  for (int k = 0; k < 3; ++k) {
    const double value = bernstein::evaluate<double>(
        d_, c_, frame_.lambda(control[at(bernstein::triangle_corner(g_, k))]));
    known.attained_lo = std::min(known.attained_lo, value);
    known.attained_hi = std::max(known.attained_hi, value);
  }
  return known;
}

Range PieceBounds::range(const std::vector<Vec2>& control, double tol) const {
  const Known whole = (*this)(control);
  double lo = whole.attained_lo, hi = whole.attained_hi;  // attained
  Range bound{whole.attained_lo - whole.slack, whole.attained_hi + whole.slack};
  std::vector<std::pair<std::vector<Vec2>, int>> open{{control, 0}};
  while (!open.empty()) {
    const auto [piece, depth] = std::move(open.back());
    open.pop_back();
    const Known known = (*this)(piece);
    lo = std::min(lo, known.attained_lo);
    hi = std::max(hi, known.attained_hi);
    if (depth == piece_depth || (known.lo >= lo - tol && known.hi <= hi + tol)) {
      bound.lo = std::min(bound.lo, known.lo);
      bound.hi = std::max(bound.hi, known.hi);
      continue;
    }
    for (std::vector<Vec2>& child : bernstein::subdivide<Vec2>(g_, piece))
      open.emplace_back(std::move(child), depth + 1);
  }
  return bound;
}

PieceBounds piece_bounds(const Field& field, ElementId e, int component) {
  return {field.space().frame(e), field.mesh().degree(), field.space().degree(e),
          component_of(field, e, component)};
}

}  // namespace bezel::field_detail
