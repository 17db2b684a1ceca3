#include "bezel/io/entity_groups.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "bezel/base/error.hpp"

namespace bezel::files {

bool entities_from_groups(int dim, std::vector<int>& entities,
                          const std::vector<std::vector<int>>& groups, std::vector<Entity>& out) {
  std::map<std::pair<int, std::vector<int>>, int> tag_of;
  std::set<int> named;
  int next = 0;
  for (const int entity : entities) next = std::max(next, entity);
  bool split = false;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const int entity = entities[i];
    if (entity == 0 && groups[i].empty()) continue;
    const auto [found, added] = tag_of.try_emplace({entity, groups[i]}, entity);
    if (added) {
      if (entity == 0 || !named.insert(entity).second) {
        if (next == std::numeric_limits<int>::max())
          throw InputError("an entity number is too large to number the parts of entities");
        split = split || entity != 0;
        found->second = ++next;
      }
      out.push_back({dim, found->second, groups[i]});
    }
    entities[i] = found->second;
  }
  return split;
}

}  // namespace bezel::files
