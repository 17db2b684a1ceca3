// Certified range over a mesh: coefficients tell which elements may hold the ends.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/field/piece_bounds.hpp"

namespace bezel {
namespace {

using bernstein::Range;
using field_detail::Known;

constexpr double u = 0x1p-53;
/// Elements that reach farther out of their frames (caller's frames) are bounded one by one.
constexpr double far_outside = 1e-3;
/// Corners this near to those of the frame are the same up to rounding.
constexpr double same_corner = 1e-12;
constexpr std::size_t block = 1024;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
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

ValueRanges::ValueRanges(std::shared_ptr<const Space> space) : space_(std::move(space)) {
  const TriangleMesh& mesh = *space_->mesh();
  const std::size_t elements = mesh.element_count();
  if (elements == 0) throw InputError("a mesh without elements has no range of values");
  if (space_->basis() == Basis::reference) return;
  widening_.resize(elements);
  exact_.resize(elements);
  parallel_for((elements + block - 1) / block, [&](std::size_t b) {
    for (std::size_t e = b * block; e < std::min(elements, (b + 1) * block); ++e) {
      const ElementId id(e);
      const Frame& frame = space_->frame(id);
      const auto nodes = mesh.nodes(id);
      double least = 0.0, apart = 0.0;
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Lambda l = frame.lambda(mesh.control(nodes[n]));
        least = std::min({least, l[0], l[1], l[2]});
        for (std::size_t k = 0; k < 3; ++k)
          apart = std::max(apart, std::abs(l[k] - (k == n ? 1.0 : 0.0)));
      }
      // Barycentrics not below -s: the absolute values of the three add up to at most 1 + 6 s,
      // those of the basis functions to its d-th power, and what exceeds 1 is negative and positive
      // parts in halves. 8u: the rounding of lambda at the points of an element.
      const double s = 8.0 * u - least;
      const int d = space_->degree(id);
      widening_[e] = least < -far_outside ? -1.0 : 0.5 * (std::pow(1.0 + 6.0 * s, d) - 1.0);
      exact_[e] = mesh.degree() == 1 && apart < same_corner ? 1 : 0;
    }
  });
}

double ValueRanges::attained(const Search& search, std::size_t e) const {
  const Field& field = search.field;
  const ElementId id(e);
  const std::span<const double> c = field.coefficients(id);
  const std::size_t n = at(field.components()), k = at(search.component);
  const int d = space_->degree(id), g = field.mesh().degree();
  double best = -std::numeric_limits<double>::infinity();
  std::vector<double> own;
  for (int corner = 0; corner < 3; ++corner) {
    double value = 0.0;
    if (widening_.empty()) {
      value = c[at(bernstein::triangle_corner(d, corner)) * n + k];
    } else {
      if (own.empty()) own = field_detail::component_of(field, id, search.component);
      const NodeId node = field.mesh().nodes(id)[at(bernstein::triangle_corner(g, corner))];
      value =
          bernstein::evaluate<double>(d, own, space_->frame(id).lambda(field.mesh().control(node)));
    }
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

double ValueRanges::largest(const Search& search, std::vector<Candidate> candidates) const {
  const auto before = [](const Candidate& a, const Candidate& b) {
    return a.bound != b.bound ? a.bound > b.bound : a.element < b.element;
  };
  const auto top = std::min_element(candidates.begin(), candidates.end(), before);
  double known = attained(search, top->element);
  const auto drop = [&] {
    std::erase_if(candidates, [&](const Candidate& c) { return c.bound <= known; });
  };
  drop();
  for (const Candidate& c : candidates)
    if (c.bound > known) known = std::max(known, attained(search, c.element));
  drop();
  std::sort(candidates.begin(), candidates.end(), before);
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
  const std::size_t elements = field.mesh().element_count();
  const std::size_t n = at(field.components());
  const std::span<const double> all = field.coefficients();
  std::vector<Candidate> high(elements), low(elements);
  double slack = 0.0, highest = -std::numeric_limits<double>::infinity(), lowest = highest;
  for (std::size_t e = 0; e < elements; ++e) {
    const ElementId id(e);
    const auto size = at(bernstein::triangle_size(space_->degree(id)));
    const double* c = all.data() + space_->offset(id) * n + at(component);
    double lo = *c, hi = *c;
    for (std::size_t i = 1; i < size; ++i) {
      lo = std::min(lo, c[i * n]);
      hi = std::max(hi, c[i * n]);
    }
    if (!widening_.empty() && widening_[e] >= 0.0) {
      const double wider = widening_[e] * (hi - lo);
      slack = std::max(slack, wider);
      lo -= wider;
      hi += wider;
    } else if (!widening_.empty()) {
      const Known known = field_detail::piece_bounds(field, id, component)(field.mesh().gather(id));
      slack = std::max(slack, known.slack);
      lo = known.lo;
      hi = known.hi;
    }
    high[e] = {e, hi};
    low[e] = {e, -lo};
    highest = std::max(highest, hi);
    lowest = std::max(lowest, -lo);
  }
  if (highest == -lowest) return {-lowest, highest};
  // Below the rounding of the values themselves (a constant field) there is nothing to find.
  const double rounding = std::max(slack, 64.0 * u * std::max(std::abs(lowest), std::abs(highest)));
  const double tol = std::max(rel_tol * (highest + lowest), rounding);
  return {-largest({field, component, -1.0, tol, rounding}, std::move(low)),
          largest({field, component, 1.0, tol, rounding}, std::move(high))};
}

Range value_range(const Field& field, int component, double rel_tol) {
  field_detail::check_component(field, component);
  check_tolerance(rel_tol);
  return ValueRanges(field.space_ptr())(field, component, rel_tol);
}

}  // namespace bezel
