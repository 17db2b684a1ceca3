#pragma once
// Internal: the rows of a mass matrix split among processes.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/transfer/petsc_system.hpp"

namespace bezel::detail {

/// Splits the dofs of a continuous space among processes.
struct DofSplit {
  /// @param count  at least 1; of the processes
  DofSplit(const Space& space, std::size_t count);
  int owner(std::int32_t row) const;

  std::vector<std::int32_t> row;  ///< per dof: rows are numbered along the elements' spatial order
  std::vector<RowRange> ranges;   ///< about as many rows for each process
};

}  // namespace bezel::detail
