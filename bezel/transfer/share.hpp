#pragma once
// Internal: a transfer split among processes: which elements each works on, what it must know of
// the meshes and fields, and what it sends back.
//
// A share is a run of whole chunks of OverlayMesh::spatial_order(). Its parts of the two meshes
// number elements and nodes in the order of the whole meshes, and hold both elements of every edge
// that matters: of the target the edges of own elements, of the donor those that meet one. So these
// edges have the order, the directions and the sides that they have in the whole, and all sums run
// in the same order, to the same bits.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/geometry/area_map.hpp"
#include "bezel/transfer/distributed.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/message.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/sweep.hpp"

namespace bezel::detail {

/// What one process works on; numbers are those of the whole meshes.
struct Share {
  std::size_t first_chunk = 0, chunk_count = 0;
  std::vector<std::int32_t> own;      ///< target elements, in the order of the chunks
  std::vector<std::int32_t> targets;  ///< ascending: own and their neighbours
  std::vector<std::int32_t> donors;   ///< ascending: all that may meet, or continue a field to, own
                                      ///< elements
};

/// Runs of chunks with about the same work: as many candidates for pairs, by their boxes. Some are
/// empty when there are more shares than chunks.
///
/// A donor element may matter to a target element when it is in reach (donors_in_reach): when their
/// boxes meet, or when it can be the nearest one to a point of the target element's box.
/// @param count  at least 1; of the shares
/// @cost   one query of the donor's tree per 32 target elements, where donors are not much larger
///         (else per 8 another one), and some 50 comparisons of boxes per element
std::vector<Share> split_work(const OverlayMesh& donor, const OverlayMesh& target,
                              const FrontSearch& search, std::size_t count, int threads);

/// Writes all that a process needs to work on a share, for one share after the other.
class ShareWriter {
 public:
  /// All must outlive the writer.
  /// @param blocks  whether the blocks of the elements are wanted
  /// @param rim     rim_donors() of the whole meshes; empty: found here
  ShareWriter(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
              std::span<const Group> groups, const TransferOptions& options, bool blocks,
              std::span<const std::uint8_t> rim = {});
  /// @param map  to the plane in which the work is done
  void write(const Share& share, MessageWriter& out, const AreaMap& map = {});

 private:
  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  std::span<const Group> groups_;
  const TransferOptions& options_;
  bool blocks_;
  std::vector<std::uint8_t> rim_;  // per donor element of the whole
  // Per node or element of the whole its place in the part; -1: not in it.
  std::vector<std::int32_t> donor_place_, target_place_, element_place_;
};

/// Wall and processor time (of all threads) since it was made.
class Stopwatch {
 public:
  Stopwatch();
  double seconds() const;
  double cpu_seconds() const;

 private:
  double wall_start_, cpu_start_;
};

/// Reads a share, works on it, and writes chunks and coefficients (or blocks) with the whole's
/// numbers.
/// @return all but the bytes
/// @throws as sweep_elements()
ShareReport work_on(MessageReader& in, int threads, MessageWriter& out);

/// Puts the chunks where they belong among all, and the coefficients into the groups or, with
/// `visit`, the blocks there.
void read_results(const Share& share, MessageReader& in, std::span<Group> groups,
                  std::span<ChunkResult> chunks, const VisitBlocks& visit = {});

}  // namespace bezel::detail
