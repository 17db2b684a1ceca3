// Which target elements each process works on, and which donor elements they may need.

#include <algorithm>

#include "bezel/base/parallel.hpp"
#include "bezel/transfer/extension.hpp"
#include "bezel/transfer/share.hpp"

namespace bezel::detail {
namespace {

/// Work of a target element besides its pairs, in candidates for pairs.
constexpr double work_of_target = 1.0;

void make_unique(std::vector<std::int32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// The elements and those beyond their edges, ascending.
std::vector<std::int32_t> with_neighbours(const OverlayMesh& mesh,
                                          std::vector<std::int32_t> elements) {
  const std::size_t own = elements.size();
  for (std::size_t i = 0; i < own; ++i) {
    for (const SideEdge& side : mesh.element_edges[static_cast<std::size_t>(elements[i])]) {
      const std::int32_t other = mesh.across(elements[i], side.edge.value);
      if (other != exterior) elements.push_back(other);
    }
  }
  make_unique(elements);
  return elements;
}

}  // namespace

std::vector<Share> split_work(const OverlayMesh& donor, const OverlayMesh& target,
                              const FrontSearch& search, std::size_t count, int threads) {
  const std::vector<std::int32_t> order = target.spatial_order();
  const std::size_t chunks = (order.size() + chunk_size - 1) / chunk_size;
  std::vector<std::vector<std::int32_t>> met(chunks);
  std::vector<double> work(chunks, 0.0);
  parallel_for(
      chunks,
      [&](std::size_t chunk) {
        std::vector<std::int32_t> found;
        std::vector<std::int32_t>& all = met[chunk];
        const std::size_t end = std::min(order.size(), (chunk + 1) * chunk_size);
        for (std::size_t i = chunk * chunk_size; i < end; ++i) {
          const Box2& box = target.element_box[static_cast<std::size_t>(order[i])];
          const std::size_t met_here = donors_in_reach(donor, search, box, found);
          work[chunk] += work_of_target + static_cast<double>(met_here);
          all.insert(all.end(), found.begin(), found.end());
        }
        make_unique(all);
      },
      threads);

  double total = 0.0;
  for (const double w : work) total += w;
  std::vector<Share> shares(count);
  double done = 0.0;
  std::size_t next = 0;
  for (std::size_t s = 0; s < count; ++s) {
    Share& share = shares[s];
    share.first_chunk = next;
    const double until = total * static_cast<double>(s + 1) / static_cast<double>(count);
    // A chunk belongs to the share in which its middle lies.
    while (next < chunks && (s + 1 == count || done + 0.5 * work[next] <= until))
      done += work[next++];
    share.chunk_count = next - share.first_chunk;
    const auto at = [&](std::size_t chunk) {
      return order.begin() +
             static_cast<std::ptrdiff_t>(std::min(order.size(), chunk * chunk_size));
    };
    share.own.assign(at(share.first_chunk), at(next));
    share.targets = with_neighbours(target, share.own);
    for (std::size_t c = share.first_chunk; c < next; ++c)
      share.donors.insert(share.donors.end(), met[c].begin(), met[c].end());
    make_unique(share.donors);
  }
  return shares;
}

}  // namespace bezel::detail
