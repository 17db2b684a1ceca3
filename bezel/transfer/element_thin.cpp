// Regions of thin elements that no plane makes round together.

#include <algorithm>
#include <cmath>
#include <utility>

#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

void ElementTransfer::find_thin_donors() {
  for (std::size_t e = 0; e < donor_.element_count(); ++e) {
    const auto d = static_cast<std::int32_t>(e);
    if (!is_flat(donor_, d) || !is_flat_as_given(donor_, d)) continue;
    if (thin_donor_.empty()) thin_donor_.resize(donor_.element_count(), 0);
    thin_donor_[e] = 1;
  }
}

bool ElementTransfer::has_thin_donor(const ElementPieces& own) const {
  return !thin_donor_.empty() && std::any_of(own.donors.begin(), own.donors.end(),
                                             [&](std::int32_t d) { return is_thin_donor(d); });
}

// A target that is thin in its own plane as well is bent, and so are the regions of all its donors.
// In a plane where the element is round the joints beside a donor that is long there are open by
// many roundings of the element: its neighbours' regions are as exact as its own, or do not add up.
void ElementTransfer::find_thin_regions(std::int32_t t, const ElementPieces& own) {
  const bool any = has_thin_donor(own);
  const bool all = is_flat(target_, t) || (any && target_.rounding > 0.0);
  for (std::size_t k = 0; k < own.donors.size(); ++k)
    element_.regions[k].thin = all || (any && is_thin_donor(own.donors[k]));
}

const ElementTransfer::RegionShape& ElementTransfer::thin_shape(std::int32_t t, std::int32_t d,
                                                                std::span<const Segment> run,
                                                                bool donors_plane) {
  static const RegionShape none;
  RegionShape& shape = shape_;
  shape = none;
  shape.run = run;
  thin_.begin(t, d, run, donors_plane);
  bent_ = is_bent_pair(t, d);
  bent_control_.clear();
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const OverlayMesh& mesh = source ? donor_ : target_;
    const Part& part = source ? segment.source : segment.target;
    thin_.append(mesh, part, shape.control);
    if (bent_) thin_.append(mesh, part, bent_control_);
    shape.degree.push_back(mesh.degree);
  }
  bridge_joints(shape);
  for (const Bridge& bridge : shape.bridges)
    shape.gap = std::max(shape.gap, norm(thin_.as_given(bridge.step)));
  shape.area = bent_ ? bent_region_area(run) : 0.5 * twice_piece_area(shape);
  return shape;
}

// As note_region(), in the plane that the elements came from.
void ElementTransfer::note_thin_region(std::int32_t t, std::int32_t d, const RegionShape& shape,
                                       ElementOutcome& outcome) const {
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const double own_size = given_diameter(target_, t);
  double size = own_size, smaller = own_area, width = own_area / own_size;
  if (d != exterior) {
    const double area = donor_.element_area[static_cast<std::size_t>(d)];
    const double donor_size = given_diameter(donor_, d);
    size = std::min(size, donor_size);
    smaller = std::min(smaller, area);
    width = std::min(width, area / donor_size);
  }
  width *= 2.0;
  outcome.max_joint_gap = std::max(outcome.max_joint_gap, shape.gap / size);
  const double distance = coincidence_distance(width, largest_given_coordinate(target_, t));
  if (shape.area < -std::max(largest_joint_gap * smaller, distance * size))
    outcome.inconsistent = true;
  const double widest = std::max(largest_joint_gap * width, 256.0 * distance);
  if (shape.gap <= widest) return;
  for (const Bridge& bridge : shape.bridges) {
    double across = thin_.joint_width(target_, t, bridge.step);
    if (d != exterior) across = std::min(across, thin_.joint_width(donor_, d, bridge.step));
    if (across > widest) outcome.inconsistent = true;
  }
}

// Of a donor that is not mapped.
LinearPlace ElementTransfer::thin_linear_place(const Group& g, std::int32_t d) const {
  return is_straight_place(g, d) ? thin_.place_in(donor_, d)
                                 : thin_.place_in(g.given_frame_of_donor(d));
}

ExactPlace ElementTransfer::exact_linear_place(const Group& g, std::int32_t d) const {
  return is_straight_place(g, d) ? thin_.exact_place_in(donor_, d)
                                 : thin_.exact_place_in(g.given_frame_of_donor(d));
}

bool ElementTransfer::is_straight_place(const Group& g, std::int32_t d) const {
  return donor_.degree == 1 &&
         (g.donor_space->basis() == Basis::reference || g.donor_space->is_own_frame(ElementId(d)));
}

void ElementTransfer::begin_thin_strip(std::int32_t t, std::int32_t d, const Segment& segment) {
  thin_.begin(t, d, {&segment, 1}, false);
  shape_.control.clear();
  thin_.append(target_, segment.target, shape_.control);
  thin_.append(donor_, segment.source, shape_.control);
  bent_ = is_bent_pair(t, d);
  if (!bent_) return;
  bent_control_.clear();
  thin_.append(target_, segment.target, bent_control_);
  thin_.append(donor_, segment.source, bent_control_);
}

double ElementTransfer::thin_strip_width(double s) const {
  const std::span<const Vec2> control(shape_.control);
  const auto points = static_cast<std::size_t>(target_.degree + 1);
  const auto [x, slope] = edge_point(control.first(points), s);
  const FootPoint foot = foot_point(control.subspan(points), x);
  return bent_ ? bent_strip_width(s, foot.s) : cross(slope, foot.point - x);
}

std::array<double, 2> ElementTransfer::thin_strip_place(const Group& g, std::int32_t d, double s) {
  const auto points = static_cast<std::size_t>(target_.degree + 1);
  const Vec2 x = edge_point(std::span<const Vec2>(shape_.control).first(points), s).value;
  if (!g.donor_mapped) return thin_linear_place(g, d)(x);
  if (bent_) {
    const std::span<const ExactVec2> control(bent_control_);
    BentElement::Place q{};
    thin_.bring(donor_, d, bent_donor_);
    return bent_donor_.invert(exact_edge_point(control.first(points), s).value, q, false)
               ? rounded(q)
               : thin_.place_in(donor_, d)(x);
  }
  thin_.bring(donor_, d, thin_donor_map_);
  std::array<double, 3> lambda{};
  if (invert_map(donor_.degree, thin_donor_map_.control, thin_donor_map_.moved(x), lambda, false))
    return {lambda[1], lambda[2]};
  return thin_.place_in(donor_, d)(x);
}

// Gauss nodes on the pieces and bridges in the region's plane.
void ElementTransfer::thin_nodes(int degree) {
  nodes_.clear();
  const Vec2* p = shape_.control.data();
  for (const int own : shape_.degree) {
    const std::span<const Vec2> control(p, static_cast<std::size_t>(own) + 1);
    const IntervalRule& line = rule((degree * own + 2 * own - 2) / 2 + 1);
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      const auto at = edge_point(control, line.node[i]);
      Node node;
      node.x = at.value;
      node.dx = at.derivative * line.weight[i];
      nodes_.push_back(node);
    }
    p += own + 1;
  }
}

template <class Visit>
void ElementTransfer::thin_fan(int degree, const Visit& visit) {
  thin_nodes(degree);
  const IntervalRule& radial = rule((degree + 3) / 2);
  reserve_points(nodes_.size() * radial.node.size());
  for (const Node& node : nodes_) {
    const double kappa = cross(node.x, node.dx);
    for (std::size_t i = 0; i < radial.node.size(); ++i)
      visit(kappa * radial.weight[i] * radial.node[i], node.x * radial.node[i]);
  }
}

// The nodes of the region's boundary in the reference triangle of a donor that was brought to its
// own plane, which is the region's.
void ElementTransfer::thin_reference_nodes(std::int32_t d, std::span<const Segment> run, int degree,
                                           int points) {
  if (bent_) return bent_reference_nodes(donor_, d, bent_donor_, true, run, degree, points);
  nodes_.clear();
  const Vec2* p = shape_.control.data();
  std::array<double, 3> lambda{};
  for (std::size_t i = 0; i < shape_.degree.size(); ++i) {
    const std::span<const Vec2> control(p, static_cast<std::size_t>(shape_.degree[i]) + 1);
    p += control.size();
    if (i < run.size() && run[i].target.edge < 0) {
      own_side_nodes(donor_, d, run[i].source, degree);
      continue;
    }
    bool warm = false;
    const bool bridge = i >= run.size();
    const IntervalRule& line = rule(bridge ? 1 : points);
    for (std::size_t k = 0; k < line.node.size(); ++k) {
      const auto at = edge_point(control, line.node[k]);
      warm = invert_map(donor_.degree, thin_donor_map_.control, at.value, lambda, warm);
      if (!warm) continue;
      Node node;
      node.q = {lambda[1], lambda[2]};
      const MapPoint map = map_point(donor_.degree, thin_donor_map_.control, node.q);
      const double scale = line.weight[k] / map.det;
      node.dq = {cross(at.derivative, map.dv) * scale, cross(map.du, at.derivative) * scale};
      nodes_.push_back(node);
    }
  }
}

template <class Visit>
void ElementTransfer::thin_reference_fan(const std::array<double, 2>& centre, int degree,
                                         const Visit& visit) {
  if (bent_) {
    return reference_rays(centre, degree, [&](double w, const std::array<double, 2>& q) {
      visit(w * bent_donor_.det(q), q, Vec2());
    });
  }
  reference_rays(centre, degree, [&](double w, const std::array<double, 2>& q) {
    const MapPoint map = map_point(donor_.degree, thin_donor_map_.control, q);
    visit(w * map.det, q, map.x);
  });
}

// As add_pair().
void ElementTransfer::add_thin_pair(const Group& g, std::int32_t t, std::int32_t d,
                                    std::span<const Segment> run, double area, GroupState& own,
                                    std::span<double> mass) {
  const int pt = g.target_space->degree(ElementId(t));
  const int pd = g.donor_space->degree(ElementId(d));
  const auto nc = static_cast<std::size_t>(g.components);
  const std::span<const double> constants = std::span(own.base).first(nc);
  Accumulators& sums = own.sums;
  thin_shape(t, d, run, g.donor_mapped);
  const bool in_bent_target = is_in_bent_target(g, t, d);
  if (in_bent_target && !g.donor_mapped) {
    std::fill(sums.mass.begin(), sums.mass.end(), 0.0);
    sum_in_bent_target(g, t, d, run, constants, sums);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = sums.mass[c] + constants[c] * area;
    return;
  }
  const bool target_framed = !g.target_mapped && target_.degree > 1;
  const ExactPlace exactly_in_target = target_framed
                                           ? thin_.exact_place_in(g.given_frame_of_target(t))
                                           : thin_.exact_place_in(target_, t);
  const LinearPlace in_target = thin_.place(exactly_in_target);
  if (g.target_mapped) thin_.bring(target_, t, thin_target_map_);
  if (g.target_mapped && bent_) thin_.bring(target_, t, bent_target_);
  std::array<double, 3> lambda{};
  bool warm = false;
  const auto target_at = [&](const Vec2& x) -> std::array<double, 2> {
    if (!g.target_mapped) return in_target(x);
    warm = invert_map(target_.degree, thin_target_map_.control, thin_target_map_.moved(x), lambda,
                      warm);
    return warm ? std::array<double, 2>{lambda[1], lambda[2]} : in_target(x);
  };
  BentElement::Place place_in_target{}, place_in_donor{};
  bool found_in_target = false;
  const auto target_at_exactly = [&](const ExactVec2& x) -> std::array<double, 2> {
    if (!g.target_mapped) return exactly_in_target(x);
    found_in_target = bent_target_.invert(x, place_in_target, found_in_target);
    return found_in_target ? rounded(place_in_target) : exactly_in_target(x);
  };

  if (!g.donor_mapped) {
    const LinearPlace in_donor = thin_linear_place(g, d);
    std::fill(sums.mass.begin(), sums.mass.end(), 0.0);
    thin_fan(pd + (g.target_mapped ? pt * target_.degree + inexact_extra : pt),
             [&](double w, const Vec2& x) {
               const auto to = target_at(x), from = in_donor(x);
               push(w, to[0], to[1], from[0], from[1]);
             });
    flush(g, d, pt, constants, sums);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = sums.mass[c] + constants[c] * area;
    return;
  }

  // The donor's mean by the exact rule, the rest in its reference triangle, as in add_pair().
  thin_.bring(donor_, d, thin_donor_map_);
  if (bent_) thin_.bring(donor_, d, bent_donor_);
  const double* donor_mass = g.donor_mass.data() + static_cast<std::size_t>(d) * nc;
  const double donor_area = donor_.element_area[static_cast<std::size_t>(d)];
  const auto functions = static_cast<std::size_t>(bernstein::triangle_size(pt));
  Accumulators exact, mapped, total;
  exact.reset(functions, nc);
  mapped.reset(functions, nc);
  total.reset(1, nc);
  if (!g.target_mapped) {
    thin_fan(pt, [&](double w, const Vec2& x) {
      const auto to = in_target(x);
      push(w, to[0], to[1], 0.0, 0.0);
    });
    flush(g, d, pt, constants, exact);
  }
  const int degree = pd + 2 * (donor_.degree - 1);
  const int with_target = degree + pt * donor_.degree;
  const std::size_t first = count_;
  double largest = 1.0;
  const auto put = [&](double w, const std::array<double, 2>& to,
                       const std::array<double, 2>& from) {
    for (const auto& place : {to, from})
      largest = std::max({largest, std::abs(place[0]), std::abs(place[1])});
    push(w, to[0], to[1], from[0], from[1]);
  };
  if (in_bent_target) {
    sum_in_bent_target(g, t, d, run, constants, mapped);
  } else {
    thin_reference_nodes(d, run, with_target, pulled_points(with_target));
    thin_reference_fan(
        reference_centre(), with_target,
        [&](double w, const std::array<double, 2>& q, const Vec2& x) {
          put(w, bent_ ? target_at_exactly(bent_donor_.at({q[0], q[1]}).value) : target_at(x), q);
        });
    // A thin target across is bent in the donor's coordinates by many times its width; in the plane
    // both are straight over each other's width.
    if (std::pow(largest, std::max(pt, pd)) > steepest_value) {
      const std::size_t second = count_;
      const double bent = std::exchange(largest, 1.0);
      std::array<double, 3> from{};
      bool found = false, all = true;
      thin_fan(pt + pd + 2 * inexact_extra, [&](double w, const Vec2& x) {
        if (bent_) {
          const ExactVec2 given = thin_.as_given_exactly(x);
          found = bent_donor_.invert(given, place_in_donor, found);
          put(w, target_at_exactly(given), rounded(place_in_donor));
        } else {
          found = invert_map(donor_.degree, thin_donor_map_.control, x, from, found);
          put(w, target_at(x), {from[1], from[2]});
        }
        all = all && found;
      });
      if (all && largest < bent) {
        drop_points(first, second);
      } else {
        count_ = second;
      }
    }
    flush(g, d, pt, constants, mapped);
  }
  for (std::size_t n = 0; n < functions; ++n) {
    const double difference = g.target_mapped ? 0.0 : exact.basis[n] - mapped.basis[n];
    sums.basis[n] += mapped.basis[n] + difference;
    for (std::size_t c = 0; c < nc; ++c)
      sums.product[n * nc + c] +=
          mapped.product[n * nc + c] + (donor_mass[c] / donor_area - constants[c]) * difference;
  }
  // The rule's errors cancel against those of neighbours, whichever way these go.
  const bool fitted = fitted_[static_cast<std::size_t>(&g - groups_.data())] != 0;
  const int mass_degree = fitted ? degree : degree + inexact_extra;
  thin_reference_nodes(d, run, mass_degree,
                       fitted ? FitDonors::mass_points(degree) : pulled_points(mass_degree));
  const double third = 1.0 / 3.0;
  double weight = 0.0;
  thin_reference_fan({third, third}, degree,
                     [&](double w, const std::array<double, 2>& q, const Vec2&) {
                       weight += w;
                       push(w, third, third, q[0], q[1]);
                     });
  flush(g, d, 0, constants, total);
  for (std::size_t c = 0; c < nc; ++c)
    mass[c] = total.mass[c] + constants[c] * weight + donor_mass[c] / donor_area * (area - weight);
}

}  // namespace bezel::detail
