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

namespace field_detail {

struct Known;

/// Bounds of the values of several components on blocks of consecutive elements, shape (blocks,
/// components); infinite where an element of the block must be bounded by itself.
struct BlockBounds {
  static constexpr std::size_t block = 32;
  std::size_t components = 0;
  std::vector<double> low, high;
  std::vector<double> slack;  ///< up to which the bounds say nothing
};

}  // namespace field_detail

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
  /// The same from bounds that a survey found: most coefficients need not be looked at again.
  /// @param place  number of the component among those of the bounds
  bernstein::Range operator()(const Field& field, int component,
                              const field_detail::BlockBounds& bounds, std::size_t place,
                              double rel_tol = 1e-3) const;

  /// By which share of their width the coefficients' range must be widened to hold the values on
  /// each element; negative where the element lies too far outside its frame. Empty: by nothing.
  std::span<const double> widenings() const { return widening_; }

 private:
  struct Candidate {
    std::size_t element;
    double bound;
  };
  /// Of one component: upper bounds of sign f by block.
  struct Search {
    const Field& field;
    int component;
    double sign;                // 1: the largest value, -1: minus the smallest
    double tol = 0.0;           // wanted
    double roundoff = 0.0;      // not worth looking for
    std::vector<double> bound;  // by block
  };
  double widening(std::size_t e) const { return widening_.empty() ? 0.0 : widening_[e]; }
  field_detail::Known bounds_on(const Field& field, int component, std::size_t e) const;
  /// An element whose bound is the largest.
  Candidate highest(const Search& search) const;
  double largest(const Search& search) const;
  /// The largest value at the corners of an element.
  double attained(const Search& search, std::size_t e) const;
  double sharp(const Search& search, const Candidate& candidate, double known) const;

  std::shared_ptr<const Space> space_;
  std::vector<double> widening_;     // empty in the reference basis: all are 0
  std::vector<std::uint8_t> exact_;  // the element is its frame's triangle, up to rounding
};

}  // namespace bezel
