// Certified ranges: an element's polynomial in reference coordinates, or bounds piece by piece.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/field/field.hpp"

namespace bezel {
namespace {

using bernstein::Range;
using bernstein::triangle_index;
using bernstein::triangle_size;

constexpr double u = 0x1p-53;
constexpr int piece_depth = 12;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

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

/// Bound of the rounding error of Frame::lambda at a point.
double lambda_error(const Frame& frame, const Vec2& p) {
  const Vec2 r = p - frame.centre;
  double size = 1.0;
  for (const Vec2& g : frame.gradient) size += std::abs(g.x() * r.x()) + std::abs(g.y() * r.y());
  return 4.0 * u * size;
}

bool composable(const Field& field, ElementId e) {
  return field.space().basis() == Basis::reference ||
         field.space().degree(e) * field.mesh().degree() <= bernstein::max_triangle_degree;
}

/// What is known of the values on one element.
struct Known {
  double lo, hi;                    // no value lies outside
  double attained_lo, attained_hi;  // values at corners, within `slack`
  double slack;
};

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

/// Bounds of a polynomial in x and y on a piece of an element: its coefficients on the smallest
/// triangle with sides parallel to the frame's that holds the piece's control points. Used where
/// the composition's degree is too high.
class PieceBounds {
 public:
  PieceBounds(const Frame& frame, int g, int d, std::vector<double> c)
      : frame_(frame), g_(g), d_(d), c_(std::move(c)), scale_(largest(c_)) {}

  Known operator()(std::span<const Vec2> control) const {
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
      growth = std::max(growth,
                        std::abs(corner[k][0]) + std::abs(corner[k][1]) + std::abs(corner[k][2]));
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

  /// Both ends within tol where 2^-piece_depth of the element suffices.
  Range range(const std::vector<Vec2>& control, double tol) const {
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

 private:
  Frame frame_;
  int g_, d_;
  std::vector<double> c_;
  double scale_;
};

PieceBounds piece_bounds(const Field& field, ElementId e, int component) {
  return {field.space().frame(e), field.mesh().degree(), field.space().degree(e),
          component_of(field, e, component)};
}

}  // namespace

ReferencePolynomial reference_polynomial(const Field& field, ElementId e, int component) {
  check_component(field, component);
  const Space& space = field.space();
  std::vector<double> c = component_of(field, e, component);  // checks e
  const int d = space.degree(e);
  if (space.basis() == Basis::reference) return {d, std::move(c), 0.0};
  const int g = field.mesh().degree();
  if (d * g > bernstein::max_triangle_degree)
    throw InputError({{}, 0, "triangle", e.value},
                     fmt::format("its polynomial has degree {} x {} = {} in reference coordinates, "
                                 "the limit is {}",
                                 d, g, d * g, bernstein::max_triangle_degree));
  // The frame's barycentrics of the control points are the Bernstein coefficients of lambda_k(u,
  // v).
  const field_detail::ElementMap map(field.mesh(), e);
  std::array<std::vector<double>, 3> lambda;
  double growth = 1.0, rounding = 0.0;
  for (const Vec2& p : map.control()) {
    const Lambda l = space.frame(e).lambda(p);
    rounding = std::max(rounding, lambda_error(space.frame(e), p));
    for (std::size_t k = 0; k < 3; ++k) lambda[k].push_back(l[k]);
    growth = std::max(growth, std::abs(l[0]) + std::abs(l[1]) + std::abs(l[2]));
  }
  // Each of the d steps multiplies by lambda and adds: a coefficient of a product is a sum of at
  // most triangle_size(g) products of relative error a few u whose weights sum to 1, and three
  // lambda are off by `rounding` each. Twice the first-order sum covers the higher orders.
  const double step = (triangle_size(g) + 8) * u * growth + 3.0 * rounding;
  const double bound = 2.0 * d * step * std::pow(growth, d) * largest(c);
  std::vector<std::vector<double>> layer;
  for (const double x : c) layer.push_back({x});
  for (int r = 1; r <= d;
       ++r) {  // layer: polynomials of degree g (r-1), one per index of degree d-r+1
    std::vector<std::vector<double>> next;
    for (int row = 0; row <= d - r; ++row)
      for (int j = 0; j + row <= d - r; ++j) {
        const std::array<int, 3> from{triangle_index(d - r + 1, j, row),
                                      triangle_index(d - r + 1, j + 1, row),
                                      triangle_index(d - r + 1, j, row + 1)};
        std::vector<double> sum(at(triangle_size(g * r)), 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::vector<double> product =
              bernstein::multiply(g, lambda[k], g * (r - 1), layer[at(from[k])]);
          for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += product[i];
        }
        next.push_back(std::move(sum));
      }
    layer = std::move(next);
  }
  return {d * g, std::move(layer[0]), bound};
}

Range element_range(const Field& field, ElementId e, int component, double tol) {
  check_component(field, component);
  if (!(tol >= 0.0)) throw InputError(fmt::format("found tolerance {}, expected at least 0", tol));
  (void)field.coefficients(e);  // checks e
  if (!composable(field, e))
    return piece_bounds(field, e, component).range(field.mesh().gather(e), tol);
  const ReferencePolynomial p = reference_polynomial(field, e, component);
  const Range range = bernstein::range(p.degree, p.c, tol);
  return {range.lo - p.error_bound, range.hi + p.error_bound};
}

Range value_range(const Field& field, int component, double rel_tol) {
  check_component(field, component);
  if (!(rel_tol >= 0.0 && rel_tol <= 1.0))
    throw InputError(fmt::format("found relative tolerance {}, expected 0..1", rel_tol));
  const TriangleMesh& mesh = field.mesh();
  const std::size_t elements = mesh.element_count();
  if (elements == 0) throw InputError("a mesh without elements has no range of values");
  std::vector<Known> known(elements);
  field_detail::for_elements(mesh, [&](ElementId e) {
    // A first look must be cheap: composing a physical basis with the element's map is not.
    const bool look = field.space().basis() == Basis::physical && rel_tol > 0.0;
    if (!look && composable(field, e)) {
      const ReferencePolynomial p = reference_polynomial(field, e, component);
      known[e.index()] = known_from(p.c, p.degree, p.error_bound);
      known[e.index()].lo -= p.error_bound;
      known[e.index()].hi += p.error_bound;
    } else {
      known[e.index()] = piece_bounds(field, e, component)(mesh.gather(e));
    }
  });
  Known all = known[0];
  for (const Known& k : known) {
    all.lo = std::min(all.lo, k.lo);
    all.hi = std::max(all.hi, k.hi);
    all.attained_lo = std::min(all.attained_lo, k.attained_lo);
    all.attained_hi = std::max(all.attained_hi, k.attained_hi);
    all.slack = std::max(all.slack, k.slack);
  }
  if (rel_tol == 0.0 || all.hi == all.lo) return {all.lo, all.hi};
  // Below the rounding of the values themselves (a constant field) there is nothing to find.
  const double rounding = 64.0 * u * std::max(std::abs(all.lo), std::abs(all.hi));
  const double tol = std::max({rel_tol * (all.hi - all.lo), all.slack, rounding});

  // Elements whose bounds already lie between values attained elsewhere cannot move the ends.
  std::vector<std::size_t> open;
  for (std::size_t e = 0; e < elements; ++e)
    if (known[e].lo < all.attained_lo || known[e].hi > all.attained_hi) open.push_back(e);
  std::vector<Range> sharp(open.size());
  parallel_for(open.size(), [&](std::size_t i) {
    sharp[i] = element_range(field, ElementId(open[i]), component, tol);
  });
  // Certified without slack: the elements left out have their bounds inside, the others add theirs.
  Range result{all.attained_lo, all.attained_hi};
  for (const Range& r : sharp) {
    result.lo = std::min(result.lo, r.lo);
    result.hi = std::max(result.hi, r.hi);
  }
  // Outward rounding of the sharpened bounds may overshoot the coefficients, which are bounds
  // themselves.
  return {std::max(result.lo, all.lo), std::min(result.hi, all.hi)};
}

}  // namespace bezel
