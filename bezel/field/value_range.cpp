// Certified range over a mesh: coefficients tell which elements may hold the ends.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/field/piece_bounds.hpp"
#include "bezel/numeric/numbers.hpp"

namespace bezel {
namespace {

using bernstein::Range;
using field_detail::Known;

constexpr double u = 0x1p-53;
/// Elements that reach farther out of their frames (caller's frames) are bounded one by one.
constexpr double far_outside = 1e-3;
/// Corners this near to those of the frame are the same up to rounding.
constexpr double same_corner = 1e-12;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

double power(double x, int d) {
  double product = 1.0;
  for (int i = 0; i < d; ++i) product *= x;
  return product;
}

void check_tolerance(double rel_tol) {
  if (!(rel_tol >= 0.0 && rel_tol <= 1.0))
    throw InputError(fmt::format("found relative tolerance {}, expected 0..1", rel_tol));
}

/// The range of the coefficients in reference coordinates.
Range coefficient_range(const Field& field, int component) {
  const std::size_t elements = field.mesh().element_count();
  std::vector<Range> of(elements);
  field_detail::for_elements(field.mesh(), [&](ElementId e) {
    if (field_detail::composable(field, e)) {
      const ReferencePolynomial p = reference_polynomial(field, e, component);
      const auto [lo, hi] = std::minmax_element(p.c.begin(), p.c.end());
      of[e.index()] = {*lo - p.error_bound, *hi + p.error_bound};
    } else {
      const Known known = field_detail::piece_bounds(field, e, component)(field.mesh().gather(e));
      of[e.index()] = {known.lo, known.hi};
    }
  });
  Range all = of[0];
  for (const Range& r : of) all = {std::min(all.lo, r.lo), std::max(all.hi, r.hi)};
  return all;
}

}  // namespace

ValueRanges::ValueRanges(std::shared_ptr<const Space> space, int threads)
    : space_(std::move(space)) {
  const TriangleMesh& mesh = *space_->mesh();
  const std::size_t elements = mesh.element_count();
  if (elements == 0) throw InputError("a mesh without elements has no range of values");
  if (space_->basis() == Basis::reference) return;
  const bool straight = mesh.degree() == 1;
  widening_.resize(elements);
  exact_.resize(elements);
  field_detail::for_chunks(elements, threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e) {
      const ElementId id(e);
      const Frame& frame = space_->frame(id);
      const auto nodes = mesh.nodes(id);
      double least = 0.0, apart = 0.0;
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Lambda l = frame.lambda(mesh.control(nodes[n]));
        least = std::min(std::min(least, l[0]), std::min(l[1], l[2]));
        if (!straight) continue;
        Lambda off = l;
        off[n] -= 1.0;
        apart = std::max(std::max(apart, std::abs(off[0])),
                         std::max(std::abs(off[1]), std::abs(off[2])));
      }
      // Barycentrics not below -s: the absolute values of the three add up to at most 1 + 6 s,
      // those of the basis functions to its d-th power, and what exceeds 1 is negative and positive
      // parts in halves. 8u: the rounding of lambda at the points of an element.
      const double s = 8.0 * u - least;
      const int d = space_->degree(id);
      widening_[e] = least < -far_outside ? -1.0 : 0.5 * (power(1.0 + 6.0 * s, d) - 1.0);
      exact_[e] = straight && apart < same_corner ? 1 : 0;
    }
  });
}

double ValueRanges::attained(const Search& search, std::size_t e) const {
  const ElementId id(e);
  const int d = space_->degree(id), g = search.field.mesh().degree();
  const std::vector<double> own = field_detail::component_of(search.field, id, search.component);
  double best = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 3; ++corner) {
    const NodeId node = search.field.mesh().nodes(id)[at(bernstein::triangle_corner(g, corner))];
    const double value = bernstein::evaluate<double>(
        d, own, space_->frame(id).lambda(search.field.mesh().control(node)));
    best = std::max(best, search.sign * value);
  }
  return best;
}

/// An upper bound of the largest value on the element, sharp unless it is below `known`.
double ValueRanges::sharp(const Search& search, const Candidate& candidate, double known) const {
  const ElementId id(candidate.element);
  if (!widening_.empty() && widening_[id.index()] >= 0.0) {
    // On the whole frame first: cheaper than the composition with the element's map.
    std::vector<double> c = field_detail::component_of(search.field, id, search.component);
    for (double& x : c) x *= search.sign;
    const auto [lo, hi] = std::minmax_element(c.begin(), c.end());
    const double wider = widening_[id.index()] * (*hi - *lo);
    const int d = space_->degree(id);
    if (exact_[id.index()] != 0)
      return std::min(candidate.bound, bernstein::range(d, c, search.tol).hi + wider);
    const double bound = bernstein::upper_bound(d, c, known - wider, search.tol) + wider;
    if (bound <= known) return bound;
  }
  const Range range = element_range(search.field, id, search.component, search.tol);
  return std::min(candidate.bound, search.sign > 0.0 ? range.hi : -range.lo);
}

double ValueRanges::largest(const Search& search, double known,
                            std::span<const double> bounds) const {
  std::vector<Candidate> candidates;
  for (std::size_t e = 0; e < bounds.size(); ++e)
    if (bounds[e] > known) candidates.push_back({e, bounds[e]});
  if (!widening_.empty()) {
    for (const Candidate& c : candidates)
      if (c.bound > known) known = std::max(known, attained(search, c.element));
    std::erase_if(candidates, [&](const Candidate& c) { return c.bound <= known; });
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.bound != b.bound ? a.bound > b.bound : a.element < b.element;
  });
  for (const Candidate& c : candidates) {
    if (c.bound <= known) break;
    known = std::max(known, c.bound <= known + search.roundoff ? c.bound : sharp(search, c, known));
  }
  return known;
}

Range ValueRanges::in_reference(const Field& field, int component, double rel_tol) const {
  const std::size_t elements = field.mesh().element_count();
  const std::size_t n = at(field.components());
  const double* coefficients = field.coefficients().data() + component;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Range attained{infinity, -infinity}, all = attained;  // at corners; of the coefficients
  const bool corners_tell = space_->highest_degree() <= 1;
  Numbers high(corners_tell ? 0 : elements), low(high.size());
  const auto look = [&](auto fixed) {
    const double* c = coefficients;
    const std::size_t step = fixed() > 0 ? 1 : n;
    for (std::size_t e = 0; e < elements; ++e) {
      const int d = space_->degree(ElementId(e));
      const std::size_t size = fixed() > 0 ? fixed() : at(bernstein::triangle_size(d));
      const double first = c[0], second = c[at(d) * step], third = c[(size - 1) * step];
      double lo = std::min(std::min(first, second), third);
      double hi = std::max(std::max(first, second), third);
      attained = {std::min(attained.lo, lo), std::max(attained.hi, hi)};
      if (!corners_tell) {
        for (std::size_t i = 1; i + 1 < size; ++i) {
          lo = std::min(lo, c[i * step]);
          hi = std::max(hi, c[i * step]);
        }
        all = {std::min(all.lo, lo), std::max(all.hi, hi)};
        high[e] = hi;
        low[e] = -lo;
      }
      c += size * step;
    }
  };
  const int uniform = space_->uniform_degree();
  bernstein::with_triangle_size(uniform >= 0 && n == 1 ? at(bernstein::triangle_size(uniform)) : 0,
                                look);
  return corners_tell ? attained
                      : search_both(field, component, rel_tol, 0.0, attained, all, low, high);
}

Range ValueRanges::search_both(const Field& field, int component, double rel_tol, double slack,
                               const Range& attained, const Range& all, std::span<const double> low,
                               std::span<const double> high) const {
  if (all.lo == all.hi) return all;
  // Below the rounding of the values themselves (a constant field) there is nothing to find.
  const double rounding = std::max(slack, 64.0 * u * std::max(std::abs(all.lo), std::abs(all.hi)));
  const double tol = std::max(rel_tol * (all.hi - all.lo), rounding);
  return {-largest({field, component, -1.0, tol, rounding}, -attained.lo, low),
          largest({field, component, 1.0, tol, rounding}, attained.hi, high)};
}

Range ValueRanges::operator()(const Field& field, int component, double rel_tol) const {
  field_detail::check_component(field, component);
  check_tolerance(rel_tol);
  if (rel_tol == 0.0) return coefficient_range(field, component);
  if (widening_.empty()) return in_reference(field, component, rel_tol);
  const std::size_t elements = field.mesh().element_count();
  const std::size_t n = at(field.components());
  const double* coefficients = field.coefficients().data() + component;
  Numbers high(elements), low(elements);
  double slack = 0.0;
  std::size_t highest = 0, lowest = 0;
  const auto look = [&](auto fixed) {
    const double* c = coefficients;
    const std::size_t step = fixed() > 0 ? 1 : n;
    for (std::size_t e = 0; e < elements; ++e) {
      const ElementId id(e);
      const std::size_t size =
          fixed() > 0 ? fixed() : at(bernstein::triangle_size(space_->degree(id)));
      double lo = *c, hi = *c;
      for (std::size_t i = 1; i < size; ++i) {
        lo = std::min(lo, c[i * step]);
        hi = std::max(hi, c[i * step]);
      }
      if (widening_[e] >= 0.0) {
        const double wider = widening_[e] * (hi - lo);
        slack = std::max(slack, wider);
        lo -= wider;
        hi += wider;
      } else {
        const Known known =
            field_detail::piece_bounds(field, id, component)(field.mesh().gather(id));
        slack = std::max(slack, known.slack);
        lo = known.lo;
        hi = known.hi;
      }
      high[e] = hi;
      low[e] = -lo;
      if (hi > high[highest]) highest = e;
      if (-lo > low[lowest]) lowest = e;
      c += size * step;
    }
  };
  const int uniform = space_->uniform_degree();
  bernstein::with_triangle_size(uniform >= 0 && n == 1 ? at(bernstein::triangle_size(uniform)) : 0,
                                look);
  const Range known{-attained({field, component, -1.0, 0.0, 0.0}, lowest),
                    attained({field, component, 1.0, 0.0, 0.0}, highest)};
  return search_both(field, component, rel_tol, slack, known, {-low[lowest], high[highest]}, low,
                     high);
}

Range value_range(const Field& field, int component, double rel_tol) {
  field_detail::check_component(field, component);
  check_tolerance(rel_tol);
  return ValueRanges(field.space_ptr())(field, component, rel_tol);
}

}  // namespace bezel
