#include "bezel/mesh/edge_table.hpp"

#include <cstdint>
#include <utility>

namespace bezel::mesh_detail {
namespace {

std::uint64_t mix(std::uint64_t x) {  // the finaliser of MurmurHash3
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33;
  x *= 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33);
}

/// Numbers the distinct node sequences of one length in order of first appearance (open
/// addressing).
class SequenceTable {
 public:
  SequenceTable(std::size_t length, std::size_t expected) : length_(length) {
    std::size_t capacity = 16;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.assign(capacity, -1);
    sequences_.reserve(expected * length);
  }

  std::int32_t number(const NodeId* sequence) {
    // The ends and one inner node tell nearly all edges apart; equality is decided on all nodes.
    std::uint64_t h = mix(pair(sequence[0], sequence[length_ - 1]));
    if (length_ > 2) h = mix(h ^ static_cast<std::uint32_t>(sequence[1].value));
    for (std::size_t slot = h & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
      std::int32_t& found = slots_[slot];
      if (found < 0) {
        found = count_++;
        sequences_.insert(sequences_.end(), sequence, sequence + length_);
        return found;
      }
      const NodeId* old = sequences_.data() + static_cast<std::size_t>(found) * length_;
      bool same = true;
      for (std::size_t i = 0; i < length_ && same; ++i) same = old[i] == sequence[i];
      if (same) return found;
    }
  }

  std::vector<NodeId> take() {
    sequences_.shrink_to_fit();
    return std::move(sequences_);
  }

 private:
  static std::uint64_t pair(NodeId a, NodeId b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a.value)) << 32 |
           static_cast<std::uint32_t>(b.value);
  }

  std::size_t length_;
  std::int32_t count_ = 0;
  std::vector<std::int32_t> slots_;
  std::vector<NodeId> sequences_;
};

}  // namespace

EdgeTable build_edge_table(std::span<const NodeId> elements, std::size_t element_size,
                           std::span<const std::size_t> positions, std::size_t length) {
  const std::size_t per_element = positions.size() / length;
  const std::size_t element_count = elements.size() / element_size;
  SequenceTable table(length, element_count * per_element);
  EdgeTable out;
  out.sides.resize(element_count * per_element);
  std::vector<NodeId> sequence(length);
  for (std::size_t e = 0; e < element_count; ++e) {
    const NodeId* nodes = elements.data() + e * element_size;
    for (std::size_t s = 0; s < per_element; ++s) {
      const std::size_t* position = positions.data() + s * length;
      const bool reversed = nodes[position[0]] > nodes[position[length - 1]];
      for (std::size_t m = 0; m < length; ++m)
        sequence[reversed ? length - 1 - m : m] = nodes[position[m]];
      out.sides[e * per_element + s] = {EdgeId(table.number(sequence.data())), reversed};
    }
  }
  out.nodes = table.take();

  // Adjacency by counting sort: elements along an edge come in ascending order.
  const std::size_t edges = out.nodes.size() / length;
  out.offset.assign(edges + 1, 0);
  for (const SideEdge& side : out.sides) ++out.offset[side.edge.index() + 1];
  for (std::size_t e = 0; e < edges; ++e) out.offset[e + 1] += out.offset[e];
  out.adjacent.resize(out.sides.size());
  std::vector<std::size_t> next(out.offset.begin(), out.offset.end() - 1);
  for (std::size_t i = 0; i < out.sides.size(); ++i) {
    const SideEdge& side = out.sides[i];
    out.adjacent[next[side.edge.index()]++] = {ElementId(i / per_element),
                                               static_cast<int>(i % per_element), side.reversed};
  }
  return out;
}

}  // namespace bezel::mesh_detail
