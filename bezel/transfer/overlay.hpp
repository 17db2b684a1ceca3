#pragma once
// Internal: the common refinement of two meshes, one target element at a time.
//
// Each target edge is intersected once with each donor edge near it and cut into pieces at the
// contacts; a piece lies in one donor element, outside the donor mesh, or on a donor edge. The same
// contacts cut the donor edges, so the pieces that bound T and D fit together: the boundary of T n
// D is the pieces of T's edges inside D, the pieces of D's edges inside T, and the pieces on both
// (counted once).

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/transfer/numbering.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/pile.hpp"
#include "bezel/transfer/straight_walk.hpp"

namespace bezel::detail {

/// Curves nearer to each other than this fraction of the thinnest element beside them count as
/// coincident. Pieces merged so leave joints open by at most that much; the sums over a whole
/// element close exactly all the same.
inline constexpr double coincidence_fraction = 1e-13;
/// ... and never less than the rounding of the coordinates themselves.
inline constexpr double coordinate_rounding = 32.0 * 0x1p-53;
inline constexpr double point_rounding = 4.0 * 0x1p-53;
inline double coincidence_distance(double smallest_width, double largest_coordinate) {
  return std::max(coincidence_fraction * smallest_width, coordinate_rounding * largest_coordinate);
}
/// Of two edges when their elements' widths are not looked at: never less than with them.
inline double coincidence_distance(const CurveCache& a, const CurveCache& b) {
  return coincidence_distance(std::min(a.diameter, b.diameter), std::max(a.magnitude, b.magnitude));
}
inline bool is_inner(double r) {
  return r > contact_isolation && r < 1.0 - contact_isolation;
}

/// Part of an edge curve, run from parameter `from` to `to` (canonical direction of the edge; from
/// > to reverses).
struct Part {
  std::int32_t edge = -1;
  double from = 0, to = 0;
};

/// Instead of an element: both parts of a segment are one curve.
inline constexpr std::int32_t one_curve = -2;

/// One piece of the boundary of (T n donor), run counter-clockwise. A piece on both meshes' edges
/// has both parts.
struct Segment {
  std::int32_t donor =
      exterior;  ///< donor element, or exterior: the part of T that no donor covers
  std::int32_t across = one_curve;  ///< of parts that are apart by more than the rounding of
                                    ///< points: the donor element beyond, or exterior
  Part target;                      ///< edge -1 when the piece is no part of T's boundary
  Part source;                      ///< the same for the donor's boundary
};

/// One piece of the boundaries inside or around a target element T, with the regions T n D on its
/// two sides: every piece of a donor edge inside T bounds two of them.
struct BoundaryPiece {
  Part part;  ///< of an edge of the donor mesh when `source`, else of T's boundary
  bool source;
  std::int32_t left;   ///< number of the region on its left
  std::int32_t right;  ///< number of the region on its right, or -1
};

/// The overlay of one target element.
struct ElementPieces {
  std::span<const std::int32_t> donors;  ///< donor element of each region, or exterior
  std::span<const BoundaryPiece> pieces;
  /// Pieces by region, for each donor those that bound its region counter-clockwise: only where
  /// edges of both meshes coincide, touch or nearly so; else empty, and the pieces tell all.
  std::span<const Segment> segments;
  bool loose() const { return !segments.empty(); }  ///< joints may be open a little
};

/// The overlays of several target elements.
class OverlayList {
 public:
  void clear() {
    donors.clear();
    pieces.clear();
    segments.clear();
    ends_.clear();
  }
  /// What was added since the last call is one element's.
  void close() { ends_.push_back({donors.size(), pieces.size(), segments.size()}); }
  ElementPieces operator[](std::size_t i) const {
    const End begin = i == 0 ? End{} : ends_[i - 1];
    const End& end = ends_[i];
    return {{donors.data() + begin.donor, end.donor - begin.donor},
            {pieces.data() + begin.piece, end.piece - begin.piece},
            {segments.data() + begin.segment, end.segment - begin.segment}};
  }

  Pile<std::int32_t> donors;
  Pile<BoundaryPiece> pieces;
  Pile<Segment> segments;

 private:
  struct End {
    std::size_t donor = 0, piece = 0, segment = 0;
  };
  std::vector<End> ends_;
};

/// The segments of an element from its pieces alone: those of each region together, in order.
void collect_segments(const ElementPieces& own, std::vector<Segment>& out);

struct OverlayCounts {
  std::int64_t pairs = 0, crossings = 0, tangencies = 0, overlaps = 0, unresolved = 0;
  double max_joint_gap = 0;
};

/// Computes segments of target elements. One object per thread; `begin_chunk` forgets everything.
class ElementOverlay {
 public:
  ElementOverlay(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search);

  /// Forgets the edges computed so far (memory stays bounded by a chunk of elements).
  /// @param elements  that will be added: where both meshes are straight their edges are found
  ///                  together. Nothing but time depends on them.
  void begin_chunk(std::span<const std::int32_t> elements = {});
  /// Adds the overlay of target element t to the list.
  /// counts: contacts are counted when first computed in a chunk by their owner (the edge's left or
  /// only element).
  void add(std::int32_t t, OverlayList& list, OverlayCounts& counts);

 private:
  struct Contact {
    double r, s;
    std::int32_t donor_edge;
    std::int8_t sign;  // +1: the donor edge passes from right to left of the target edge; 0: not to
                       // be relied on
  };
  struct Coincidence {
    double r0, r1, s0, s1;
    std::int32_t donor_edge;
    bool apart;  // by more than the rounding of points
  };
  struct Piece {
    double r0, r1;
    std::int32_t donor;        // donor element or exterior
    std::int32_t coincidence;  // index into coincidences_, -1 when the piece is not on a donor edge
  };
  struct Record {
    std::int32_t edge = -1;
    std::int32_t first_step = -1;  // of a walk: all contacts are plain crossings
    std::int32_t stride = 1;       // of its steps
    std::int32_t details = -1;     // of an edge that was not walked, or unfolded
    std::int32_t crossings = 0;
    double gap = 0;  // largest between points of the two meshes, of the edge's diameter
    bool walked() const { return first_step >= 0; }
  };
  struct ElementRecords {
    std::int32_t element;
    std::array<std::uint32_t, 3> record;
  };
  struct Details {
    std::uint32_t contact_begin = 0, contact_end = 0;
    std::uint32_t coincidence_begin = 0, coincidence_end = 0;
    std::uint32_t piece_begin = 0, piece_end = 0;
    std::int32_t tangencies = 0, overlaps = 0, unresolved = 0;
  };
  struct Mark {
    std::int32_t edge;
    double s;
    std::int8_t direction;                    // +1 enters T as s increases, -1 leaves, 0 unknown
    std::array<std::int32_t, 2> region = {};  // beside the edge; where edges were walked only
  };
  /// A part of a donor edge inside T: numbers that are written apart stay apart, else they would be
  /// read together before they are there.
  struct InnerPart {
    struct End {
      double s;             // inside the edge where T's boundary cuts it, else 0 or 1
      std::int32_t region;  // left of the edge at the first end, right of it at the second
      std::int32_t edge;
    };
    std::array<End, 2> end;
  };
  /// A step around an element.
  struct BoundaryStep {
    std::int32_t step, side;
  };

  static constexpr std::int32_t unlocated = -2, sought = -3;
  /// In place of a vertex's donor element where it is a vertex of the donor mesh: minus the node.
  static constexpr std::int32_t first_node = -4;
  /// ... where it lies on a donor edge: minus the number in on_edges_.
  static constexpr std::int32_t first_on_edge = -(1 << 30);
  /// On a donor edge, far from its ends.
  struct EdgePoint {
    std::int32_t edge = -1;
    double s = 0, gap = 0;
  };
  /// Where a target edge ends: in an element, on a donor edge or in a donor vertex.
  struct EdgeEnd {
    std::int32_t edge = -1, node = -1;
    double s = 0, gap = 0;
    std::span<const std::int32_t> edges;  // that hold it
    std::vector<std::int32_t> elements;   // around it
  };

  /// The numbers of the records of an element's edges in this chunk; new ones are empty.
  void find_records_of(std::int32_t t, std::array<std::uint32_t, 3>& found);
  void find_records(std::int32_t t);
  const WalkStep* first_step(const Record& record) const {
    return steps_.data() + record.first_step;
  }
  Details& details_of(const Record& record) {
    return details_[static_cast<std::size_t>(record.details)];
  }
  void find_candidates(std::int32_t t);
  void overlay_edge(Record& record);
  /// Whether what lies between coincident edges counts: more than the rounding of points does, and
  /// beside thin donors all.
  bool are_apart(std::int32_t donor_edge, double gap, double magnitude) const;
  /// Puts what two edges have in common on the lists, when that is quickly seen.
  bool meet_ordinarily(const CurveCache& curve, const CurveCache& other, double distance,
                       std::int32_t donor_edge, Record& record);
  // Ordinary edges and elements (overlay_walk.cpp).
  /// `near`: a vertex that may be near.
  std::int32_t donor_at_vertex(std::int32_t vertex, std::int32_t near);
  bool walk_edge(Record& record);
  bool share_edge(Record& record);
  /// The place of a point that is a donor vertex or lies on a donor edge; exterior when it is and
  /// does neither.
  std::int32_t place_on_edges(const Vec2& p);
  std::int32_t donor_node(const Vec2& p);
  /// The donor vertex that a located vertex is; -1: none.
  std::int32_t donor_node_at(std::int32_t vertex) const {
    const std::int32_t place = vertex_place_[static_cast<std::size_t>(vertex)];
    return place <= first_node && place > first_on_edge ? first_node - place : -1;
  }
  /// Adds all that the curve crosses from the elements in walk_ on to the contacts.
  bool cross_on_the_way(const CurveCache& curve, double& gap);
  // Edges that end on edges (overlay_join.cpp).
  std::int32_t place_on_edge(const Vec2& p);
  bool find_end(std::int32_t vertex, EdgeEnd& end) const;
  void begin_details(Record& record);
  void end_details(const Record& record);
  bool follow_edges(Record& record);
  bool reach_across(Record& record);
  bool join_edge(Record& record);
  /// The record's contacts and pieces, from the steps of a walk if need be.
  const Details& unfold(Record& record);
  bool walk_inside(std::int32_t t, OverlayList& list);
  void cross_boundary(std::int32_t t, OverlayList& list);
  bool order_crossings(std::int32_t t);
  bool add_inner_parts(OverlayList& list);
  void add_inner_edges(OverlayList& list);
  // Straight edges (straight_walk.cpp).
  bool is_straight() const { return !search_.straight().empty() && target_.degree == 1; }
  void locate_vertices(std::size_t first_record);
  void walk_straight_edges(std::size_t first_record);
  bool start_walk(std::size_t record, StraightWalk& walk);
  void finish_walk(const StraightWalk& walk);
  /// The number of a donor's region.
  std::int32_t region_of(std::int32_t donor, OverlayList& list) {
    if (!regions_.knows(donor)) list.donors.push_back(donor);
    return static_cast<std::int32_t>(regions_.take(donor));
  }
  /// Puts all common points of two edges on the list of contacts, when all are plain crossings.
  bool plain_crossings(const CurveCache& curve, const CurveCache& other, double distance,
                       std::int32_t donor_edge, double& gap);
  /// Forgets what is remembered of edges, nodes and regions for one element.
  void next_stamp();
  void find_boundary_segments(std::int32_t t);
  bool is_one_donor() const;
  void group_segments(OverlayList& list);
  /// The coincidence of a piece whose donor edge has an element on the target element's side, and
  /// that element.
  std::pair<std::size_t, std::int32_t> facing_coincidence(const Details& record, const Piece& piece,
                                                          bool reversed) const;
  std::int32_t locate_piece(std::span<const Vec2> curve, double r0, double r1) const;
  std::int32_t best_donor(const Vec2& p, double& margin) const;
  bool inside_target(std::int32_t t, std::span<const Vec2> curve, double s0, double s1) const;
  void add_donor_part(std::int32_t edge, double s0, double s1);
  void donor_edges_inside(std::int32_t t);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  FrontSearch::Memory search_memory_;
  Pile<Record> records_;  // of the chunk's edges
  std::vector<Details> details_;
  Numbering record_numbers_;                // by target edge
  Pile<ElementRecords> chunk_;              // its elements
  std::size_t next_element_ = 0;            // of them
  std::array<std::uint32_t, 3> own_{};      // the records of the element's edges
  std::vector<std::int32_t> vertex_place_;  // by target node: the donor element around it
  std::int32_t last_donor_ = 0;             // of the vertices looked at
  Pile<WalkStep> steps_;
  Pile<StraightWalk> walks_;
  Pile<SoughtPoint> sought_;
  Pile<BoundaryStep> boundary_steps_;
  Numbering parts_;               // by donor edge: its part
  std::vector<InnerPart> inner_;  // room for more than inner_count_
  std::size_t inner_count_ = 0;
  std::size_t crossing_count_ = 0;           // of T's boundary
  std::uint32_t now_ = 0;                    // the stamp of vertices inside T
  std::vector<std::uint32_t> inside_stamp_;  // by donor node
  std::vector<std::int32_t> walk_;
  std::vector<EdgePoint> on_edges_;  // target vertices
  std::array<EdgeEnd, 2> ends_;
  CurveCache own_room_{};
  std::int32_t candidates_of_ = -1;  // the target element that candidates_ were found for
  std::vector<Contact> contacts_;
  std::vector<Coincidence> coincidences_;
  std::vector<Piece> pieces_;
  std::vector<std::int32_t> candidates_, near_, candidate_edges_;
  std::vector<std::uint32_t> edge_stamp_;
  std::uint32_t edge_now_ = 0;
  std::vector<Mark> marks_;
  std::vector<std::pair<std::int32_t, std::pair<double, double>>>
      covered_;  // donor edge, s interval on T's boundary
  std::vector<Segment> segments_;
  Numbering regions_;  // by donor element or exterior
  std::vector<std::uint32_t> slots_, group_end_;
  std::vector<double> breaks_;
  CurveIntersections found_;
};

/// Point of an edge and its derivative, unchecked.
inline geometry_kernel::CurvePoint edge_point(std::span<const Vec2> control, double t) {
  return geometry_kernel::curve_point(static_cast<int>(control.size()) - 1, control.data(), t);
}

/// The same with the ends' own bits.
inline Vec2 curve_point(std::span<const Vec2> control, double t) {
  if (t == 0.0) return control.front();
  if (t == 1.0) return control.back();
  return edge_point(control, t).value;
}

}  // namespace bezel::detail
