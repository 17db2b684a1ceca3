#include "bezel/transfer/element_transfer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {
namespace {

/// Gaps below this fraction of an element are rounding and are extended whatever the policy.
constexpr double silent_gap = 1e-10;
/// Joints open by more than this fraction of the smaller element mean that the overlay is wrong
/// there.
constexpr double largest_joint_gap = 1e-10;

double signed_step(const Part& part) {
  return part.to - part.from;
}

}  // namespace

ElementTransfer::ElementTransfer(const OverlayMesh& donor, const OverlayMesh& target,
                                 const FrontSearch& search, std::span<Group> groups,
                                 Uncovered policy)
    : donor_(donor),
      target_(target),
      search_(search),
      groups_(groups),
      policy_(policy),
      sums_(groups.size()) {}

void ElementTransfer::Accumulators::reset(std::size_t functions, std::size_t components) {
  product.assign(functions * components, 0.0);
  basis.assign(functions, 0.0);
  mass.assign(components, 0.0);
}

const IntervalRule& ElementTransfer::rule(int points) {
  const auto n = static_cast<std::size_t>(points);
  if (rules_.size() <= n) rules_.resize(n + 1);
  if (rules_[n].node.empty()) rules_[n] = gauss_legendre(points);
  return rules_[n];
}

void ElementTransfer::reserve_points(std::size_t more) {
  const std::size_t needed = count_ + more + lanes;
  if (w_.size() >= needed) return;
  for (std::vector<double>* array : {&w_, &tu_, &tv_, &du_, &dv_}) array->resize(2 * needed);
}

void ElementTransfer::flush(const Group& g, std::int32_t d, int target_degree, Accumulators& sums) {
  reserve_points(0);
  while (count_ % lanes != 0) push(0.0, 0.0, 0.0, 0.0, 0.0);
  const PointBlock points{w_.data(),  tu_.data(), tv_.data(),
                          du_.data(), dv_.data(), count_ / lanes};
  accumulate(target_degree, g.donor_space->degree(ElementId(d)), g.components,
             g.donor_scaled(d).data(), points, sums.product.data(), sums.basis.data(),
             sums.mass.data());
  count_ = 0;
}

// Gauss nodes on the run's pieces in the plane; exact for integrands of total degree `degree` in x
// and y times the curve's own Jacobian.
void ElementTransfer::boundary_nodes(std::span<const Segment> run, int degree) {
  nodes_.clear();
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const Part& part = source ? segment.source : segment.target;
    const OverlayMesh& mesh = source ? donor_ : target_;
    const auto control = mesh.edge(part.edge);
    const IntervalRule& line = rule((degree * mesh.degree + 2 * mesh.degree - 2) / 2 + 1);
    const double step = signed_step(part);
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      Node node;
      const auto at = edge_point(control, part.from + step * line.node[i]);
      node.x = at.value;
      node.dx = at.derivative * (step * line.weight[i]);
      nodes_.push_back(node);
    }
  }
}

// The same nodes in the reference coordinates of one element of `mesh`: its own sides are straight
// there; along other curves the map is inverted point by point.
void ElementTransfer::reference_nodes(const OverlayMesh& mesh, std::int32_t element,
                                      std::span<const Segment> run, bool source, int degree) {
  static constexpr std::array<std::array<double, 2>, 3> corner = {
      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};
  nodes_.clear();
  const auto& sides = mesh.element_edges[static_cast<std::size_t>(element)];
  for (const Segment& segment : run) {
    const Part& own = source ? segment.source : segment.target;
    if (own.edge >= 0) {
      std::size_t side = 0;
      while (side < 2 && sides[side].edge.value != own.edge) ++side;
      const bool reversed = sides[side].reversed;
      const auto& a = corner[side];
      const auto& b = corner[(side + 1) % 3];
      const double step = signed_step(own) * (reversed ? -1.0 : 1.0);
      const IntervalRule& line = rule(degree / 2 + 1);
      for (std::size_t i = 0; i < line.node.size(); ++i) {
        const double t = own.from + signed_step(own) * line.node[i];
        const double m = reversed ? 1.0 - t : t;
        Node node;
        for (std::size_t k = 0; k < 2; ++k) {
          node.q[k] = a[k] + m * (b[k] - a[k]);
          node.dq[k] = (b[k] - a[k]) * step * line.weight[i];
        }
        nodes_.push_back(node);
      }
      continue;
    }
    const Part& part = source ? segment.target : segment.source;
    const OverlayMesh& other = source ? target_ : donor_;
    const auto control = other.edge(part.edge);
    const double step = signed_step(part);
    const IntervalRule& line = rule(degree / 2 + 1 + inexact_extra / 2);
    std::array<double, 3> lambda{};
    bool warm = false;
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      Node node;
      const auto at = edge_point(control, part.from + step * line.node[i]);
      node.x = at.value;
      node.dx = at.derivative;
      warm = invert_map(mesh.degree, mesh.element(element), node.x, lambda, warm);
      node.q = {lambda[1], lambda[2]};
      const MapPoint map = map_point(mesh, element, node.q);
      const double scale = step * line.weight[i] / map.det;
      node.dq = {cross(node.dx, map.dv) * scale, cross(map.du, node.dx) * scale};
      nodes_.push_back(node);
    }
  }
}

ElementTransfer::RunShape ElementTransfer::run_shape(std::span<const Segment> run) {
  RunShape shape{};
  ends_.clear();
  Vec2 sum;
  bool straight = true;
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const Part& part = source ? segment.source : segment.target;
    const auto control = (source ? donor_ : target_).edge(part.edge);
    const Vec2 a = curve_point(control, part.from);
    const Vec2 b = curve_point(control, part.to);
    ends_.push_back({a, b});
    shape.centre += a;
    sum += b - a;
    straight = straight && control.size() == 2;
  }
  shape.centre *= 1.0 / static_cast<double>(run.size());
  shape.gap = norm(sum);
  double twice = 0.0;
  if (straight) {
    for (const auto& [a, b] : ends_) twice += cross(a - shape.centre, b - shape.centre);
  } else {
    boundary_nodes(run, 0);
    for (const Node& node : nodes_) twice += cross(node.x - shape.centre, node.dx);
  }
  shape.area = 0.5 * twice;
  return shape;
}

std::array<double, 2> ElementTransfer::reference_centre() const {
  std::array<double, 2> q{0.0, 0.0};
  for (const Node& node : nodes_) {
    q[0] += node.q[0];
    q[1] += node.q[1];
  }
  const double scale = 1.0 / static_cast<double>(nodes_.size());
  return {q[0] * scale, q[1] * scale};
}

std::array<double, 2> ElementTransfer::target_place(const Group& g, std::int32_t t,
                                                    const Vec2& x) const {
  const auto lambda = g.target_frame[static_cast<std::size_t>(t)].lambda(x);
  return {lambda[1], lambda[2]};
}

std::array<double, 2> ElementTransfer::donor_place(const Group& g, std::int32_t d, const Vec2& x,
                                                   std::array<double, 3>& warm,
                                                   bool& have_warm) const {
  if (!g.donor_mapped) {
    const auto lambda = g.donor_frame[static_cast<std::size_t>(d)].lambda(x);
    return {lambda[1], lambda[2]};
  }
  std::array<double, 3> lambda = warm;
  if (invert_map(donor_.degree, donor_.element(d), x, lambda, have_warm)) {
    warm = lambda;
    have_warm = true;
    return {lambda[1], lambda[2]};
  }
  // Outside the reach of the map (a point far outside a curved element): the nearest corner
  // direction.
  have_warm = false;
  const auto corners = donor_.corners(d);
  const auto guess = affine_frame(corners).lambda(x);
  const double low = std::min({guess[0], guess[1], guess[2], 0.0});
  const double total = 1.0 - 3.0 * low;
  return {(guess[1] - low) / total, (guess[2] - low) / total};
}

void ElementTransfer::add_pair(const Group& g, std::int32_t t, std::int32_t d,
                               std::span<const Segment> run, double area, const Vec2& centre,
                               Accumulators& sums, std::span<double> mass) {
  const int pt = g.target_space->degree(ElementId(t));
  const int pd = g.donor_space->degree(ElementId(d));
  const auto nc = static_cast<std::size_t>(g.components);
  const double* donor_mass = g.donor_mass.data() + static_cast<std::size_t>(d) * nc;
  const double donor_area = donor_.element_area[static_cast<std::size_t>(d)];

  // Sums of w f over a physical fan of the given target degree (-1: only the mass).
  const auto physical_fan = [&](int degree, int target_degree, Accumulators& into) {
    boundary_nodes(run, degree);
    const IntervalRule& radial = rule((degree + 3) / 2);
    reserve_points(nodes_.size() * radial.node.size());
    const auto donor_at = [&](const Vec2& x) {
      if (g.donor_mapped) return std::array<double, 2>{0.0, 0.0};
      const auto l = g.donor_frame[static_cast<std::size_t>(d)].lambda(x);
      return std::array<double, 2>{l[1], l[2]};
    };
    const auto target_at = [&](const Vec2& x) {
      return g.target_mapped ? std::array<double, 2>{0.0, 0.0} : target_place(g, t, x);
    };
    const auto tc = target_at(centre);
    const auto dc = donor_at(centre);
    for (const Node& node : nodes_) {
      const double kappa = cross(node.x - centre, node.dx);
      const auto tq = target_at(node.x);
      const auto dq = donor_at(node.x);
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const double tau = radial.node[i];
        push(kappa * radial.weight[i] * tau, tc[0] + tau * (tq[0] - tc[0]),
             tc[1] + tau * (tq[1] - tc[1]), dc[0] + tau * (dq[0] - dc[0]),
             dc[1] + tau * (dq[1] - dc[1]));
      }
    }
    flush(g, d, target_degree, into);
  };

  if (!g.target_mapped && !g.donor_mapped) {
    std::fill(sums.mass.begin(), sums.mass.end(), 0.0);
    physical_fan(pt + pd, pt, sums);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = sums.mass[c];
    return;
  }

  if (g.target_mapped) {
    const int degree =
        pt + 2 * (target_.degree - 1) + (g.donor_mapped ? pd + inexact_extra : pd * target_.degree);
    reference_nodes(target_, t, run, false, degree);
    std::array<double, 3> warm{};
    bool have_warm = false;
    reference_fan(target_, t, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const MapPoint& map) {
                    const auto place = donor_place(g, d, map.x, warm, have_warm);
                    push(w, q[0], q[1], place[0], place[1]);
                  });
    flush(g, d, pt, sums);
  } else {
    // The donor's mean is carried exactly by the physical fan, only the rest by the rule in
    // reference coordinates.
    const auto functions = static_cast<std::size_t>(bernstein::triangle_size(pt));
    Accumulators exact;
    exact.reset(functions, nc);
    physical_fan(pt, pt, exact);
    const int degree = pd + 2 * (donor_.degree - 1) + pt * donor_.degree;
    reference_nodes(donor_, d, run, true, degree);
    Accumulators mapped;
    mapped.reset(functions, nc);
    reference_fan(donor_, d, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const MapPoint& map) {
                    const auto place = target_place(g, t, map.x);
                    push(w, place[0], place[1], q[0], q[1]);
                  });
    flush(g, d, pt, mapped);
    for (std::size_t n = 0; n < functions; ++n) {
      sums.basis[n] += exact.basis[n];
      const double difference = exact.basis[n] - mapped.basis[n];
      for (std::size_t c = 0; c < nc; ++c) {
        sums.product[n * nc + c] +=
            mapped.product[n * nc + c] + donor_mass[c] / donor_area * difference;
      }
    }
  }

  // The pair's mass, by a rule whose parts cancel between neighbouring target elements.
  Accumulators total;
  total.reset(1, nc);
  if (!g.donor_mapped) {
    physical_fan(pd, 0, total);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = total.mass[c];
    return;
  }
  const int degree = pd + 2 * (donor_.degree - 1);
  reference_nodes(donor_, d, run, true, degree + inexact_extra);
  const double third = 1.0 / 3.0;
  double weight = 0.0;
  reference_fan(donor_, d, {third, third}, degree,
                [&](double w, const std::array<double, 2>& q, const MapPoint&) {
                  weight += w;
                  push(w, third, third, q[0], q[1]);
                });
  flush(g, d, 0, total);
  for (std::size_t c = 0; c < nc; ++c)
    mass[c] = total.mass[c] + donor_mass[c] / donor_area * (area - weight);
}

ElementOutcome ElementTransfer::process(std::int32_t t, std::span<const Segment> segments,
                                        GivenList& given, std::span<double> made,
                                        ElementBlocks* blocks) {
  ElementOutcome outcome;
  if (blocks != nullptr) blocks->reset(static_cast<std::size_t>(groups_[0].components));
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const double own_size = target_.element_box[static_cast<std::size_t>(t)].diameter();
  std::size_t components = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    sums_[i].reset(
        static_cast<std::size_t>(bernstein::triangle_size(g.target_space->degree(ElementId(t)))),
        static_cast<std::size_t>(g.components));
    components += static_cast<std::size_t>(g.components);
  }
  masses_.assign(components, 0.0);
  std::vector<double>& pair_mass = pair_mass_;
  pair_mass.assign(components, 0.0);

  double total = 0.0;
  double extended = 0.0;
  for (std::size_t begin = 0; begin < segments.size();) {
    std::size_t end = begin;
    while (end < segments.size() && segments[end].donor == segments[begin].donor) ++end;
    const auto run = segments.subspan(begin, end - begin);
    const std::int32_t d = segments[begin].donor;
    begin = end;
    const RunShape shape = run_shape(run);
    const Vec2 centre = shape.centre;
    const double area = shape.area;
    const double open = shape.gap;
    double smaller = own_size;
    if (d != exterior)
      smaller = std::min(smaller, donor_.element_box[static_cast<std::size_t>(d)].diameter());
    outcome.max_joint_gap = std::max(outcome.max_joint_gap, open / smaller);
    double allowed = -largest_joint_gap * own_area;
    if (d != exterior)
      allowed =
          -largest_joint_gap * std::min(own_area, donor_.element_area[static_cast<std::size_t>(d)]);
    if (open > largest_joint_gap * smaller || area < allowed) outcome.inconsistent = true;
    total += area;
    std::size_t c0 = 0;
    if (d == exterior) {
      outcome.uncovered_area = std::max(area, 0.0);
      const bool silent = std::abs(area) <= silent_gap * own_area;
      if (!(silent || policy_ == Uncovered::extend)) continue;
      extended += area;
      if (blocks != nullptr) {
        extension_blocks(groups_[0], t, run, area, centre, sums_[0], *blocks);
        continue;
      }
      for (std::size_t i = 0; i < groups_.size(); ++i) {
        const auto nc = static_cast<std::size_t>(groups_[i].components);
        const std::span<double> here(pair_mass.data() + c0, nc);
        add_extension(groups_[i], t, run, area, centre, sums_[i], here);
        for (std::size_t c = 0; c < nc; ++c) {
          masses_[c0 + c] += here[c];
          made[c0 + c] += here[c];
        }
        c0 += nc;
      }
      continue;
    }
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const auto nc = static_cast<std::size_t>(groups_[i].components);
      const std::span<double> here(pair_mass.data() + c0, nc);
      add_pair(groups_[i], t, d, run, area, centre, sums_[i], here);
      for (std::size_t c = 0; c < nc; ++c) masses_[c0 + c] += here[c];
      c0 += nc;
    }
    if (blocks != nullptr) keep_pair(d, sums_[0], pair_mass, *blocks);
    outcome.covered_area += area;
    given.donor.push_back(d);
    given.area.push_back(area);
    given.mass.insert(given.mass.end(), pair_mass.begin(), pair_mass.end());
    ++outcome.pairs;
  }
  outcome.partition_residual = std::abs(total - own_area) / own_area;
  if (outcome.partition_residual > largest_joint_gap) outcome.inconsistent = true;
  const double integrated = outcome.covered_area + extended;
  const auto start = std::chrono::steady_clock::now();
  std::size_t c0 = 0;
  if (blocks != nullptr) finish_blocks(groups_[0], t, sums_[0], integrated, *blocks, outcome);
  for (std::size_t i = 0; i < groups_.size() && blocks == nullptr; ++i) {
    const auto nc = static_cast<std::size_t>(groups_[i].components);
    finish(groups_[i], t, sums_[i], std::span(masses_).subspan(c0, nc), integrated,
           groups_[i].target_out(t), outcome);
    c0 += nc;
  }
  outcome.solve_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace bezel::detail
