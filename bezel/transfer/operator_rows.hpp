#pragma once
// Internal: the blocks of a transfer operator in memory and in files.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/base/atomic_file.hpp"
#include "bezel/field/space.hpp"
#include "bezel/transfer/element_transfer.hpp"

namespace bezel::detail {

/// Dense blocks by target element, in the order in which a pass works on them.
class OperatorRows {
 public:
  struct Block {
    std::int32_t donor;
    std::span<const double> value;  ///< [target function][donor function]
    std::span<const double> mass;   ///< received, per donor function
  };
  struct Row {
    std::int32_t target;
    double area = 0;            ///< of all that it received
    std::vector<Block> blocks;  ///< by ascending donor
  };
  struct MadeMass {  ///< mass that a donor's extension makes, per donor function
    std::int32_t donor;
    std::vector<double> mass;
  };

  OperatorRows() = default;
  OperatorRows(const Space& donor, const Space& target);

  /// Keeps the blocks of the index-th element worked on; see VisitBlocks.
  void store(std::size_t index, std::int32_t t, const ElementBlocks& blocks);
  /// Call once after the last store().
  void index_donors();
  /// Hands over the masses of extensions, in the order of the elements worked on.
  std::vector<MadeMass> take_made();

  std::size_t chunk_count() const { return chunks_.size(); }
  std::size_t block_count() const { return column_.size(); }
  std::size_t bytes() const;

  /// Calls visit(row) for the rows of a chunk.
  template <class Visit>
  void for_rows(std::size_t chunk, const Visit& visit) const {
    Row row;
    for (std::size_t i = 0; i < chunks_[chunk].target.size(); ++i) {
      fill_row(chunk, i, row);
      visit(row);
    }
  }
  /// Calls visit(target, block) for the blocks of a donor element, always in the same order.
  template <class Visit>
  void for_column(std::int32_t d, const Visit& visit) const {
    for (std::size_t i = column_first_[static_cast<std::size_t>(d)];
         i < column_first_[static_cast<std::size_t>(d) + 1]; ++i) {
      const Entry& entry = column_[i];
      visit(entry.target, block(chunks_[entry.chunk], entry.pair));
    }
  }
  /// The row of a target element.
  void row(std::int32_t t, Row& out) const;

 private:
  struct Chunk {
    std::vector<std::int32_t> target;
    std::vector<double> area;             // per target
    std::vector<std::size_t> first_pair;  // per target and one more
    std::vector<std::int32_t> donor;      // per pair
    std::vector<std::size_t> offset;      // per pair and one more, into values
    std::vector<double> values;           // per pair the block, then the masses
    std::vector<MadeMass> made;
  };
  struct Entry {
    std::uint32_t chunk, pair;
    std::int32_t target;
  };
  std::size_t functions(std::int32_t d) const {
    return donor_size_.size() == 1 ? donor_size_[0] : donor_size_[static_cast<std::size_t>(d)];
  }
  Block block(const Chunk& chunk, std::size_t pair) const;
  void fill_row(std::size_t chunk, std::size_t i, Row& row) const;

  std::vector<std::uint32_t> donor_size_;  // functions per donor element, or one for all
  std::vector<Chunk> chunks_;
  std::vector<std::size_t> place_;         // per target element, its index in the pass
  std::vector<std::size_t> column_first_;  // per donor element and one more
  std::vector<Entry> column_;
};

/// See TransferOperator::write_matrix_market().
void write_matrix_market(AtomicFile& file, const OperatorRows& rows, const Space& donor,
                         const Space& target);

}  // namespace bezel::detail
