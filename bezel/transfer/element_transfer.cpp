#include "bezel/transfer/element_transfer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"

namespace bezel::detail {
namespace {

/// Extra degree of exactness where an integrand is not a polynomial (a map inverted along a curve).
constexpr int inexact_extra = 4;
/// Gaps below this fraction of an element are rounding and are extended whatever the policy.
constexpr double silent_gap = 1e-10;
/// The triangle of the corners serves as a frame when it has at least this fraction of the
/// element's area.
constexpr double fitting_corners = 0.5;
/// Joints open by more than this fraction of the smaller element mean that the overlay is wrong
/// there.
constexpr double largest_joint_gap = 1e-10;

Frame affine_frame(const std::array<Vec2, 3>& p) {
  Frame frame;
  const Vec2 a = p[1] - p[0];
  const Vec2 b = p[2] - p[0];
  const double det = cross(a, b);
  frame.gradient[1] = Vec2{{b[1] / det, -b[0] / det}};
  frame.gradient[2] = Vec2{{-a[1] / det, a[0] / det}};
  frame.gradient[0] = -(frame.gradient[1] + frame.gradient[2]);
  frame.centre = p[0] + (a + b) * (1.0 / 3.0);
  return frame;
}

struct MapPoint {
  Vec2 x, du, dv;
  double det;
};
MapPoint map_point(const OverlayMesh& mesh, std::int32_t e, const std::array<double, 2>& q) {
  const auto value = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
      mesh.degree, mesh.element(e).data(), {1.0 - q[0] - q[1], q[0], q[1]});
  return {value.value, value.du, value.dv, cross(value.du, value.dv)};
}

/// A positive rule on the reference triangle of any degree.
TriangleRule any_triangle_rule(int degree) {
  if (degree <= 80) return triangle_rule(degree);
  const IntervalRule line = gauss_legendre((degree + 3) / 2);
  TriangleRule rule;
  for (std::size_t i = 0; i < line.node.size(); ++i) {
    for (std::size_t j = 0; j < line.node.size(); ++j) {
      const double u = line.node[i];
      const double v = (1.0 - u) * line.node[j];
      rule.lambda.push_back({1.0 - u - v, u, v});
      rule.weight.push_back(line.weight[i] * line.weight[j] * (1.0 - u));
    }
  }
  return rule;
}

double signed_step(const Part& part) {
  return part.to - part.from;
}

}  // namespace

// ----------------------------------------------------------------------------------------------
// Group

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::span<const Field* const> fields, std::shared_ptr<const Space> target_space_in)
    : donor_space(fields.front()->space_ptr()),
      target_space(std::move(target_space_in)),
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1) {
  for (const Field* f : fields) components += f->components();
  if (!donor_mapped) {
    donor_frame.resize(donor.element_count());
    for (std::size_t e = 0; e < donor_frame.size(); ++e) {
      donor_frame[e] = donor_space->basis() == Basis::physical
                           ? donor_space->frame(ElementId(e))
                           : affine_frame(donor.corners(static_cast<std::int32_t>(e)));
    }
  }
  if (!target_mapped) {
    target_frame.resize(target.element_count());
    for (std::size_t e = 0; e < target_frame.size(); ++e) {
      const auto corners = target.corners(static_cast<std::int32_t>(e));
      const double corner_area = 0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]);
      const bool fits = corner_area >= fitting_corners * target.element_area[e];
      target_frame[e] = target_space->basis() == Basis::reference || fits
                            ? affine_frame(corners)
                            : target_space->frame(ElementId(e));
    }
  }

  const std::size_t elements = donor.element_count();
  const auto nc = static_cast<std::size_t>(components);
  scaled.resize(donor_space->coefficient_count() * nc);
  donor_mass.resize(elements * nc);
  std::size_t c0 = 0;
  for (const Field* f : fields) {
    const auto own = static_cast<std::size_t>(f->components());
    const std::vector<double> masses = element_integrals(*f);
    for (std::size_t e = 0; e < elements; ++e) {
      const auto coefficients = f->coefficients(ElementId(e));
      const auto factors = multinomials(donor_space->degree(ElementId(e)));
      double* place = scaled.data() + donor_space->offset(ElementId(e)) * nc;
      for (std::size_t c = 0; c < own; ++c) {
        for (std::size_t n = 0; n < factors.size(); ++n) {
          place[(c0 + c) * factors.size() + n] = coefficients[n * own + c] * factors[n];
        }
        donor_mass[e * nc + c0 + c] = masses[e * own + c];
      }
    }
    c0 += own;
  }
  out.resize(target_space->coefficient_count() * nc);
}

std::span<const double> Group::donor_scaled(std::int32_t e) const {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(donor_space->degree(id)));
  return {scaled.data() + donor_space->offset(id) * nc, size * nc};
}

std::span<double> Group::target_out(std::int32_t e) {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(target_space->degree(id)));
  return {out.data() + target_space->offset(id) * nc, size * nc};
}

// ----------------------------------------------------------------------------------------------
// ElementTransfer

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
// and y times the curve's own Jacobian. use_source: a piece on both meshes is taken from the
// donor's curve.
void ElementTransfer::boundary_nodes(std::span<const Segment> run, bool use_source, int degree) {
  nodes_.clear();
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0 || (use_source && segment.source.edge >= 0);
    const Part& part = source ? segment.source : segment.target;
    const OverlayMesh& mesh = source ? donor_ : target_;
    const auto control = mesh.edge(part.edge);
    const IntervalRule& line = rule((degree * mesh.degree + 2 * mesh.degree - 2) / 2 + 1);
    const double step = signed_step(part);
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      Node node;
      curve_point(control, part.from + step * line.node[i], node.x, node.dx);
      node.dx *= step * line.weight[i];
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
      curve_point(control, part.from + step * line.node[i], node.x, node.dx);
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
    boundary_nodes(run, false, 0);
    for (const Node& node : nodes_) twice += cross(node.x - shape.centre, node.dx);
  }
  shape.area = 0.5 * twice;
  return shape;
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
    boundary_nodes(run, false, degree);
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

  const auto reference_centre = [&] {
    std::array<double, 2> q{0.0, 0.0};
    for (const Node& node : nodes_) {
      q[0] += node.q[0];
      q[1] += node.q[1];
    }
    const double scale = 1.0 / static_cast<double>(nodes_.size());
    return std::array<double, 2>{q[0] * scale, q[1] * scale};
  };

  if (g.target_mapped) {
    const int degree =
        pt + 2 * (target_.degree - 1) + (g.donor_mapped ? pd + inexact_extra : pd * target_.degree);
    reference_nodes(target_, t, run, false, degree);
    const auto qc = reference_centre();
    const IntervalRule& radial = rule((degree + 3) / 2);
    reserve_points(nodes_.size() * radial.node.size());
    std::array<double, 3> warm{};
    bool have_warm = false;
    for (const Node& node : nodes_) {
      const std::array<double, 2> arm{node.q[0] - qc[0], node.q[1] - qc[1]};
      const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const double tau = radial.node[i];
        const std::array<double, 2> q{qc[0] + tau * arm[0], qc[1] + tau * arm[1]};
        const MapPoint map = map_point(target_, t, q);
        const auto place = donor_place(g, d, map.x, warm, have_warm);
        push(kappa * radial.weight[i] * tau * map.det, q[0], q[1], place[0], place[1]);
      }
    }
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
    const auto qc = reference_centre();
    const IntervalRule& radial = rule((degree + 3) / 2);
    reserve_points(nodes_.size() * radial.node.size());
    Accumulators mapped;
    mapped.reset(functions, nc);
    for (const Node& node : nodes_) {
      const std::array<double, 2> arm{node.q[0] - qc[0], node.q[1] - qc[1]};
      const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const double tau = radial.node[i];
        const std::array<double, 2> q{qc[0] + tau * arm[0], qc[1] + tau * arm[1]};
        const MapPoint map = map_point(donor_, d, q);
        const auto place = target_place(g, t, map.x);
        push(kappa * radial.weight[i] * tau * map.det, place[0], place[1], q[0], q[1]);
      }
    }
    flush(g, d, pt, mapped);
    for (std::size_t n = 0; n < functions; ++n) {
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
  const IntervalRule& radial = rule((degree + 3) / 2);
  reserve_points(nodes_.size() * radial.node.size());
  const double third = 1.0 / 3.0;
  double weight = 0.0;
  for (const Node& node : nodes_) {
    const std::array<double, 2> arm{node.q[0] - third, node.q[1] - third};
    const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
    for (std::size_t i = 0; i < radial.node.size(); ++i) {
      const double tau = radial.node[i];
      const std::array<double, 2> q{third + tau * arm[0], third + tau * arm[1]};
      const double w = kappa * radial.weight[i] * tau * map_point(donor_, d, q).det;
      weight += w;
      push(w, third, third, q[0], q[1]);
    }
  }
  flush(g, d, 0, total);
  for (std::size_t c = 0; c < nc; ++c)
    mass[c] = total.mass[c] + donor_mass[c] / donor_area * (area - weight);
}

void ElementTransfer::add_extension(const Group& g, std::int32_t t, std::span<const Segment> run,
                                    double area, const Vec2& centre, Accumulators& sums,
                                    std::span<double> made) {
  // The donors along the hole in the cover; without any, the one nearest to the piece.
  struct Neighbour {
    std::int32_t donor;
    Vec2 a, b;
  };
  std::vector<Neighbour> neighbours;
  for (const Segment& segment : run) {
    if (segment.source.edge < 0) continue;
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(segment.source.edge)];
    const std::int32_t d = sides[0] != exterior ? sides[0] : sides[1];
    Neighbour n{d, {}, {}};
    Vec2 unused;
    curve_point(donor_.edge(segment.source.edge), segment.source.from, n.a, unused);
    curve_point(donor_.edge(segment.source.edge), segment.source.to, n.b, unused);
    neighbours.push_back(n);
  }
  if (neighbours.empty()) neighbours.push_back({search_.nearest(centre), centre, centre});
  const auto nearest = [&](const Vec2& x) {
    std::int32_t best = neighbours.front().donor;
    double smallest = std::numeric_limits<double>::infinity();
    for (const Neighbour& n : neighbours) {
      const Vec2 d = n.b - n.a;
      const double length_squared = dot(d, d);
      const double s =
          length_squared > 0 ? std::clamp(dot(x - n.a, d) / length_squared, 0.0, 1.0) : 0.0;
      const Vec2 r = x - (n.a + d * s);
      const double distance_squared = dot(r, r);
      if (distance_squared < smallest) {
        smallest = distance_squared;
        best = n.donor;
      }
    }
    return best;
  };

  const int pt = g.target_space->degree(ElementId(t));
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<double> value(nc);
  std::vector<double> first(nc);
  std::vector<double> difference(nc, 0.0);
  std::vector<double> phi(static_cast<std::size_t>(bernstein::triangle_size(pt)));
  bool have_first = false;
  const auto factors = multinomials(pt);
  const auto add = [&](double w, const std::array<double, 2>& place, const Vec2& x) {
    const std::int32_t d = nearest(x);
    std::array<double, 3> warm{};
    bool have_warm = false;
    const auto q = donor_place(g, d, x, warm, have_warm);
    evaluate_scaled(g.donor_space->degree(ElementId(d)), g.components, g.donor_scaled(d).data(),
                    q[0], q[1], value.data());
    if (!have_first) first = value;
    have_first = true;
    basis_at(pt, place[0], place[1], phi.data());
    for (std::size_t n = 0; n < phi.size(); ++n) {
      const double weighted = w * phi[n] / factors[n];
      sums.basis[n] += weighted;
      for (std::size_t c = 0; c < nc; ++c) sums.product[n * nc + c] += weighted * value[c];
    }
    for (std::size_t c = 0; c < nc; ++c) difference[c] += w * (value[c] - first[c]);
  };
  const int pd = g.donor_space->highest_degree();
  if (g.target_mapped) {
    const int degree = pt + 2 * (target_.degree - 1) + pd + inexact_extra;
    reference_nodes(target_, t, run, false, degree);
    std::array<double, 2> qc{0.0, 0.0};
    for (const Node& node : nodes_) {
      qc[0] += node.q[0] / static_cast<double>(nodes_.size());
      qc[1] += node.q[1] / static_cast<double>(nodes_.size());
    }
    const IntervalRule& radial = rule((degree + 3) / 2);
    reserve_points(nodes_.size() * radial.node.size());
    for (const Node& node : nodes_) {
      const std::array<double, 2> arm{node.q[0] - qc[0], node.q[1] - qc[1]};
      const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const double tau = radial.node[i];
        const std::array<double, 2> q{qc[0] + tau * arm[0], qc[1] + tau * arm[1]};
        const MapPoint map = map_point(target_, t, q);
        add(kappa * radial.weight[i] * tau * map.det, q, map.x);
      }
    }
  } else {
    const int degree = pt + pd;
    boundary_nodes(run, false, degree);
    const IntervalRule& radial = rule((degree + 3) / 2);
    reserve_points(nodes_.size() * radial.node.size());
    for (const Node& node : nodes_) {
      const double kappa = cross(node.x - centre, node.dx);
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const Vec2 x = centre + (node.x - centre) * radial.node[i];
        add(kappa * radial.weight[i] * radial.node[i], target_place(g, t, x), x);
      }
    }
  }
  for (std::size_t c = 0; c < nc; ++c) made[c] = first[c] * area + difference[c];
}

const ElementTransfer::MassRule& ElementTransfer::mass_rule(int degree) {
  for (const MassRule& known : mass_rules_) {
    if (known.degree == degree) return known;
  }
  const TriangleRule points = any_triangle_rule(degree);
  const int g = target_.degree;
  MassRule made{degree, {}, {}, {}};
  std::vector<double> lower(static_cast<std::size_t>(bernstein::triangle_size(g - 1)));
  std::vector<double> value(target_.element_size);
  for (std::size_t q = 0; q < points.weight.size(); ++q) {
    const auto& l = points.lambda[q];
    made.place.push_back({l[1], l[2]});
    made.weight.push_back(points.weight[q]);
    basis_at(g, l[1], l[2], value.data());
    basis_at(g - 1, l[1], l[2], lower.data());
    // d/du B_ijk = g (B_{i,j-1,k} - B_{i-1,j,k}), both of degree g-1; the same for v with k.
    int n = 0;
    for (int k = 0; k <= g; ++k) {
      for (int j = 0; j <= g - k; ++j, ++n) {
        const auto at = [&](int jj, int kk) {
          return jj < 0 || kk < 0 || jj + kk > g - 1
                     ? 0.0
                     : lower[static_cast<std::size_t>(bernstein::triangle_index(g - 1, jj, kk))];
        };
        const double first = at(j, k);
        made.map.push_back({value[static_cast<std::size_t>(n)], g * (at(j - 1, k) - first),
                            g * (at(j, k - 1) - first)});
      }
    }
  }
  mass_rules_.push_back(std::move(made));
  return mass_rules_.back();
}

bool ElementTransfer::cholesky(std::size_t n, std::vector<double>& lower) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = lower[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i * n + k] * lower[j * n + k];
      if (i == j) {
        if (!(sum > 0.0)) return false;
        lower[j * n + j] = std::sqrt(sum);
      } else {
        lower[i * n + j] = sum / lower[j * n + j];
      }
    }
  }
  return true;
}

const ElementTransfer::Factor& ElementTransfer::factor(const Group& g, std::int32_t t) {
  const int p = g.target_space->degree(ElementId(t));
  const int gd = target_.degree;
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  Factor& f = factor_;
  if (gd == 1) {
    // A straight triangle's own barycentrics: one matrix for all, times twice the area.
    if (reference_degree_ != p) {
      reference_lower_ = bernstein::mass_matrix(p);
      cholesky(n, reference_lower_);
      reference_degree_ = p;
    }
    const double area = target_.element_area[static_cast<std::size_t>(t)];
    const double scale = std::sqrt(2.0 * area);
    f.lower.resize(n * n);
    for (std::size_t i = 0; i < n * n; ++i) f.lower[i] = reference_lower_[i] * scale;
    f.integrals.assign(n, area / static_cast<double>(n));
    return f;
  }
  const int degree = g.target_mapped ? 2 * p + 2 * (gd - 1) : 2 * p * gd + 2 * (gd - 1);
  const MassRule& points = mass_rule(degree);
  f.lower.assign(n * n, 0.0);
  f.integrals.assign(n, 0.0);
  std::vector<double>& phi = scratch_;
  phi.resize(n);
  const auto control = target_.element(t);
  for (std::size_t q = 0; q < points.weight.size(); ++q) {
    const std::array<double, 3>* map = points.map.data() + q * target_.element_size;
    Vec2 x;
    Vec2 du;
    Vec2 dv;
    for (std::size_t i = 0; i < target_.element_size; ++i) {
      x += control[i] * map[i][0];
      du += control[i] * map[i][1];
      dv += control[i] * map[i][2];
    }
    const auto place = g.target_mapped ? points.place[q] : target_place(g, t, x);
    basis_at(p, place[0], place[1], phi.data());
    const double w = points.weight[q] * cross(du, dv);
    for (std::size_t i = 0; i < n; ++i) {
      const double wi = w * phi[i];
      f.integrals[i] += wi;
      for (std::size_t j = 0; j <= i; ++j) f.lower[i * n + j] += wi * phi[j];
    }
  }
  if (!cholesky(n, f.lower)) {
    throw NumericsError("target triangle " + std::to_string(t) +
                        ": its mass matrix is singular in double precision (degree " +
                        std::to_string(p) + " on a degenerate element)");
  }
  return f;
}

void ElementTransfer::finish(Group& g, std::int32_t t, Accumulators& sums,
                             std::span<const double> mass, double area, ElementOutcome& outcome) {
  const int p = g.target_space->degree(ElementId(t));
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  const auto nc = static_cast<std::size_t>(g.components);
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const bool full = std::abs(area - own_area) <= 1e-9 * own_area;
  const Factor& f = factor(g, t);
  const auto factors = multinomials(p);
  const std::span<double> result = g.target_out(t);
  std::vector<double>& rhs = scratch_;
  std::array<Lambda, 3> to_frame{};  // the space's frame seen from the triangle computed on
  if (g.target_space->basis() == Basis::physical) {
    const auto corners = g.target_space->frame(ElementId(t)).corners();
    for (std::size_t k = 0; k < 3; ++k) {
      to_frame[k] = g.target_frame[static_cast<std::size_t>(t)].lambda(corners[k]);
    }
  }
  for (std::size_t c = 0; c < nc; ++c) {
    rhs.assign(n, 0.0);
    // Around the element's mean: what remains is small, so a constant comes back constant whatever
    // the rule.
    const double mean = full ? mass[c] / area : 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      rhs[i] = (sums.product[i * nc + c] - mean * sums.basis[i]) * factors[i];
      sum += rhs[i];
    }
    const double excess = (mass[c] - mean * own_area) - sum;
    for (std::size_t i = 0; i < n; ++i) rhs[i] += excess * f.integrals[i] / own_area;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) rhs[i] -= f.lower[i * n + k] * rhs[k];
      rhs[i] /= f.lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) rhs[i] -= f.lower[k * n + i] * rhs[k];
      rhs[i] /= f.lower[i * n + i];
    }
    // The constant part of what rounding left over.
    for (int sweep = 0; sweep < 2; ++sweep) {
      double got = 0.0;
      for (std::size_t i = 0; i < n; ++i) got += (rhs[i] + mean) * f.integrals[i];
      const double missing = mass[c] - got;
      if (sweep == 1) {
        outcome.max_mass_defect = std::max(outcome.max_mass_defect, std::abs(missing));
        break;
      }
      for (std::size_t i = 0; i < n; ++i) rhs[i] += missing / own_area;
    }
    for (std::size_t i = 0; i < n; ++i) rhs[i] += mean;
    if (g.target_space->basis() == Basis::physical) {
      const auto own = bernstein::specialize<double>(p, rhs, to_frame);
      std::copy(own.begin(), own.end(), rhs.begin());
    }
    for (std::size_t i = 0; i < n; ++i) result[i * nc + c] = rhs[i];
  }
}

ElementOutcome ElementTransfer::process(std::int32_t t, std::span<const Segment> segments,
                                        GivenList& given, std::span<double> made) {
  ElementOutcome outcome;
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
    outcome.covered_area += area;
    given.donor.push_back(d);
    given.area.push_back(area);
    given.mass.insert(given.mass.end(), pair_mass.begin(), pair_mass.end());
    ++outcome.pairs;
  }
  outcome.partition_residual = std::abs(total - own_area) / own_area;
  const double integrated = outcome.covered_area + extended;
  const auto start = std::chrono::steady_clock::now();
  std::size_t c0 = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const auto nc = static_cast<std::size_t>(groups_[i].components);
    finish(groups_[i], t, sums_[i], std::span(masses_).subspan(c0, nc), integrated, outcome);
    c0 += nc;
  }
  outcome.solve_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace bezel::detail
