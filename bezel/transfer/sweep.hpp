#pragma once
// Internal: a pass over target elements, and the balance of what it moved.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bezel/base/progress.hpp"
#include "bezel/transfer/conserve.hpp"
#include "bezel/transfer/element_transfer.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/mass_system.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Target elements worked on together: edges inside a chunk are intersected once, edges between two
/// chunks twice (with the same result), and nothing else is remembered.
inline constexpr std::size_t chunk_size = 256;

/// What a chunk of target elements leaves behind, in the order of the elements.
struct ChunkResult {
  GivenList given;
  OverlayCounts counts;
  std::vector<double> made;    ///< per component
  ElementMasses element_made;  ///< with Conserve::total
  std::vector<std::pair<ElementId, double>> uncovered;
  double uncovered_area = 0;
  double max_partition_residual = 0, max_joint_gap = 0, max_mass_defect = 0;
  ExtensionReport extension;
  double overlay = 0, integrate = 0, solve = 0;  ///< seconds
  std::int32_t inconsistent = -1;                ///< the first such element
  std::int64_t inconsistent_count = 0;
};

/// Receives the blocks of target element t, the index-th one worked on: ascending indices within a
/// task, several tasks at once.
using VisitBlocks =
    std::function<void(std::size_t index, std::int32_t t, const ElementBlocks& blocks)>;

/// Integrates and solves on some target elements, chunk after chunk of `elements`; the coefficients
/// are in the groups, or (with `visit`, which takes one group of basis functions) go to `visit`.
///
/// What a chunk leaves depends on its own elements and the donors near them only: a part of
/// OverlayMesh::spatial_order() that begins at a multiple of chunk_size gives the bits of the
/// whole.
/// @param part_rim  on parts of meshes: rim_donors() of the whole ones
/// @throws NumericsError where a mass matrix is singular
std::vector<ChunkResult> sweep_elements(const OverlayMesh& donor, const OverlayMesh& target,
                                        const FrontSearch& search, std::span<Group> groups,
                                        std::span<const std::int32_t> elements,
                                        const TransferOptions& options, const Progress& progress,
                                        const VisitBlocks& visit = {},
                                        std::span<const std::uint8_t> part_rim = {});

/// Per donor element, nonzero for those that may lie partly outside the target mesh: near its
/// boundary. Of whole meshes.
std::vector<std::uint8_t> rim_donors(const OverlayMesh& donor, const OverlayMesh& target,
                                     const FrontSearch& search);

/// What a pass found.
struct Swept {
  TransferReport report;               ///< all but the fields and the total time
  std::vector<double> given_area;      ///< per donor element
  std::vector<std::int32_t> mass_row;  ///< per donor element: of given_mass, or -1
  std::vector<double> given_mass;      ///< [row][component], of donors whose masses were kept
  /// What a donor that lies partly outside gave in pairs; components() numbers.
  std::span<const double> given_by(std::int32_t donor) const {
    const std::int32_t row = mass_row[static_cast<std::size_t>(donor)];
    return {given_mass.data() + static_cast<std::size_t>(row < 0 ? 0 : row) * made.size(),
            row < 0 ? 0 : made.size()};
  }
  std::vector<double> made;           ///< per component
  std::vector<std::int32_t> outside;  ///< donor elements that lie partly outside the target
  double max_mass_defect = 0;
};

/// Adds up what all chunks left, in their order.
/// @param donor_area  of the donor elements
/// @throws UncoveredError, NumericsError as transfer()
Swept balance(std::span<const ChunkResult> chunks, std::span<const double> donor_area,
              std::size_t components, Uncovered policy);

/// Works on all target elements: what sweep_elements() does with OverlayMesh::spatial_order(), here
/// or elsewhere.
using Sweeper = std::function<std::vector<ChunkResult>(
    const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
    std::span<Group> groups, const TransferOptions& options, const Progress& progress,
    const VisitBlocks& visit)>;

/// The Sweeper of this process.
std::vector<ChunkResult> sweep_here(const OverlayMesh& donor, const OverlayMesh& target,
                                    const FrontSearch& search, std::span<Group> groups,
                                    const TransferOptions& options, const Progress& progress,
                                    const VisitBlocks& visit = {});

/// Who does what can be left to others: this process alone, unless told otherwise.
struct Crew {
  Sweeper sweep = sweep_here;
  MassSystemMaker mass_system = {};  ///< of MassMethod::petsc; see ContinuousMass
};

/// transfer() by a crew.
TransferResult transfer_by(const Crew& crew, std::span<const Field> donors,
                           const std::shared_ptr<const TriangleMesh>& target,
                           const TransferOptions& options, const Progress& progress);

/// All groups' components.
std::size_t component_count(std::span<const Group> groups);

}  // namespace bezel::detail
