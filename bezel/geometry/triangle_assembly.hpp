#pragma once
// Joins the parts of an arrangement to closed loops. Internal.

#include <array>
#include <cstdint>
#include <vector>

#include "bezel/geometry/curved_polygon.hpp"
#include "bezel/geometry/triangle_arrangement.hpp"

namespace bezel::geometry_kernel {

enum class Operation : std::uint8_t {
  intersection,  ///< of both
  difference     ///< the first without the second
};

class Assembly {
 public:
  /// False when the parts do not close, which contradicts their classes. Polygons in `spare` are
  /// used up first, for their storage.
  bool run(const Arrangement& arrangement, Operation operation, bool cut_where_touching,
           std::vector<CurvedPolygon>& spare, std::vector<CurvedPolygon>& out);
  /// The whole boundary of triangle k; `backwards` as a loop around a hole.
  void whole(const TriangleSides& sides, int k, bool backwards, std::vector<CurvedPolygon>& spare,
             std::vector<CurvedPolygon>& out);

 private:
  /// A selected part on its way to a loop.
  struct Piece {
    int triangle;
    std::int32_t from, to;  ///< joints in the direction of the loop
    bool backwards;         ///< against its triangle's direction
    bool common;            ///< runs along the other triangle's boundary
    bool used;
  };
  /// A piece of one side. `start`: joint, or ~corner (of its triangle).
  struct Segment {
    int triangle, edge;
    double s0, s1;
    std::int32_t start;
    bool common;
    std::int32_t end;  ///< as `start`
  };

  bool select(Operation operation);
  void add_piece(const Piece& piece);
  bool trace(std::int32_t first);
  void add_segments(const Piece& piece);
  void unify_common();
  void merge();
  void emit(std::vector<CurvedPolygon>& spare, std::vector<CurvedPolygon>& out) const;
  bool on_other(Segment& segment) const;

  const Arrangement* arrangement_ = nullptr;
  std::array<const TriangleSides*, 2> sides_{};
  bool cut_ = false;
  std::vector<Piece> pieces_;
  std::vector<std::array<std::int32_t, 2>> leaving_;  ///< per joint: piece of each triangle, or -1
  std::vector<int> balance_;  ///< per joint: pieces that leave minus pieces that arrive
  std::vector<Segment> segments_;
};

}  // namespace bezel::geometry_kernel
