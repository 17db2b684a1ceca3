#pragma once
// Physical groups and geometric entities: what a mesh generator said about the parts of a mesh.

#include <string>
#include <vector>

#include "bezel/mesh/ids.hpp"

namespace bezel {

/// A named (or only numbered) physical group, as in Gmsh.
struct PhysicalGroup {
  int dim = 0;
  int tag = 0;
  std::string name;  ///< may be empty
  friend bool operator==(const PhysicalGroup&, const PhysicalGroup&) = default;
};

/// A geometric entity (point, curve, surface) and the physical groups it belongs to, primary first.
struct Entity {
  int dim = 0;
  int tag = 0;
  std::vector<int> physical;
  friend bool operator==(const Entity&, const Entity&) = default;
};

/// A lower-dimensional element kept for its tag: a boundary (or interior) edge of the mesh.
struct TaggedEdge {
  std::vector<NodeId> nodes;  ///< g+1 control points along the edge, Bernstein order
  int entity = 0;             ///< tag of a 1D Entity
  friend bool operator==(const TaggedEdge&, const TaggedEdge&) = default;
};
struct TaggedPoint {
  NodeId node;
  int entity = 0;  ///< tag of a 0D Entity
  friend bool operator==(const TaggedPoint&, const TaggedPoint&) = default;
};

/// All tags of a mesh. Empty everywhere when the source said nothing.
struct Tags {
  std::vector<PhysicalGroup> groups;
  std::vector<Entity> entities;
  std::vector<int>
      element_entity;  ///< per element, tag of a 2D Entity; empty when there are no tags
  std::vector<TaggedEdge> edges;
  std::vector<TaggedPoint> points;
  friend bool operator==(const Tags&, const Tags&) = default;
};

}  // namespace bezel
