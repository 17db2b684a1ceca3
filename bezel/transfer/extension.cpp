#include "bezel/transfer/extension.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/numeric/box.hpp"

namespace bezel::detail {
namespace {

/// Up to this growth the nearest donor serves: two digits are lost.
constexpr double small_growth = 256.0;
/// Where polynomials are not continued any more values are those at the place that reaches this.
constexpr double held_growth = 16.0;
/// Another donor must grow so many times less to take its place.
constexpr double much_less = 16.0;
/// No polynomial is continued to where it grows more than this: ten digits are left of its
/// rounding; 2.3 times the element's height at degree 8.
constexpr double largest_growth = 0x1p20;
/// Nor to where the barycentrics add up to more than this, 32 times the element's height: what the
/// donor lacks of the field would become larger than the field.
constexpr double farthest = 64.0;
/// Others that are compared at each point.
constexpr std::size_t most_others = 16;
/// Corners say how far an element reaches when their triangle has this part of its area.
constexpr double least_corner_area = 0.25;
constexpr int halvings = 40;

Vec2 nearest_on(const Vec2& a, const Vec2& b, const Vec2& x) {
  const Vec2 d = b - a;
  const double length_squared = dot(d, d);
  const double s = length_squared > 0 ? std::clamp(dot(x - a, d) / length_squared, 0.0, 1.0) : 0.0;
  return a + d * s;
}

Vec2 nearest_on(const std::array<Vec2, 3>& corners, const Vec2& x) {
  Vec2 best = corners[0];
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 p = nearest_on(corners[k], corners[(k + 1) % 3], x);
    const double distance = norm(x - p);
    if (!(distance < smallest)) continue;
    smallest = distance;
    best = p;
  }
  return best;
}

double sum_of_sizes(double l1, double l2) {
  return std::abs(1.0 - l1 - l2) + std::abs(l1) + std::abs(l2);
}

}  // namespace

void ExtensionReport::widen(const ExtensionReport& other) {
  max_growth = std::max(max_growth, other.max_growth);
  moved_area = std::max(moved_area, other.moved_area);
  held_area = std::max(held_area, other.held_area);
}

void ExtensionReport::add(const ExtensionReport& other) {
  max_growth = std::max(max_growth, other.max_growth);
  moved_area += other.moved_area;
  held_area += other.held_area;
}

Box2 widened(const Box2& box, double by) {
  double magnitude = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    magnitude = std::max({magnitude, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
  return grown(box, by + widening * box.diameter() + 2.0 * coordinate_rounding * magnitude);
}

double nearest_corner(const OverlayMesh& mesh, std::span<const std::int32_t> elements,
                      const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::int32_t e : elements) {
    for (const Vec2& corner : mesh.corners(e)) nearest = std::min(nearest, norm(corner - p));
  }
  return nearest;
}

std::size_t donors_in_reach(const OverlayMesh& donor, const FrontSearch& search, const Box2& box,
                            std::vector<std::int32_t>& out) {
  FrontSearch::Memory memory;  // of walks: here the tree answers
  const Vec2 centre = box.centre();
  search.query(widened(box, 0.0), {}, memory, out);
  const std::size_t met = out.size();
  if (out.empty()) out.push_back(search.nearest(centre));
  const double reach = nearest_corner(donor, out, centre) + 0.5 * box.diameter();
  search.query(widened(box, reach * (1.0 + widening)), {}, memory, out);
  return met;
}

Extension::Extension(const Group& g, const OverlayMesh& donor, const OverlayMesh& target,
                     const FrontSearch& search, std::int32_t t, std::span<const Segment> run,
                     const Vec2& centre)
    : g_(g), donor_(donor), target_(target), search_(search), t_(t), centre_(centre) {
  // The donors along the hole in the cover; without any, the one nearest to the piece.
  for (const Segment& segment : run) {
    if (segment.source.edge < 0) continue;
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(segment.source.edge)];
    const auto edge = donor_.edge(segment.source.edge);
    neighbours_.push_back({candidate(sides[0] != exterior ? sides[0] : sides[1]),
                           edge_point(edge, segment.source.from).value,
                           edge_point(edge, segment.source.to).value});
  }
  if (neighbours_.empty()) {
    const Candidate d = candidate(search_.nearest(centre));
    neighbours_.push_back({d, centre, centre});
  }
}

Extension::Candidate Extension::candidate(std::int32_t d) const {
  Candidate c;
  c.donor = d;
  c.degree = g_.donor_space->degree(ElementId(d));
  c.corners = donor_.corners(d);
  c.frame = affine_frame(c.corners);
  const double corner_area = 0.5 * cross(c.corners[1] - c.corners[0], c.corners[2] - c.corners[0]);
  c.flat = !(corner_area >= least_corner_area * donor_.element_area[static_cast<std::size_t>(d)]);
  return c;
}

const Extension::Candidate& Extension::nearest(const Vec2& x) const {
  const Candidate* best = &neighbours_.front().donor;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Neighbour& n : neighbours_) {
    const Vec2 r = x - nearest_on(n.a, n.b, x);
    const double distance_squared = dot(r, r);
    if (!(distance_squared < smallest)) continue;
    smallest = distance_squared;
    best = &n.donor;
  }
  return *best;
}

Extension::Try Extension::attempt(const Candidate& c, const Vec2& x) const {
  Try found{};
  std::array<double, 3> warm{};
  bool have_warm = false;
  found.place = donor_place(g_, donor_, c.donor, x, warm, have_warm);
  double sizes;
  if (g_.donor_mapped) {
    sizes = sum_of_sizes(found.place[0], found.place[1]);
    found.held = !have_warm;
  } else if (c.flat) {
    sizes = 1.0 + 2.0 * norm(x - nearest_on(c.corners, x)) / donor_.element_width(c.donor);
  } else {
    const auto lambda = c.frame.lambda(x);
    sizes = sum_of_sizes(lambda[1], lambda[2]);
  }
  found.growth = std::pow(sizes, c.degree);
  found.far = c.degree > 0 && !(sizes <= farthest && found.growth <= largest_growth);
  return found;
}

// Those that grow least in the middle of the gap.
void Extension::find_others() {
  have_others_ = true;
  std::vector<std::int32_t> reached;
  donors_in_reach(donor_, search_, target_.element_box[static_cast<std::size_t>(t_)], reached);
  std::vector<std::pair<double, std::int32_t>> order;
  for (const std::int32_t d : reached) order.emplace_back(attempt(candidate(d), centre_).growth, d);
  const std::size_t kept = std::min(order.size(), most_others);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end());
  for (std::size_t i = 0; i < kept; ++i) others_.push_back(candidate(order[i].second));
}

Extension::Source Extension::at(const Vec2& x, double weight) {
  const Candidate* c = &nearest(x);
  Try best = attempt(*c, x);
  if (best.held) best.growth = std::max(best.growth, largest_growth);
  if (!(best.growth <= small_growth)) {
    if (!have_others_) find_others();
    const Candidate* other = nullptr;
    Try least = best;
    for (const Candidate& one : others_) {
      const Try its = attempt(one, x);
      if (its.held || !(its.growth < least.growth)) continue;
      least = its;
      other = &one;
    }
    if (other != nullptr && least.growth * much_less <= best.growth) {
      best = least;
      c = other;
      report_.moved_area += weight;
    }
  }
  if (best.held || best.far) {
    best = hold(*c, x);
    report_.held_area += weight;
  }
  report_.max_growth = std::max(report_.max_growth, best.growth);
  return {c->donor, best.place};
}

// Half-way and half-way again between the donor and the point.
Extension::Try Extension::hold(const Candidate& c, const Vec2& x) const {
  const Vec2 from = nearest_on(c.corners, x);
  Try best = attempt(c, from);
  double near = 0.0, far = 1.0;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (near + far);
    const Try its = attempt(c, from + (x - from) * middle);
    if (!its.held && its.growth <= held_growth) {
      near = middle;
      best = its;
    } else {
      far = middle;
    }
  }
  return best;
}

}  // namespace bezel::detail
