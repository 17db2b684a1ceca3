#pragma once
// Internal: thin target elements, worked on where they are round.
//
// In the plane of the files a point beside a thin turned element is rounded by a large part of the
// element's width, and so is all that is computed from points: areas of pieces, and places in the
// element. An AreaMap takes the element and what is near to a plane where it is round, with one
// rounding of each control point there; areas, masses and coefficients are the same in both planes.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/geometry/area_map.hpp"
#include "bezel/transfer/share.hpp"

namespace bezel::detail {

/// Of the elements of one chunk. One object per thread.
class FlatSweep {
 public:
  /// All must outlive this.
  /// @param rim  rim_donors() of the whole meshes
  FlatSweep(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
            std::span<Group> groups, const TransferOptions& options,
            std::span<const std::uint8_t> rim, bool with_blocks);

  /// Works on the thin elements among these; their coefficients go to the groups or their blocks to
  /// block_of().
  /// @param done    out: by place in the list, nonzero for those worked on; the others are left
  /// @param result  what they leave is added
  void work_on(std::span<const std::int32_t> elements, std::vector<std::uint8_t>& done,
               ChunkResult& result);
  /// What the element at a place of the list gave, with blocks.
  const ElementBlocks& block_of(std::size_t place) const { return blocks_[place]; }

 private:
  /// Elements that are round in one plane, as a share of the work.
  struct Cluster {
    AreaMap map;
    Share share;
    std::vector<std::size_t> place;
  };
  std::vector<Cluster> clusters(std::span<const std::int32_t> elements) const;
  /// Finds what the elements need besides; those that may have a gap are taken out.
  /// @return  their places; of an element that is alone none
  std::vector<std::size_t> add_neighbourhood(Cluster& cluster);
  /// False, and nothing is added, where regions do not close.
  bool work_on(const Cluster& cluster, ChunkResult& result);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  std::span<Group> groups_;
  const TransferOptions& options_;
  std::span<const std::uint8_t> rim_;
  bool with_blocks_;
  std::unique_ptr<ShareWriter> writer_;  // once there is a thin element
  std::vector<ElementBlocks> blocks_;
  FrontSearch::Memory memory_;
  std::vector<std::int32_t> found_;
};

}  // namespace bezel::detail
