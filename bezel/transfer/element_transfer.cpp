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

constexpr std::uint64_t timed_elements = 16;

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
      batched_(groups.size()),
      fitted_(groups.size()),
      element_(groups.size()),
      no_element_(groups.size()),
      group_batches_(groups.size()),
      fit_(donor, target, groups.size()),
      thin_(donor, target) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    batched_[i] = can_batch(groups[i]) ? 1 : 0;
    fitted_[i] = batched_[i] == 0 && PairFit::can(groups[i], donor, target) ? 1 : 0;
  }
  find_thin_donors();
  const bool all_batched = std::find(batched_.begin(), batched_.end(), 0) == batched_.end();
  some_together_ = all_batched && !groups.empty() && donor.degree == target.degree &&
                   target.degree <= max_batch_degree;
}

void ElementTransfer::Accumulators::reset(std::size_t functions, std::size_t components,
                                          std::size_t padding) {
  product.assign(functions * components + padding, 0.0);
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

void ElementTransfer::drop_points(std::size_t first, std::size_t last) {
  for (std::vector<double>* array : {&w_, &tu_, &tv_, &du_, &dv_})
    std::copy(array->begin() + static_cast<std::ptrdiff_t>(last),
              array->begin() + static_cast<std::ptrdiff_t>(count_),
              array->begin() + static_cast<std::ptrdiff_t>(first));
  count_ -= last - first;
}

void ElementTransfer::flush(const Group& g, std::int32_t d, int target_degree,
                            std::span<const double> constants, Accumulators& sums) {
  reserve_points(0);
  while (count_ % lanes != 0) push(0.0, 0.0, 0.0, 0.0, 0.0);
  const PointBlock points{w_.data(),  tu_.data(), tv_.data(),
                          du_.data(), dv_.data(), count_ / lanes};
  const int degree = g.donor_space->degree(ElementId(d));
  take_off(degree, g.donor_scaled(d), constants);
  accumulate(target_degree, degree, g.components, shifted_.data(), points, sums.product.data(),
             sums.basis.data(), sums.mass.data());
  count_ = 0;
}

void ElementTransfer::take_off(int degree, std::span<const double> scaled,
                               std::span<const double> constants) {
  const auto factors = multinomials(degree);
  shifted_.assign(scaled.begin(), scaled.end());
  for (std::size_t c = 0; c < constants.size(); ++c)
    for (std::size_t n = 0; n < factors.size(); ++n)
      shifted_[c * factors.size() + n] -= constants[c] * factors[n];
}

// Gauss nodes on the run's pieces in the plane; exact for integrands of total degree `degree` in x
// and y times the curve's own Jacobian.
void ElementTransfer::boundary_nodes(const RegionShape& shape, int degree) {
  nodes_.clear();
  for (const Segment& segment : shape.run) {
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
  for (const Bridge& bridge : shape.bridges) {
    Node node;
    node.x = shape.origin + bridge.from + 0.5 * bridge.step;
    node.dx = bridge.step;
    nodes_.push_back(node);
  }
}

// The same nodes in the reference coordinates of one element of `mesh`: its own sides are straight
// there; along other curves the map is inverted point by point.
void ElementTransfer::reference_nodes(const OverlayMesh& mesh, std::int32_t element,
                                      const RegionShape& shape, bool source, int degree) {
  nodes_.clear();
  for (const Segment& segment : shape.run) {
    const Part& own = source ? segment.source : segment.target;
    if (own.edge >= 0) {
      own_side_nodes(mesh, element, own, degree);
      continue;
    }
    const Part& part = source ? segment.target : segment.source;
    const OverlayMesh& other = source ? target_ : donor_;
    const auto control = other.edge(part.edge);
    const double step = signed_step(part);
    const IntervalRule& line = rule(pulled_points(degree));
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
  for (const Bridge& bridge : shape.bridges) {
    Node node;
    node.x = shape.origin + bridge.from + 0.5 * bridge.step;
    node.dx = bridge.step;
    std::array<double, 3> lambda{};
    if (!invert_map(mesh.degree, mesh.element(element), node.x, lambda, false)) continue;
    node.q = {lambda[1], lambda[2]};
    const MapPoint map = map_point(mesh, element, node.q);
    node.dq = {cross(node.dx, map.dv) / map.det, cross(map.du, node.dx) / map.det};
    nodes_.push_back(node);
  }
}

void ElementTransfer::own_side_nodes(const OverlayMesh& mesh, std::int32_t element, const Part& own,
                                     int degree) {
  static constexpr std::array<std::array<double, 2>, 3> corner = {
      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};
  const auto& sides = mesh.element_edges[static_cast<std::size_t>(element)];
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
  return detail::donor_place(g, donor_, d, x, warm, have_warm);
}

bool ElementTransfer::donor_places(const Group& g, std::int32_t d, std::size_t first) {
  std::array<double, 3> warm{};
  bool have_warm = false;
  bool all = true;
  const bool together = g.donor_mapped;
  if (together) {
    const Frame guess = affine_frame(donor_.corners(d));
    start_.clear();
    for (const Vec2& x : plane_) start_.push_back(guess.lambda(x));
    inverse_.resize(plane_.size());
    invert(donor_.degree, donor_.element(d), plane_, start_, inverse_);
  }
  for (std::size_t i = 0; i < plane_.size(); ++i) {
    if (together && inverse_[i].converged) {
      du_[first + i] = inverse_[i].lambda[1];
      dv_[first + i] = inverse_[i].lambda[2];
      continue;
    }
    const auto place = donor_place(g, d, plane_[i], warm, have_warm);
    all = all && (have_warm || !together);
    du_[first + i] = place[0];
    dv_[first + i] = place[1];
  }
  return all;
}

void ElementTransfer::add_pair(const Group& g, std::int32_t t, std::int32_t d,
                               const RegionShape& shape, double area, GroupState& own,
                               std::span<double> mass) {
  const int pt = g.target_space->degree(ElementId(t));
  const int pd = g.donor_space->degree(ElementId(d));
  const auto nc = static_cast<std::size_t>(g.components);
  const double* donor_mass = g.donor_mass.data() + static_cast<std::size_t>(d) * nc;
  const double donor_area = donor_.element_area[static_cast<std::size_t>(d)];
  const std::span<const double> taken = std::span(own.base).first(nc);
  const Vec2& centre = shape.centre;
  Accumulators& sums = own.sums;

  // Sums of w f over a physical fan of the given target degree (-1: only the mass).
  const auto physical_fan = [&](int degree, int target_degree, Accumulators& into) {
    boundary_nodes(shape, degree);
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
    flush(g, d, target_degree, taken, into);
  };

  if (!g.target_mapped && !g.donor_mapped) {
    std::fill(sums.mass.begin(), sums.mass.end(), 0.0);
    physical_fan(pt + pd, pt, sums);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = sums.mass[c] + taken[c] * area;
    return;
  }

  if (g.target_mapped) {
    const int degree =
        pt + 2 * (target_.degree - 1) + (g.donor_mapped ? pd + inexact_extra : pd * target_.degree);
    reference_nodes(target_, t, shape, false, degree);
    const std::size_t first = count_;
    plane_.clear();
    reference_fan(target_, t, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const Vec2& x) {
                    push(w, q[0], q[1], 0.0, 0.0);
                    plane_.push_back(x);
                  });
    const bool found_all = donor_places(g, d, first);
    double largest = 1.0;
    for (std::size_t i = first; i < count_; ++i)
      largest = std::max({largest, std::abs(du_[i]), std::abs(dv_[i])});
    if (!found_all || std::pow(largest, pd) > steepest_value) {  // a thin donor, as below
      count_ = first;
      const int own_degree = pt + inexact_extra + (2 + pd) * donor_.degree - 2;
      reference_nodes(donor_, d, shape, true, own_degree);
      std::array<double, 3> lambda{}, warm{};
      bool found = false, have_warm = false;
      reference_fan(donor_, d, reference_centre(), own_degree,
                    [&](double w, const std::array<double, 2>& q, const Vec2& x) {
                      found = invert_map(target_.degree, target_.element(t), x, lambda, found);
                      const auto place = g.donor_mapped ? q : donor_place(g, d, x, warm, have_warm);
                      push(w, lambda[1], lambda[2], place[0], place[1]);
                    });
    }
    flush(g, d, pt, taken, sums);
  } else {
    // The donor's mean is carried exactly by the physical fan, only the rest by the rule in
    // reference coordinates.
    const auto functions = static_cast<std::size_t>(bernstein::triangle_size(pt));
    Accumulators exact;
    exact.reset(functions, nc);
    physical_fan(pt, pt, exact);
    const int degree = pd + 2 * (donor_.degree - 1) + pt * donor_.degree;
    reference_nodes(donor_, d, shape, true, degree);
    Accumulators mapped;
    mapped.reset(functions, nc);
    const std::size_t first = count_;
    double largest = 1.0;
    reference_fan(donor_, d, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const Vec2& x) {
                    const auto place = target_place(g, t, x);
                    largest = std::max({largest, std::abs(place[0]), std::abs(place[1])});
                    push(w, place[0], place[1], q[0], q[1]);
                  });
    // A thin target is bent in the donor's coordinates, and rays there leave it by many times its
    // width: then its own coordinates serve.
    if (std::pow(largest, pt) > steepest_value) {
      count_ = first;
      const int own_degree = pd + inexact_extra + 2 * (target_.degree - 1) + pt * target_.degree;
      reference_nodes(target_, t, shape, false, own_degree);
      plane_.clear();
      reference_fan(target_, t, reference_centre(), own_degree,
                    [&](double w, const std::array<double, 2>&, const Vec2& x) {
                      const auto place = target_place(g, t, x);
                      push(w, place[0], place[1], 0.0, 0.0);
                      plane_.push_back(x);
                    });
      donor_places(g, d, first);
    }
    flush(g, d, pt, taken, mapped);
    for (std::size_t n = 0; n < functions; ++n) {
      const double difference = exact.basis[n] - mapped.basis[n];
      sums.basis[n] += exact.basis[n];
      for (std::size_t c = 0; c < nc; ++c) {
        sums.product[n * nc + c] +=
            mapped.product[n * nc + c] + (donor_mass[c] / donor_area - taken[c]) * difference;
      }
    }
  }

  // The pair's mass, by a rule whose parts cancel between neighbouring target elements.
  Accumulators total;
  total.reset(1, nc);
  if (!g.donor_mapped) {
    physical_fan(pd, 0, total);
    for (std::size_t c = 0; c < nc; ++c) mass[c] = total.mass[c] + taken[c] * area;
    return;
  }
  const int degree = pd + 2 * (donor_.degree - 1);
  reference_nodes(donor_, d, shape, true, degree + inexact_extra);
  const double third = 1.0 / 3.0;
  double weight = 0.0;
  reference_fan(donor_, d, {third, third}, degree,
                [&](double w, const std::array<double, 2>& q, const Vec2&) {
                  weight += w;
                  push(w, third, third, q[0], q[1]);
                });
  flush(g, d, 0, taken, total);
  for (std::size_t c = 0; c < nc; ++c)
    mass[c] = total.mass[c] + taken[c] * weight + donor_mass[c] / donor_area * (area - weight);
}

std::span<const std::array<Vec2, 2>> ElementTransfer::plane_bridges(const RegionShape& shape) {
  plane_bridges_.clear();
  for (const Bridge& bridge : shape.bridges)
    plane_bridges_.push_back({shape.origin + bridge.from, bridge.step});
  return plane_bridges_;
}

// Constants come back whatever the rounding of the sums when they are not integrated at all.
void ElementTransfer::choose_base(std::size_t i, const ElementPieces& own) {
  const Group& g = groups_[i];
  const std::span<double> base =
      std::span(element_.groups[i].base).first(static_cast<std::size_t>(g.components));
  const auto some = std::ranges::find_if(own.donors, [](std::int32_t d) { return d != exterior; });
  if (some == own.donors.end())
    return g.constants_of(donor_, search_.nearest(element_.origin), base);
  SmallestConstants smallest(base);
  std::vector<double> constants(base.size());
  for (auto d = some; d != own.donors.end(); ++d) {
    if (*d == exterior) continue;
    g.constants_of(donor_, *d, constants);
    smallest.take(constants.data());
  }
}

void ElementTransfer::begin_moments(std::size_t i) {
  GroupState& own = element_.groups[i];
  if (own.has_moments) return;
  own.has_moments = true;
  own.moments.reset(own.functions, static_cast<std::size_t>(groups_[i].components), batch_padding);
}

void ElementTransfer::begin_sums(std::size_t i) {
  GroupState& own = element_.groups[i];
  if (own.has_sums) return;
  own.has_sums = true;
  own.sums.reset(own.functions, static_cast<std::size_t>(groups_[i].components));
}

void ElementTransfer::begin_element(std::int32_t t, bool loose) {
  element_ = no_element_;
  const auto corners = target_.corners(t);
  element_.origin = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
  element_.loose = loose;
  std::size_t components = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    GroupState& own = element_.groups[i];
    const auto nc = static_cast<std::size_t>(g.components);
    own.functions =
        static_cast<std::size_t>(bernstein::triangle_size(g.target_space->degree(ElementId(t))));
    own.base.resize(nc + batch_padding);
    components += nc;
  }
  element_.masses.resize(components + batch_padding);
}

ElementOutcome ElementTransfer::process(std::int32_t t, const ElementPieces& own, GivenList& given,
                                        std::span<double> made, ElementBlocks* blocks) {
  ElementOutcome outcome;
  if (blocks != nullptr) blocks->reset(static_cast<std::size_t>(groups_[0].components));
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  begin_element(t, own.loose());
  const std::size_t components = element_.masses.size() - batch_padding;

  // The regions: shape and area do not depend on the fields.
  const bool batch =
      donor_.degree == target_.degree && target_.degree <= max_batch_degree && blocks == nullptr;
  const std::size_t first_batched =
      batch ? static_cast<std::size_t>(std::find(batched_.begin(), batched_.end(), 1) -
                                       batched_.begin())
            : groups_.size();
  const bool summed = shape_regions(t, own, first_batched, outcome);
  double total = 0.0;
  double extended = 0.0;
  for (std::size_t k = 0; k < own.donors.size(); ++k) {
    const std::int32_t d = own.donors[k];
    const double area = element_.regions[k].area;
    total += area;
    if (d == exterior) {
      outcome.uncovered_area = std::max(area, 0.0);
      continue;
    }
    outcome.covered_area += area;
    ++outcome.pairs;
    given.target.push_back(t);
    given.donor.push_back(d);
    given.area.push_back(area);
    element_.regions[k].mass_row = add_mass_row(given);
  }
  given.mass.resize(given.massed.size() * components);

  std::size_t c0 = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    GroupState& state = element_.groups[i];
    const auto nc = static_cast<std::size_t>(g.components);
    state.region_mass.resize(own.donors.size() * nc);
    const bool batched = batch && batched_[i] != 0;
    if (batched) {
      begin_moments(i);
      add_batched(i, t, own, summed && i == first_batched);
    } else {
      begin_sums(i);
    }
    const bool fitted = fitted_[i] != 0 && !own.donors.empty();
    // Open joints are bridged by the other rules; masses of mapped donors are all by one rule, for
    // its errors cancel between neighbours.
    const bool fits = fitted && !element_.loose;
    if (fitted) {
      fit_.begin(i, g, t, all_runs(own), blocks == nullptr);
      std::copy(fit_.constants().begin(), fit_.constants().end(), state.base.begin());
    }
    if (blocks == nullptr && (outcome.pairs == 0 || (!fitted && !batched))) choose_base(i, own);
    for (std::size_t k = 0; k < own.donors.size(); ++k) {
      const std::int32_t d = own.donors[k];
      const double area = element_.regions[k].area;
      const std::span<double> here(state.region_mass.data() + k * nc, nc);
      if (d == exterior) {
        const bool silent = std::abs(area) <= silent_gap(target_, t) * own_area;
        if (!(silent || policy_ == Uncovered::extend)) continue;
        if (i == 0) extended += area;
        begin_sums(i);
        const RegionShape& shape = shape_of(t, d, run_of(own, k));
        if (blocks != nullptr) {
          extension_blocks(g, t, shape, area, state.sums, *blocks, outcome.extension);
          continue;
        }
        add_extension(g, t, shape, area, state, here, outcome.extension);
        for (std::size_t c = 0; c < nc; ++c) made[c0 + c] += here[c];
      } else if (element_.regions[k].thin) {
        if (!batched) add_thin_pair(g, t, d, run_of(own, k), area, state, here);
      } else if (!batched) {
        if (fits && fit_.add(d, run_begin(k), element_.run_end[k], area, here)) {
          if (blocks != nullptr) fit_.take(state.sums.product.data(), state.sums.basis.data());
        } else if (blocks == nullptr && by_moments(g, t, d)) {
          begin_moments(i);
          add_apart(i, t, d, run_of(own, k), area, false, here);
        } else {
          const RegionShape& shape = shape_of(t, d, run_of(own, k));
          if (fitted && g.donor_mapped) {
            fitted_mass_.assign(nc, 0.0);
            add_pair(g, t, d, shape, area, state, fitted_mass_);
            if (element_.loose) {
              fit_.mass_of(d, run_begin(k), element_.run_end[k], area, plane_bridges(shape), here);
            }
          } else {
            add_pair(g, t, d, shape, area, state, here);
          }
        }
      }
      for (std::size_t c = 0; c < nc; ++c) element_.masses[c0 + c] += here[c];
      if (d == exterior) continue;
      if (const std::int32_t row = element_.regions[k].mass_row; row >= 0)
        std::copy(here.begin(), here.end(),
                  given.mass.data() + static_cast<std::size_t>(row) * components + c0);
      if (blocks != nullptr) keep_pair(d, state.sums, here, *blocks);
    }
    if (fits) fit_.take(state.sums.product.data(), state.sums.basis.data());
    c0 += nc;
  }
  if (element_.loose && components > 0) give_strips(t, own, components, given, made, blocks);
  note_partition(t, total, outcome);
  finish_groups(t, outcome.covered_area + extended, batch, blocks, outcome);
  return outcome;
}

void ElementTransfer::note_partition(std::int32_t t, double total, ElementOutcome& outcome) const {
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  outcome.partition_residual = std::abs(total - own_area) / own_area;
  if (outcome.partition_residual > largest_joint_gap &&
      outcome.partition_residual > largest_partition_residual(t))
    outcome.inconsistent = true;
}

void ElementTransfer::finish_groups(std::int32_t t, double integrated, bool batch,
                                    ElementBlocks* blocks, ElementOutcome& outcome) {
  // Reading the clock takes as long as a small solution: every so many elements are measured.
  const bool timed = elements_++ % timed_elements == 0;
  const auto start =
      timed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
  std::size_t c0 = 0;
  if (blocks != nullptr)
    finish_blocks(groups_[0], t, element_.groups[0].sums, integrated, *blocks, outcome);
  for (std::size_t i = 0; i < groups_.size() && blocks == nullptr; ++i) {
    GroupState& own = element_.groups[i];
    const auto nc = static_cast<std::size_t>(groups_[i].components);
    const std::span<const double> mass = std::span(element_.masses).subspan(c0, nc);
    const std::span<double> result = groups_[i].target_out(t);
    c0 += nc;
    if (finish_straight(i, t, mass, integrated, result, outcome)) continue;
    begin_sums(i);
    if (own.has_moments) moments_to_powers(i, t);
    std::span<const double> whole;
    // Around open joints in a plane that makes donors long, sums are no sharper than those are.
    const bool blurred = element_.loose && target_.rounding > 0.0;
    if (outcome.uncovered_area == 0.0 && batch && !blurred) whole = own.whole;
    finish(groups_[i], t, own.sums, whole, mass, own.base, integrated, result, outcome);
  }
  if (timed) {
    outcome.solve_seconds =
        static_cast<double>(timed_elements) *
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
}

}  // namespace bezel::detail
