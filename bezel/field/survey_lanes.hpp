#pragma once
// Internal: what surveys do with eight components side by side.

#include <array>
#include <cstddef>
#include <vector>

#include "bezel/numeric/lanes.hpp"

namespace bezel::field_detail {

/// Of eight components on some elements.
struct LaneSurvey {
  // Shape (elements, lanes).
  std::vector<double> integral;     ///< where basis integrals are given
  std::vector<double> least, most;  ///< coefficients
  // Over all elements: of least and most, widened, and by how much at most.
  std::array<double, lanes> low, high, slack;
};

/// Looks at elements first .. first + elements of `size` coefficients each. Each component has the
/// bits that it has alone, on every machine.
/// @param c      shape (elements, size, lanes)
/// @param basis  integrals of the basis functions, or null
/// @param share  by which share of their width the coefficients' ranges are widened, or null
/// @param found  with room for all elements; low, high and slack are brought up to date
void look_at_lanes(std::size_t first, std::size_t elements, std::size_t size, const double* c,
                   const double* basis, const double* share, LaneSurvey& found);

}  // namespace bezel::field_detail
