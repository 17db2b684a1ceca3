#pragma once
// The range of a field on one element, and of many fields on a mesh.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel {

/// Certified range of one component on one element: contains every value there.
///
/// @param tol  at least 0: each end lies within tol of the true one, or the search has ended (20000
///             splits; 2^-12 of the element where d g > 40 in a physical basis)
/// @throws InputError when the element or component does not exist or tol is negative or NaN
/// @cost   a physical basis is composed with the element's map first: O((d g)^4)
bernstein::Range element_range(const Field& field, ElementId e, int component, double tol);

/// value_range() for many fields of one space: what depends on the elements only is done once.
class ValueRanges {
 public:
  /// @throws InputError when the mesh has no elements
  explicit ValueRanges(std::shared_ptr<const Space> space, int threads = 0);

  /// As value_range(). May be called from several threads at once.
  /// @param field  on the space given, or one with the same elements, degrees and frames
  /// @cost   one look at the coefficients, and element_range() on the elements that may hold an
  ///         end: the larger their coefficients the earlier, until none is left that can move it
  bernstein::Range operator()(const Field& field, int component, double rel_tol = 1e-3) const;

 private:
  struct Candidate {
    std::size_t element;
    double bound;
  };
  struct Search {
    const Field& field;
    int component;
    double sign;      // 1: the largest value, -1: minus the smallest
    double tol;       // wanted
    double roundoff;  // not worth looking for
  };
  bernstein::Range in_reference(const Field& field, int component, double rel_tol) const;
  /// @param slack      up to which bounds say nothing
  /// @param attained   values that occur
  /// @param all        the ends of the bounds
  /// @param low, high  upper bounds of -f and f by element
  bernstein::Range search_both(const Field& field, int component, double rel_tol, double slack,
                               const bernstein::Range& attained, const bernstein::Range& all,
                               std::span<const double> low, std::span<const double> high) const;
  double largest(const Search& search, double known, std::span<const double> bounds) const;
  /// The largest value at the corners of an element (physical basis).
  double attained(const Search& search, std::size_t e) const;
  double sharp(const Search& search, const Candidate& candidate, double known) const;

  std::shared_ptr<const Space> space_;
  /// Physical basis: by which share of their width the coefficients' range must be widened to hold
  /// the values on the element; negative where the element lies too far outside its frame.
  std::vector<double> widening_;
  std::vector<std::uint8_t> exact_;  // the element is its frame's triangle, up to rounding
};

}  // namespace bezel
