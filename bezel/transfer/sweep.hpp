#pragma once
// Internal: one pass over all target elements, and the balance of what it moved.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bezel/base/progress.hpp"
#include "bezel/transfer/element_transfer.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// What a pass found.
struct Swept {
  TransferReport report;                       ///< all but the fields and the total time
  std::vector<double> given_area, given_mass;  ///< per donor element (and component): in pairs
  std::vector<double> made;                    ///< per component
  std::vector<std::int32_t> outside;  ///< donor elements that lie partly outside the target
  double max_mass_defect = 0;
};

/// Receives the blocks of target element t, the index-th one worked on: ascending indices within a
/// task, several tasks at once.
using VisitBlocks =
    std::function<void(std::size_t index, std::int32_t t, const ElementBlocks& blocks)>;

/// Integrates and solves on every target element; the result is in the groups, or (with `visit`,
/// which takes one group of basis functions) goes to `visit`.
/// @throws UncoveredError, NumericsError as transfer()
Swept sweep(const OverlayMesh& donor, const OverlayMesh& target, std::span<Group> groups,
            const TransferOptions& options, const Progress& progress,
            const VisitBlocks& visit = {});

/// One line per component of a field that was moved.
/// @param spread          mass added besides, or empty
/// @param element_defect  largest |element mass - mass received|, per component
void append_reports(const Field& donor, const Field& moved, std::span<const double> outside,
                    std::span<const double> made, std::span<const double> spread,
                    std::span<const double> element_defect, int threads,
                    std::vector<FieldReport>& out);

/// Target elements worked on together: edges inside a chunk are intersected once, edges between two
/// chunks twice (with the same result), and nothing else is remembered.
inline constexpr std::size_t chunk_size = 256;

}  // namespace bezel::detail
