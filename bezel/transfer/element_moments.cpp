// Regions from their boundary pieces: shape, and sums by moments where both fields are polynomials
// in the plane.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {
namespace {

/// Largest factor by which the terms of a donor's polynomial may exceed its values in a region that
/// is thin and lies across the target's coordinates.
constexpr double steepest_terms = 256.0;

Vec2 mix(const Vec2& a, const Vec2& b, double s) {
  return (1.0 - s) * a + s * b;
}

/// The control points of a part of a curve, from - origin, appended; exact at ends 0 and 1.
void append_part(std::span<const Vec2> curve, const Part& part, const Vec2& origin,
                 std::vector<Vec2>& out) {
  const std::size_t first = out.size();
  const double from = part.from, to = part.to;
  if (curve.size() == 2) {
    const Vec2 a = curve[0] - origin, b = curve[1] - origin;
    out.push_back(from == 0.0 ? a : from == 1.0 ? b : mix(a, b, from));
    out.push_back(to == 0.0 ? a : to == 1.0 ? b : mix(a, b, to));
    return;
  }
  const auto n = static_cast<int>(curve.size());
  for (const Vec2& p : curve) out.push_back(p - origin);
  if (from == 0.0 && to == 1.0) return;
  Vec2* p = out.data() + first;
  // The same points in either direction.
  const double low = std::min(from, to), high = std::max(from, to);
  if (n == 3) {
    // The blossom at (low, low), (low, high), (high, high).
    const Vec2 a = mix(p[0], p[1], low), b = mix(p[1], p[2], low);
    const Vec2 c = mix(p[0], p[1], high), d = mix(p[1], p[2], high);
    const Vec2 last = p[2];
    p[0] = low == 0.0 ? p[0] : mix(a, b, low);
    p[1] = mix(a, b, high);
    p[2] = high == 1.0 ? last : mix(c, d, high);
    if (from > to) std::swap(p[0], p[2]);
    return;
  }
  geometry_kernel::PointBuffer<geometry_kernel::max_curve_points> room;
  Vec2* q = room.data();
  geometry_kernel::restrict_curve(n - 1, p, low, high, q);
  for (int i = 0; i < n; ++i) p[i] = from < to ? q[i] : q[n - 1 - i];
}

/// Twice the area between a piece and the rays from the origin to its ends: the sum of
/// weight[i, j] cross(p_i, p_j) over i < j, weight[i, j] = integral of B_i B_j' - B_j B_i'.
double twice_area(const Vec2* p, int degree, const std::vector<double>& weight) {
  double sum = 0.0;
  std::size_t n = 0;
  for (int i = 0; i < degree; ++i)
    for (int j = i + 1; j <= degree; ++j, ++n) sum += weight[n] * cross(p[i], p[j]);
  return sum;
}

/// Displacements in the plane to barycentrics 1 and 2.
Vec2 to_barycentric(const Frame& frame, const Vec2& x) {
  return {{dot(frame.gradient[1], x), dot(frame.gradient[2], x)}};
}

}  // namespace

bool ElementTransfer::is_small_donor(std::int32_t d, std::int32_t t) const {
  return d != exterior && donor_.element_area[static_cast<std::size_t>(d)] <
                              small_area * target_.element_area[static_cast<std::size_t>(t)];
}

// The regions of a small donor have points about a place in it, the same in all its targets: seen
// from theirs, points that are to cancel would be rounded apart by more than its own rounding.
const ElementTransfer::RegionShape& ElementTransfer::shape_of(std::int32_t t, std::int32_t d,
                                                              std::span<const Segment> run) {
  static const RegionShape none;
  RegionShape& shape = shape_;
  shape = none;
  shape.run = run;
  const bool small = is_small_donor(d, t);
  shape.origin = small ? donor_.corners(d)[0] : element_.origin;
  Vec2 centre;
  Vec2 sum;
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const Part& part = source ? segment.source : segment.target;
    const auto control = (source ? donor_ : target_).edge(part.edge);
    const std::size_t first = shape.control.size();
    append_part(control, part, shape.origin, shape.control);
    shape.degree.push_back(static_cast<int>(control.size()) - 1);
    centre += shape.control[first];
    sum += shape.control.back() - shape.control[first];
  }
  centre *= 1.0 / static_cast<double>(run.size());
  shape.relative = centre;
  shape.centre = shape.origin + centre;
  shape.gap = element_.loose ? bridge_joints(shape) : small ? close_joints(shape) : norm(sum);
  for (Vec2& p : shape.control) p -= centre;
  shape.area = 0.5 * twice_piece_area(shape);
  return shape;
}

double ElementTransfer::twice_piece_area(const RegionShape& shape) {
  double twice = 0.0;
  const Vec2* p = shape.control.data();
  for (const int degree : shape.degree) {
    twice += degree == 1 ? cross(p[0], p[1]) : twice_area(p, degree, area_weights(degree));
    p += degree + 1;
  }
  return twice;
}

// Where a target's edge crosses the donor's, its pieces begin and end in the point on the donor's:
// so they do for the other target beside the edge, and what both get adds up to what the donor has.
double ElementTransfer::close_joints(RegionShape& shape) {
  double widest = 0.0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < shape.run.size(); ++i) {
    end += static_cast<std::size_t>(shape.degree[i]) + 1;
    Vec2& last = shape.control[end - 1];
    std::size_t nearest = 0, of_piece = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0, first = 0; k < shape.run.size(); ++k) {
      const double distance = norm(shape.control[first] - last);
      if (distance < least) {
        least = distance;
        nearest = first;
        of_piece = k;
      }
      first += static_cast<std::size_t>(shape.degree[k]) + 1;
    }
    if (least == 0.0) continue;
    widest = std::max(widest, least);
    Vec2& start = shape.control[nearest];
    if (shape.run[of_piece].target.edge < 0)
      last = start;
    else
      start = last;
  }
  return widest;
}

bool ElementTransfer::by_moments(const Group& g, std::int32_t t, std::int32_t d) {
  const int degree = g.target_space->degree(ElementId(t));
  return !g.donor_mapped && !g.target_mapped && degree <= max_moment_degree &&
         degree == g.donor_space->degree(ElementId(d));
}

const PieceTable& ElementTransfer::piece_table(int degree, int moments) {
  const auto at = static_cast<std::size_t>(degree * (2 * max_moment_degree + 1) + moments);
  if (tables_.size() <= at) tables_.resize(at + 1);
  if (!tables_[at]) tables_[at] = std::make_unique<PieceTable>(degree, moments);
  return *tables_[at];
}

// In the target's barycentrics about the region's centre. False, and nothing is added, where that
// loses digits.
bool ElementTransfer::add_pair_moments(const Group& g, std::int32_t t, std::int32_t d,
                                       const RegionShape& shape, GroupState& own,
                                       std::span<double> mass) {
  const int degree = g.target_space->degree(ElementId(t));
  const Frame& target = g.target_frame[static_cast<std::size_t>(t)];
  const Frame& donor = g.donor_frame[static_cast<std::size_t>(d)];
  local_control_.resize(shape.control.size());
  double extent = 0.0;
  for (std::size_t i = 0; i < shape.control.size(); ++i) {
    local_control_[i] = to_barycentric(target, shape.control[i]);
    extent = std::max({extent, std::abs(local_control_[i].x()), std::abs(local_control_[i].y())});
  }
  const TargetPlace in_plane = place_of(target);
  const Vec2 first = to_barycentric(donor, in_plane.along_first);
  const Vec2 second = to_barycentric(donor, in_plane.along_second);
  const double slope = std::max(
      {std::abs(first.x()), std::abs(first.y()), std::abs(second.x()), std::abs(second.y())});
  if (std::pow(slope * extent, degree) > steepest_terms) return false;
  moment_pieces_.clear();
  const Vec2* p = local_control_.data();
  for (const int of_piece : shape.degree) {
    moment_pieces_.push_back({p, &piece_table(of_piece, 2 * degree)});
    p += of_piece + 1;
  }
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(2 * degree));
  moments_.resize(size);
  region_moments(2 * degree, moment_pieces_, moments_.data());
  for (double& m : moments_) m *= in_plane.area;

  RegionPlace place;
  const Vec2 in_target = to_barycentric(target, (shape.origin - target.centre) + shape.relative);
  const Vec2 in_donor = to_barycentric(donor, (shape.origin - donor.centre) + shape.relative);
  place.in_target = {in_target[0], in_target[1]};
  place.in_donor = {in_donor[0], in_donor[1]};
  place.to_donor = {first[0], second[0], first[1], second[1]};
  add_region(degree, place, moments_.data(), g.components, g.donor_powers(d), own.base.data(),
             own.moments.product.data(), own.moments.basis.data(), mass.data());
  return true;
}

void ElementTransfer::add_apart(std::size_t i, std::int32_t t, std::int32_t d,
                                std::span<const Segment> run, double area, bool thin,
                                std::span<double> mass) {
  const Group& g = groups_[i];
  GroupState& own = element_.groups[i];
  if (thin) {
    begin_sums(i);
    add_thin_pair(g, t, d, run, area, own, mass);
    return;
  }
  const RegionShape& shape = shape_of(t, d, run);
  if (add_pair_moments(g, t, d, shape, own, mass)) return;
  begin_sums(i);
  add_pair(g, t, d, shape, area, own, mass);
}

bool ElementTransfer::can_batch(const Group& g) {
  const int degree = g.target_space->uniform_degree();
  return !g.donor_mapped && !g.target_mapped && degree >= 0 && degree <= max_moment_degree &&
         degree == g.donor_degree.uniform;
}

TargetPlace ElementTransfer::target_place(const Group& g, std::int32_t t) {
  return place_of(g.target_frame[static_cast<std::size_t>(t)]);
}

template <std::size_t points>
void ElementTransfer::fill_curves(PieceBatch& batch, std::span<const BoundaryPiece> pieces) const {
  const std::size_t stride = batch.stride, count = pieces.size();
  const Vec2* const curves[2] = {target_.edge_control.data(), donor_.edge_control.data()};
  double *from = batch.from.data(), *to = batch.to.data();
  double *x = batch.x.data(), *y = batch.y.data();
  for (std::size_t i = 0; i < stride; ++i) {
    // The padding repeats the last piece.
    const BoundaryPiece& piece = pieces[i < count ? i : count - 1];
    const Vec2* p =
        curves[piece.source ? 1 : 0] + static_cast<std::size_t>(piece.part.edge) * points;
    from[i] = piece.part.from;
    to[i] = piece.part.to;
    for (std::size_t k = 0; k < points; ++k) {
      x[k * stride + i] = p[k].x();
      y[k * stride + i] = p[k].y();
    }
  }
}

void ElementTransfer::fill_batch(PieceBatch& batch, std::span<const BoundaryPiece> pieces) const {
  batch.resize(pieces.size(), target_.degree);
  if (target_.degree == 1) return fill_curves<2>(batch, pieces);
  if (target_.degree == 2) return fill_curves<3>(batch, pieces);
  return fill_curves<4>(batch, pieces);
}

std::span<const Segment> ElementTransfer::all_runs(const ElementPieces& own) {
  ElementState& e = element_;
  if (!e.has_segments) {
    e.has_segments = true;
    collect_segments(own, e.segments);
    std::size_t end = 0;
    for (const std::int32_t d : own.donors) {
      while (end < e.segments.size() && e.segments[end].donor == d) ++end;
      e.run_end.push_back(end);
    }
  }
  return e.segments;
}

bool ElementTransfer::shape_regions(std::int32_t t, const ElementPieces& own, std::size_t first,
                                    ElementOutcome& outcome) {
  Refilled<RegionState>& regions = element_.regions;
  regions.resize(own.donors.size());
  find_thin_regions(t, own);
  const auto note = [&](std::size_t k) {
    const std::int32_t d = own.donors[k];
    if (regions[k].thin) {
      const RegionShape& shape = thin_shape(t, d, run_of(own, k), false);
      regions[k].area = shape.area;
      regions[k].apart = true;
      note_thin_region(t, d, shape, outcome);
      return;
    }
    const RegionShape* shape = &shape_of(t, d, run_of(own, k));
    if (!element_.loose && !is_closed(t, d, shape->gap)) {
      element_.loose = true;
      shape = &shape_of(t, d, run_of(own, k));
    }
    regions[k].area = shape->area;
    regions[k].apart = !shape->bridges.empty();
    note_region(t, d, shape->area, shape->gap, shape->bridges, outcome);
  };
  const bool batch = donor_.degree == target_.degree && target_.degree <= max_batch_degree;
  if (!batch) {
    for (std::size_t k = 0; k < own.donors.size(); ++k) note(k);
    return false;
  }
  fill_batch(batch_, own.pieces);
  // The areas have the same bits whatever is summed besides.
  const bool summed = first < groups_.size();
  const int degree = summed ? 2 * groups_[first].target_space->uniform_degree() : 0;
  const TargetPlace place = summed ? target_place(groups_[first], t)
                            : target_.degree == 1
                                ? place_of(affine_frame(target_.corners(t)))
                                : TargetPlace{element_.origin, Vec2{{1, 0}}, Vec2{{0, 1}},
                                              Vec2{{1, 0}},    Vec2{{0, 1}}, 1.0};
  const ElementCount all{static_cast<std::uint32_t>(own.pieces.size()),
                         static_cast<std::uint32_t>(own.donors.size())};
  region_sums(piece_table(target_.degree, degree), degree, {place, element_.origin}, own.pieces,
              {&all, 1}, batch_);
  const double area_unit = batch_.area_in_units ? place.area : 1.0;
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const double own_size = target_.element_diameter[static_cast<std::size_t>(t)];
  for (std::size_t k = 0; k < own.donors.size(); ++k) {
    if (regions[k].thin) {
      note(k);
      continue;
    }
    const std::int32_t d = own.donors[k];
    const double* sums = batch_.region(k);
    const double* step = sums + batch_.open;
    const double gap = norm(step[0] * place.along_first + step[1] * place.along_second);
    const double area = sums[batch_.area] * area_unit;
    // About a place in the target element, areas are known to its rounding.
    bool small = false;
    if (d != exterior) {
      const double donor_area = donor_.element_area[static_cast<std::size_t>(d)];
      const double donor_size = donor_.element_diameter[static_cast<std::size_t>(d)];
      small = is_small_donor(d, t);
      // The usual case, as is_closed() and note_region() have it.
      if (!small && !element_.loose && area >= 0.0 && closes(gap, own_size, own_area) &&
          closes(gap, donor_size, donor_area)) {
        regions[k].area = area;
        outcome.max_joint_gap =
            std::max(outcome.max_joint_gap, gap / std::min(own_size, donor_size));
        continue;
      }
    }
    const bool open = !is_closed(t, d, gap);
    if (small || element_.loose || open) {
      element_.loose = element_.loose || open;
      note(k);
      regions[k].apart = regions[k].apart || small;
      continue;
    }
    regions[k].area = area;
    note_region(t, d, area, gap, {}, outcome);
  }
  return summed;
}

void ElementTransfer::add_batched(std::size_t i, std::int32_t t, const ElementPieces& own,
                                  bool summed) {
  const Group& g = groups_[i];
  GroupState& state = element_.groups[i];
  const std::span<double> mass = state.region_mass;
  const auto nc = static_cast<std::size_t>(g.components);
  const int degree = g.target_space->uniform_degree();
  const TargetPlace place = target_place(g, t);
  if (!summed) {
    const ElementCount all{static_cast<std::uint32_t>(own.pieces.size()),
                           static_cast<std::uint32_t>(own.donors.size())};
    region_sums(piece_table(target_.degree, 2 * degree), 2 * degree, {place, element_.origin},
                own.pieces, {&all, 1}, batch_);
  }
  // Constants come back whatever the rounding of the moments when they are not integrated at all.
  const std::span<double> base = std::span(state.base).first(nc);
  SmallestConstants constants(base);
  const std::size_t count = own.donors.size();
  const std::size_t stride = static_cast<std::size_t>(bernstein::triangle_size(degree)) * nc;
  if (regions_.size() < count) regions_.resize(2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    BatchRegion& region = regions_[k];
    region.donor = nullptr;
    region.far = false;
    const std::int32_t d = own.donors[k];
    if (d == exterior) continue;
    const double* const powers = g.powers.data() + static_cast<std::size_t>(d) * stride;
    constants.take(powers);
    if (element_.regions[k].apart) continue;
    region.frame = &g.donor_frame[static_cast<std::size_t>(d)];
    region.donor = powers;
  }
  const std::span<BatchRegion> regions = std::span(regions_).first(count);
  Accumulators& sums = state.moments;
  add_batch(degree, place, batch_, regions, g.components, base.data(), sums.product.data(),
            sums.basis.data(), mass.data());
  if (target_.degree > 1) {
    Refilled<double>& whole = state.whole;
    whole.assign(static_cast<std::size_t>(bernstein::triangle_size(2 * degree)), 0.0);
    for (std::size_t k = 0; k < own.donors.size(); ++k)
      for (std::size_t n = 0; n < whole.size(); ++n) whole[n] += batch_.region(k)[n];
  }
  for (std::size_t k = 0; k < count; ++k) {
    const RegionState& region = element_.regions[k];
    if (!regions[k].far && (!region.apart || own.donors[k] == exterior)) continue;
    add_apart(i, t, own.donors[k], run_of(own, k), region.area, region.thin,
              mass.subspan(k * nc, nc));
  }
}

void ElementTransfer::moments_to_powers(std::size_t i, std::int32_t t) {
  const Group& g = groups_[i];
  const Accumulators& moments = element_.groups[i].moments;
  Accumulators& sums = element_.groups[i].sums;
  const int degree = g.target_space->degree(ElementId(t));
  powers_from_moments(degree, 1, moments.basis.data(), sums.basis.data());
  powers_from_moments(degree, g.components, moments.product.data(), sums.product.data());
}

void ElementTransfer::element_moments(const Group& g, std::int32_t t, int degree) {
  const Frame& frame = g.target_frame[static_cast<std::size_t>(t)];
  const auto points = static_cast<std::size_t>(target_.degree + 1);
  local_control_.resize(3 * points);
  moment_pieces_.clear();
  std::size_t first = 0;
  for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
    const auto control = target_.edge(side.edge.value);
    for (std::size_t i = 0; i < points; ++i) {
      const Vec2& x = control[side.reversed ? points - 1 - i : i];
      local_control_[first + i] = to_barycentric(frame, x - frame.centre);
    }
    moment_pieces_.push_back({local_control_.data() + first, &piece_table(target_.degree, degree)});
    first += points;
  }
  moments_.resize(static_cast<std::size_t>(bernstein::triangle_size(degree)));
  region_moments(degree, moment_pieces_, moments_.data());
}

// The products of two basis functions of degree p are multiples of those of degree 2 p.
bool ElementTransfer::moment_factor(const Group& g, std::int32_t t, std::span<const double> whole) {
  const int p = g.target_space->degree(ElementId(t));
  if (g.target_mapped || p > max_moment_degree) return false;
  if (whole.empty()) {
    element_moments(g, t, 2 * p);
    whole = moments_;
  }
  const Frame& frame = g.target_frame[static_cast<std::size_t>(t)];
  const double scale = 1.0 / cross(frame.gradient[1], frame.gradient[2]);
  const auto functions = static_cast<std::size_t>(bernstein::triangle_size(p));
  powers_.assign(whole.size() + functions, 0.0);
  double* powers = powers_.data() + functions;
  powers_from_moments(2 * p, 1, whole.data(), powers);
  double low[bernstein::triangle_size(max_moment_degree)];
  for (int n = 0, b = 0; b <= p; ++b)
    for (int a = 0; a <= p - b; ++a, ++n)
      low[n] = whole[static_cast<std::size_t>(bernstein::triangle_index(2 * p, a, b))];
  powers_from_moments(p, 1, low, powers_.data());
  const auto factors = multinomials(p);
  factor_.scale = 1.0;
  factor_.lower.resize(functions * functions);
  factor_.integrals.resize(functions);
  double scaled[bernstein::triangle_size(max_moment_degree)];
  for (std::size_t n = 0; n < functions; ++n) {
    scaled[n] = factors[n] * scale;
    factor_.integrals[n] = powers_[n] * scaled[n];
  }
  double* to = factor_.lower.data();
  for (int n = 0, k = 0; k <= p; ++k) {
    for (int j = 0; j <= p - k; ++j, ++n) {
      const auto row = static_cast<std::size_t>(n);
      std::size_t column = 0;
      for (int l = 0; l <= k; ++l) {
        const double* from = powers + bernstein::triangle_index(2 * p, j, k + l);
        const int last = l < k ? p - l : j;
        for (int i = 0; i <= last; ++i, ++column)
          to[row * functions + column] = scaled[row] * factors[column] * from[i];
      }
    }
  }
  return factorize(functions, factor_);
}

}  // namespace bezel::detail
