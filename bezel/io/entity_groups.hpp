#pragma once
// Internal to io: entities from elements that name an entity and physical groups each.

#include <vector>

#include "bezel/mesh/tags.hpp"

namespace bezel::files {

/// Appends the entities of one dimension to `out` and renumbers `entities` (0: none) so that all
/// elements of an entity are in the same groups.
/// @return whether an entity had to be split for that
bool entities_from_groups(int dim, std::vector<int>& entities,
                          const std::vector<std::vector<int>>& groups, std::vector<Entity>& out);

}  // namespace bezel::files
