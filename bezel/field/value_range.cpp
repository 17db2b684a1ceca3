// Certified range over a mesh: coefficients tell which elements may hold the ends.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/field/piece_bounds.hpp"
#include "bezel/field/survey.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using bernstein::Range;
using field_detail::Known;
using short_names::at;
using short_names::u;

/// Elements that reach farther out of their frames (caller's frames) are bounded one by one.
constexpr double far_outside = 1e-3;
/// Corners this near to those of the frame are the same up to rounding.
constexpr double same_corner = 1e-12;

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

Known ValueRanges::bounds_on(const Field& field, int component, std::size_t e) const {
  const ElementId id(e);
  const double share = widening(e);
  if (share < 0.0) return field_detail::piece_bounds(field, id, component)(field.mesh().gather(id));
  const auto c = field.coefficients(id);
  const auto first = at(component), step = at(field.components());
  double lo = c[first], hi = lo;
  for (std::size_t i = first + step; i < c.size(); i += step) {
    lo = std::min(lo, c[i]);
    hi = std::max(hi, c[i]);
  }
  const double wider = share * (hi - lo);
  return {lo - wider, hi + wider, 0.0, 0.0, wider};
}

double ValueRanges::attained(const Search& search, std::size_t e) const {
  const ElementId id(e);
  const int d = space_->degree(id), g = search.field.mesh().degree();
  const std::vector<double> own = field_detail::component_of(search.field, id, search.component);
  double best = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 3; ++corner) {
    double value = own[at(bernstein::triangle_corner(d, corner))];
    if (!widening_.empty()) {
      const NodeId node = search.field.mesh().nodes(id)[at(bernstein::triangle_corner(g, corner))];
      value = bernstein::evaluate<double>(
          d, own, space_->frame(id).lambda(search.field.mesh().control(node)));
    }
    best = std::max(best, search.sign * value);
  }
  return best;
}

/// An upper bound of the largest value on the element, sharp unless it is below `known`.
double ValueRanges::sharp(const Search& search, const Candidate& candidate, double known) const {
  const ElementId id(candidate.element);
  if (!widening_.empty() && widening(id.index()) >= 0.0) {
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

ValueRanges::Candidate ValueRanges::highest(const Search& search) const {
  constexpr std::size_t block = field_detail::BlockBounds::block;
  const auto most = std::max_element(search.bound.begin(), search.bound.end());
  const std::size_t begin = static_cast<std::size_t>(most - search.bound.begin()) * block;
  Candidate best{begin, -std::numeric_limits<double>::infinity()};
  for (std::size_t e = begin; e < std::min(begin + block, space_->mesh()->element_count()); ++e) {
    const Known known = bounds_on(search.field, search.component, e);
    const double bound = search.sign > 0.0 ? known.hi : -known.lo;
    if (bound > best.bound) best = {e, bound};
  }
  return best;
}

double ValueRanges::largest(const Search& search) const {
  constexpr std::size_t block = field_detail::BlockBounds::block;
  double known = attained(search, highest(search).element);
  std::vector<Candidate> candidates;
  for (std::size_t b = 0; b < search.bound.size(); ++b) {
    if (search.bound[b] <= known) continue;
    const std::size_t end = std::min((b + 1) * block, space_->mesh()->element_count());
    for (std::size_t e = b * block; e < end; ++e) {
      const Known here = bounds_on(search.field, search.component, e);
      const double bound = search.sign > 0.0 ? here.hi : -here.lo;
      if (bound > known) candidates.push_back({e, bound});
    }
  }
  for (const Candidate& c : candidates)
    if (c.bound > known) known = std::max(known, attained(search, c.element));
  std::erase_if(candidates, [&](const Candidate& c) { return c.bound <= known; });
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.bound != b.bound ? a.bound > b.bound : a.element < b.element;
  });
  for (const Candidate& c : candidates) {
    if (c.bound <= known) break;
    known = std::max(known, c.bound <= known + search.roundoff ? c.bound : sharp(search, c, known));
  }
  return known;
}

Range ValueRanges::operator()(const Field& field, int component, double rel_tol) const {
  field_detail::check_component(field, component);
  check_tolerance(rel_tol);
  if (rel_tol == 0.0) return coefficient_range(field, component);
  const field_detail::Column column{field.coefficients().data() + component,
                                    at(field.components())};
  field_detail::SurveyAim aim;
  aim.ranges = this;
  return (*this)(field, component, field_detail::survey(*space_, {&column, 1}, aim, 1).bounds, 0,
                 rel_tol);
}

Range ValueRanges::operator()(const Field& field, int component,
                              const field_detail::BlockBounds& bounds, std::size_t place,
                              double rel_tol) const {
  constexpr std::size_t block = field_detail::BlockBounds::block;
  const std::size_t elements = space_->mesh()->element_count();
  Search high{field, component, 1.0, 0.0, 0.0, {}}, low{field, component, -1.0, 0.0, 0.0, {}};
  double slack = 0.0;
  for (std::size_t i = place; i < bounds.high.size(); i += bounds.components) {
    double lo = bounds.low[i], hi = bounds.high[i];
    slack = std::max(slack, bounds.slack[i]);
    if (!std::isfinite(hi) || !std::isfinite(lo)) {
      const std::size_t begin = high.bound.size() * block;
      lo = std::numeric_limits<double>::infinity();
      hi = -lo;
      for (std::size_t e = begin; e < std::min(begin + block, elements); ++e) {
        const Known known = bounds_on(field, component, e);
        slack = std::max(slack, known.slack);
        lo = std::min(lo, known.lo);
        hi = std::max(hi, known.hi);
      }
    }
    high.bound.push_back(hi);
    low.bound.push_back(-lo);
  }
  const Range all{-*std::ranges::max_element(low.bound), *std::ranges::max_element(high.bound)};
  // Corners tell, or there is nothing to find.
  if (all.lo == all.hi || (widening_.empty() && space_->highest_degree() <= 1)) return all;
  // Below the rounding of the values themselves (a constant field) there is nothing to find.
  const double rounding = std::max(slack, 64.0 * u * std::max(std::abs(all.lo), std::abs(all.hi)));
  high.roundoff = low.roundoff = rounding;
  high.tol = low.tol = std::max(rel_tol * (all.hi - all.lo), rounding);
  return {-largest(low), largest(high)};
}

Range value_range(const Field& field, int component, double rel_tol) {
  field_detail::check_component(field, component);
  check_tolerance(rel_tol);
  return ValueRanges(field.space_ptr())(field, component, rel_tol);
}

}  // namespace bezel
