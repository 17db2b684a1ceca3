#pragma once
// Fills a curved polygon in place, storage reused. Internal.

#include <cstddef>
#include <vector>

#include "bezel/geometry/curved_polygon.hpp"

namespace bezel {

/// Unchecked access to a polygon's arrays.
class CurvedPolygonBuilder {
 public:
  explicit CurvedPolygonBuilder(CurvedPolygon& polygon)
      : vertices(polygon.vertices_),
        edges(polygon.edges_),
        control(polygon.control_),
        first(polygon.first_) {}
  std::vector<CurvedVertex>& vertices;
  std::vector<CurvedEdge>& edges;
  std::vector<Vec2>& control;
  std::vector<std::size_t>& first;
};

}  // namespace bezel
