#include "bezel/mesh/edge_finder.hpp"

#include <algorithm>

namespace bezel {

EdgeFinder::EdgeFinder(const TriangleMesh& mesh)
    : mesh_(&mesh), offset_(mesh.node_count() + 1, 0), edge_(mesh.edge_count()) {
  for (std::size_t e = 0; e < edge_.size(); ++e)
    ++offset_[mesh.edge_nodes(EdgeId(e))[0].index() + 1];
  for (std::size_t n = 0; n < mesh.node_count(); ++n) offset_[n + 1] += offset_[n];
  std::vector<std::int32_t> next(offset_.begin(), offset_.end() - 1);
  for (std::size_t e = 0; e < edge_.size(); ++e)
    edge_[static_cast<std::size_t>(next[mesh.edge_nodes(EdgeId(e))[0].index()]++)] = EdgeId(e);
}

SideEdge EdgeFinder::find(std::span<const NodeId> nodes) const {
  if (nodes.size() != static_cast<std::size_t>(mesh_->degree()) + 1) return {};
  const bool reversed = nodes.front() > nodes.back();
  const NodeId start = reversed ? nodes.back() : nodes.front();
  if (!start.valid() || start.index() >= mesh_->node_count()) return {};
  const auto last = static_cast<std::size_t>(offset_[start.index() + 1]);
  for (auto k = static_cast<std::size_t>(offset_[start.index()]); k < last; ++k) {
    const auto found = mesh_->edge_nodes(edge_[k]);
    if (reversed ? std::equal(nodes.rbegin(), nodes.rend(), found.begin())
                 : std::equal(nodes.begin(), nodes.end(), found.begin()))
      return {edge_[k], reversed};
  }
  return {};
}

}  // namespace bezel
