#include "bezel/geometry/triangle_assembly.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/curved_polygon_builder.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::geometry_kernel {
namespace {

using short_names::at;

/// The end of a side that begins at `start` and ends at the place `end`; -1 when it does not.
double end_on_side(const BoundaryPlace& start, const BoundaryPlace& end) {
  if (end.edge == start.edge && start.s < end.s) return end.s;
  return end.s == 0.0 && end.edge == (start.edge + 1) % 3 ? 1.0 : -1.0;
}

}  // namespace

bool Assembly::run(const Arrangement& arrangement, Operation operation, bool cut_where_touching,
                   std::vector<CurvedPolygon>& spare, std::vector<CurvedPolygon>& out) {
  arrangement_ = &arrangement;
  sides_ = {&arrangement.sides(0), &arrangement.sides(1)};
  cut_ = cut_where_touching;
  if (!select(operation)) return false;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].used) continue;
    if (!trace(static_cast<std::int32_t>(i))) return false;
    unify_common();
    merge();
    emit(spare, out);
  }
  return true;
}

void Assembly::whole(const TriangleSides& sides, int k, bool backwards,
                     std::vector<CurvedPolygon>& spare, std::vector<CurvedPolygon>& out) {
  arrangement_ = nullptr;
  sides_[at(k)] = &sides;
  segments_.clear();
  for (int i = 0; i < 3; ++i) {
    const int side = backwards ? 2 - i : i, next = (side + 1) % 3;
    if (backwards)
      segments_.push_back({k, side, 1.0, 0.0, ~next, false, ~side});
    else
      segments_.push_back({k, side, 0.0, 1.0, ~side, false, ~next});
  }
  emit(spare, out);
}

void Assembly::add_piece(const Piece& piece) {
  leaving_[at(piece.from)][at(piece.triangle)] = static_cast<std::int32_t>(pieces_.size());
  pieces_.push_back(piece);
}

/// In every joint as many pieces arrive as leave.
bool Assembly::select(Operation operation) {
  const bool difference = operation == Operation::difference;
  pieces_.clear();
  leaving_.assign(arrangement_->joints().size(), {-1, -1});
  for (const BoundaryPart& part : arrangement_->parts(0)) {
    const bool common = part.place == (difference ? PartClass::against : PartClass::along);
    if (common || part.place == (difference ? PartClass::outside : PartClass::inside))
      add_piece({0, part.from, part.to, false, common, false});
  }
  for (const BoundaryPart& part : arrangement_->parts(1)) {
    if (part.place != PartClass::inside) continue;
    if (difference)
      add_piece({1, part.to, part.from, true, false, false});
    else
      add_piece({1, part.from, part.to, false, false, false});
  }
  balance_.assign(leaving_.size(), 0);
  for (const Piece& piece : pieces_) {
    ++balance_[at(piece.from)];
    --balance_[at(piece.to)];
  }
  return std::all_of(balance_.begin(), balance_.end(), [](int x) { return x == 0; });
}

/// Where two pieces arrive and two leave, all four branches of the boundaries are selected. Either
/// each boundary goes on (the loops touch there); or, in an intersection, the region is cut: each
/// boundary passes through a sector of the other triangle, and the only order of the four around
/// the joint which allows that has the arriving branch of one next to the leaving branch of the
/// other.
bool Assembly::trace(std::int32_t first) {
  segments_.clear();
  for (std::int32_t i = first;;) {
    Piece& piece = pieces_[at(i)];
    piece.used = true;
    add_segments(piece);
    const auto& leaving = leaving_[at(piece.to)];
    const std::int32_t own = leaving[at(piece.triangle)], across = leaving[at(1 - piece.triangle)],
                       next = own < 0 || (cut_ && across >= 0) ? across : own;
    if (next == first) return true;
    if (next < 0 || pieces_[at(next)].used) return false;
    i = next;
  }
}

void Assembly::add_segments(const Piece& piece) {
  const auto k = at(piece.triangle);
  const std::size_t before = segments_.size();
  const std::int32_t from = piece.backwards ? piece.to : piece.from,
                     to = piece.backwards ? piece.from : piece.to;
  const BoundaryPlace start = arrangement_->joints()[at(from)].place[k],
                      end = arrangement_->joints()[at(to)].place[k];
  BoundaryPlace place = start;
  std::int32_t name = from;
  for (bool first = true;; first = false) {
    const double s1 =
        first || place.edge == end.edge || end.s == 0.0 ? end_on_side(place, end) : -1.0;
    if (s1 >= 0.0) {
      segments_.push_back({piece.triangle, place.edge, place.s, s1, name, piece.common, to});
      break;
    }
    const int next = (place.edge + 1) % 3;
    segments_.push_back({piece.triangle, place.edge, place.s, 1.0, name, piece.common, ~next});
    place = {next, 0.0};
    name = ~next;
  }
  if (!piece.backwards) return;
  std::reverse(segments_.begin() + static_cast<std::ptrdiff_t>(before), segments_.end());
  for (std::size_t i = before; i < segments_.size(); ++i) {
    std::swap(segments_[i].s0, segments_[i].s1);
    std::swap(segments_[i].start, segments_[i].end);
  }
}

/// The same piece as one of the other triangle's side.
bool Assembly::on_other(Segment& segment) const {
  if (segment.start < 0 || segment.end < 0) return false;
  const auto k = at(1 - segment.triangle);
  const BoundaryPlace start = arrangement_->joints()[at(segment.start)].place[k],
                      end = arrangement_->joints()[at(segment.end)].place[k];
  // Along in an intersection, against in a difference: the loop then runs against the second.
  double s0 = start.s, s1 = end_on_side(start, end);
  int edge = start.edge;
  if (s1 < 0.0) {
    edge = end.edge;
    s1 = end.s;
    s0 = end_on_side(end, start);
    if (s0 < 0.0) return false;
  }
  segment.triangle = 1 - segment.triangle;
  segment.edge = edge;
  segment.s0 = s0;
  segment.s1 = s1;
  return true;
}

/// A common piece belongs to the side that its neighbour in the loop belongs to, where it continues
/// one: then the two are one edge.
void Assembly::unify_common() {
  const std::size_t n = segments_.size();
  const auto continues = [](const Segment& p, const Segment& q) {
    return p.triangle == q.triangle && p.edge == q.edge && p.s1 == q.s0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    Segment& segment = segments_[i];
    if (!segment.common) continue;
    const Segment &last = segments_[(i + n - 1) % n], &next = segments_[(i + 1) % n];
    if (continues(last, segment) || continues(segment, next)) continue;
    Segment other = segment;
    if (on_other(other) && (continues(last, other) || continues(other, next))) segment = other;
  }
}

/// Pieces of one side that follow each other become one.
void Assembly::merge() {
  const auto continues = [](const Segment& p, const Segment& q) {
    return p.triangle == q.triangle && p.edge == q.edge && p.s1 == q.s0;
  };
  // Begin where the first does not continue the last.
  std::size_t begin = 0;
  while (begin < segments_.size() &&
         continues(segments_[(begin + segments_.size() - 1) % segments_.size()], segments_[begin]))
    ++begin;
  if (begin == segments_.size()) return;
  std::rotate(segments_.begin(), segments_.begin() + static_cast<std::ptrdiff_t>(begin),
              segments_.end());
  std::size_t kept = 0;
  for (std::size_t i = 1; i < segments_.size(); ++i) {
    if (continues(segments_[kept], segments_[i])) {
      segments_[kept].s1 = segments_[i].s1;
      segments_[kept].end = segments_[i].end;
    } else {
      segments_[++kept] = segments_[i];
    }
  }
  segments_.resize(kept + 1);
}

void Assembly::emit(std::vector<CurvedPolygon>& spare, std::vector<CurvedPolygon>& out) const {
  if (spare.empty()) {
    out.emplace_back();
  } else {
    out.push_back(std::move(spare.back()));
    spare.pop_back();
  }
  CurvedPolygonBuilder polygon(out.back());
  polygon.vertices.clear();
  polygon.edges.clear();
  polygon.control.clear();
  polygon.first.assign(1, 0);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& segment = segments_[i];
    CurvedVertex vertex;
    if (segment.start >= 0) {
      const BoundaryJoint& joint = arrangement_->joints()[at(segment.start)];
      vertex = {joint.point, joint.place};
    } else {
      const int corner = ~segment.start;
      vertex.point = sides_[at(segment.triangle)]->corner(corner);
      vertex.place[at(segment.triangle)] = {corner, 0.0};
    }
    polygon.vertices.push_back(vertex);
    polygon.edges.push_back(
        {segment.triangle, segment.edge, segment.s0, segment.s1, static_cast<std::int32_t>(i)});
  }
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& segment = segments_[i];
    const std::span<const Vec2> side = sides_[at(segment.triangle)]->control(segment.edge);
    const std::size_t begin = polygon.control.size();
    polygon.control.resize(begin + side.size());
    Vec2* c = polygon.control.data() + begin;
    restrict_curve(static_cast<int>(side.size()) - 1, side.data(), std::min(segment.s0, segment.s1),
                   std::max(segment.s0, segment.s1), c);
    if (segment.s0 > segment.s1) std::reverse(c, c + side.size());
    const auto joint = [&](std::size_t edge) {
      return polygon.vertices[at(polygon.edges[edge].vertex)].point;
    };
    c[0] = joint(i);
    c[side.size() - 1] = joint(i + 1 < segments_.size() ? i + 1 : 0);
    polygon.first.push_back(polygon.control.size());
  }
}

}  // namespace bezel::geometry_kernel
