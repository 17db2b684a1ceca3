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
#include "bezel/transfer/overlay_mesh.hpp"

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
/// A contact tells sides only when it is this far (in parameter) from edge ends and from other
/// contacts.
inline constexpr double contact_isolation = 1e-9;
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

  std::vector<std::int32_t> donors;
  std::vector<BoundaryPiece> pieces;
  std::vector<Segment> segments;

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
  /// Along a target edge that was walked: its piece in a donor element and how it leaves that.
  struct Step {
    double r, s;
    std::int32_t donor;
    std::int32_t donor_edge;  // crossed at r; -1 at the target edge's end
    std::int32_t next;
    std::int32_t sign;  // of the crossing, as a contact's
  };
  struct Record {
    std::int32_t edge;
    std::int32_t first_step = -1;  // of a walk: all contacts are plain crossings
    std::int32_t details = -1;     // of an edge that was not walked, or unfolded
    std::int32_t crossings = 0;
    double gap = 0;  // largest between points of the two meshes, of the edge's diameter
    bool walked() const { return first_step >= 0; }
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
  /// A part of a donor edge inside T.
  struct InnerPart {
    std::array<double, 2> end = {0.0, 1.0};
    std::int32_t edge = -1;
    std::array<std::int32_t, 2> region{};  // left and right
    std::uint32_t cut = 0;  // bit k: by T's boundary at end k; else the edge ends there, inside T
  };
  /// A straight target edge a + r d on its way through the donor mesh.
  struct Walk {
    Vec2 a, d;
    double size;  // of d
    // Of the line, cross(d, x - a), at the ends of the side that it leaves by: right and left of
    // it.
    std::array<double, 2> beside;
    double r, gap_squared, last_gap_squared;
    std::int32_t donor, side, first_step, last_step, steps, record;
    bool ended;
  };

  static constexpr std::int32_t unlocated = -2;
  /// In place of a vertex's donor element where it is a vertex of the donor mesh: minus the node.
  static constexpr std::int32_t first_node = -3;

  /// Where something is remembered that holds for one chunk or element only.
  struct Place {
    std::uint32_t stamp = 0;
    std::int32_t at = 0;
  };

  /// The number of an edge's record in this chunk; a new one is empty.
  std::size_t record_of(std::int32_t edge);
  void find_records(std::int32_t t);
  Details& details_of(const Record& record) {
    return details_[static_cast<std::size_t>(record.details)];
  }
  void find_candidates(std::int32_t t);
  void overlay_edge(Record& record);
  /// Puts what two edges have in common on the lists, when that is quickly seen.
  bool meet_ordinarily(const CurveCache& curve, const CurveCache& other, double distance,
                       std::int32_t donor_edge, Record& record);
  // Ordinary edges and elements (overlay_walk.cpp).
  /// `near`: a vertex that may be near.
  std::int32_t donor_at_vertex(std::int32_t vertex, std::int32_t near);
  bool walk_edge(Record& record);
  bool share_edge(Record& record);
  std::int32_t donor_node(const Vec2& p);
  void add_step(const Step& step);
  /// The record's contacts and pieces, from the steps of a walk if need be.
  const Details& unfold(Record& record);
  bool walk_inside(std::int32_t t, OverlayList& list);
  bool cross_boundary(std::int32_t t, OverlayList& list);
  bool order_crossings(std::int32_t t);
  void add_inner_parts(OverlayList& list);
  // Straight edges (straight_walk.cpp).
  bool is_straight() const { return !search_.straight().empty() && target_.degree == 1; }
  void walk_straight_edges(std::size_t first_record);
  bool start_walk(std::size_t record, Walk& walk);
  void advance_walks();
  void finish_walk(const Walk& walk);
  /// The number of a donor's region.
  std::int32_t region_of(std::int32_t donor, OverlayList& list) {
    Place& group = group_[static_cast<std::size_t>(donor + 1)];
    if (group.stamp != now_) {
      group = {now_, static_cast<std::int32_t>(group_count_++)};
      list.donors.push_back(donor);
    }
    return group.at;
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
  std::uint32_t chunk_ = 0;
  std::vector<Record> records_;  // of the chunk's edges
  std::vector<Details> details_;
  std::array<std::size_t, 3> own_{};        // the records of the element's edges
  std::vector<Place> record_place_;         // by target edge
  std::vector<std::int32_t> vertex_place_;  // by target node: the donor element around it
  std::int32_t last_donor_ = 0;             // of the vertices looked at
  std::vector<Step> steps_;                 // room for more than step_count_
  std::size_t step_count_ = 0;
  std::vector<Walk> walks_;
  std::vector<std::uint32_t> going_;  // numbers of walks
  std::uint32_t now_ = 0;             // the stamp of what is remembered
  std::vector<Place> inner_place_;    // by donor edge: its part
  std::vector<InnerPart> inner_;      // room for more than inner_count_
  std::size_t inner_count_ = 0;
  std::vector<std::uint32_t> inside_stamp_;  // by donor node
  std::vector<std::int32_t> walk_;
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
  std::vector<Place> group_;  // by donor element + 1: its region
  std::size_t group_count_ = 0;
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
