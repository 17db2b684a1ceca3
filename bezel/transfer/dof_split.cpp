#include "bezel/transfer/dof_split.hpp"

#include <algorithm>

#include "bezel/mesh/morton.hpp"

namespace bezel::detail {

DofSplit::DofSplit(const Space& space, std::size_t count)
    : row(space.dof_count(), -1), ranges(count) {
  const TriangleMesh& mesh = *space.mesh();
  std::vector<Vec2> centres;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    centres.push_back(mesh.box(ElementId(e)).centre());
  std::int32_t next = 0;
  for (const std::int32_t e : morton_order(centres)) {
    for (const std::int32_t d : space.dofs(ElementId(e))) {
      std::int32_t& of_dof = row[static_cast<std::size_t>(d)];
      if (of_dof < 0) of_dof = next++;
    }
  }
  const auto all = static_cast<std::int64_t>(row.size());
  const auto begin_of = [&](std::size_t process) {
    return static_cast<std::int32_t>(all * static_cast<std::int64_t>(process) /
                                     static_cast<std::int64_t>(count));
  };
  for (std::size_t p = 0; p < count; ++p) {
    ranges[p].first = begin_of(p);
    ranges[p].all = static_cast<std::int32_t>(all);
    const auto size = static_cast<std::size_t>(begin_of(p + 1) - begin_of(p));
    ranges[p].inside.resize(size);
    ranges[p].outside.resize(size);
  }
  std::vector<int> owners;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto dofs = space.dofs(ElementId(e));
    owners.clear();
    for (const std::int32_t d : dofs) owners.push_back(owner(row[static_cast<std::size_t>(d)]));
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      RowRange& range = ranges[static_cast<std::size_t>(owners[i])];
      const auto at =
          static_cast<std::size_t>(row[static_cast<std::size_t>(dofs[i])] - range.first);
      const auto inside = static_cast<std::int32_t>(std::ranges::count(owners, owners[i]));
      range.inside[at] += inside;
      range.outside[at] += static_cast<std::int32_t>(dofs.size()) - inside;
    }
  }
}

int DofSplit::owner(std::int32_t of_row) const {
  const auto after = std::ranges::upper_bound(ranges, of_row, {}, &RowRange::first);
  return static_cast<int>(after - ranges.begin()) - 1;
}

}  // namespace bezel::detail
