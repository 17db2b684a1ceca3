#pragma once
// Internal: the values that target elements may take.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/transfer/redistribute.hpp"
#include "bezel/transfer/sweep.hpp"

namespace bezel::detail {

/// @throws InputError for global bounds that are not two ascending numbers
void check_bounds(const Bounds& bounds);

/// Bounds of each target element's values, for one component of a field after the other.
///
/// Local ones are the range of the donor over the donor elements that overlap the target element;
/// elements without any have the range of the whole donor. Where the field counts as 0 in part, 0
/// is in the range.
/// @accuracy ranges are certified and exceed the true ones by 1e-10 of the coefficients' largest
/// value (constants: by nothing; in a physical basis on curved elements by the rounding of the
/// composition, 1e-13)
class ElementBounds {
 public:
  struct Overlapping {
    std::int32_t target, donor;
  };
  /// @param donor_area, target_area  of the elements
  /// @param report                   of the sweep that left `chunks`
  /// @throws InputError for global bounds that leave out 0 where the field counts as 0
  ElementBounds(std::span<const double> donor_area, std::span<const double> target_area,
                std::span<const ChunkResult> chunks, const TransferReport& report,
                const TransferOptions& options);
  /// @param pairs  those that overlaps() says (local bounds)
  /// @param zero   target elements where the field counts as 0 in part
  /// @throws InputError as above
  ElementBounds(const Bounds& bounds, std::vector<Overlapping> pairs,
                std::vector<std::int32_t> zero, std::size_t targets, int threads);

  /// Whether two elements share more than rounding, or only touch.
  static bool overlaps(double shared_area, double donor_area, double target_area);

  ValueBounds operator()(const Field& donor, int component) const;

 private:
  ValueBounds local(const Field& donor, int component) const;

  Bounds bounds_;
  std::size_t targets_;
  int threads_;
  std::vector<std::int32_t> zero_;  // target elements where the field counts as 0 in part
  std::vector<Overlapping> pairs_;
};

}  // namespace bezel::detail
