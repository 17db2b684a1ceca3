// The part of a target element that no donor covers.

#include <algorithm>
#include <limits>

#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

template <class Visit>
void ElementTransfer::extension_points(const Group& g, std::int32_t t, std::span<const Segment> run,
                                       const Vec2& centre, const Visit& visit) {
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
    const auto edge = donor_.edge(segment.source.edge);
    neighbours.push_back({d, edge_point(edge, segment.source.from).value,
                          edge_point(edge, segment.source.to).value});
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
  const auto add = [&](double w, const std::array<double, 2>& place, const Vec2& x) {
    const std::int32_t d = nearest(x);
    std::array<double, 3> warm{};
    bool have_warm = false;
    visit(w, place, d, donor_place(g, d, x, warm, have_warm));
  };
  const int pd = g.donor_degree.highest;
  if (g.target_mapped) {
    const int degree = pt + 2 * (target_.degree - 1) + pd + inexact_extra;
    reference_nodes(target_, t, run, false, degree);
    reference_fan(target_, t, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const Vec2& x) { add(w, q, x); });
  } else {
    const int degree = pt + pd;
    boundary_nodes(run, degree);
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
}

void ElementTransfer::add_extension(const Group& g, std::int32_t t, std::span<const Segment> run,
                                    double area, const Vec2& centre, Accumulators& sums,
                                    std::span<double> made) {
  const int pt = g.target_space->degree(ElementId(t));
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<double> value(nc);
  std::vector<double> first(nc);
  std::vector<double> difference(nc, 0.0);
  std::vector<double> phi(static_cast<std::size_t>(bernstein::triangle_size(pt)));
  bool have_first = false;
  const auto factors = multinomials(pt);
  const auto add = [&](double w, const std::array<double, 2>& place, std::int32_t d,
                       const std::array<double, 2>& q) {
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
  extension_points(g, t, run, centre, add);
  for (std::size_t c = 0; c < nc; ++c) made[c] = first[c] * area + difference[c];
}

void ElementTransfer::extension_blocks(const Group& g, std::int32_t t, std::span<const Segment> run,
                                       double area, const Vec2& centre, Accumulators& sums,
                                       ElementBlocks& blocks) {
  const int pt = g.target_space->degree(ElementId(t));
  const std::size_t columns = blocks.columns;
  const auto functions = static_cast<std::size_t>(bernstein::triangle_size(pt));
  std::vector<double> value(columns);
  std::vector<double> first(columns);
  std::vector<double> phi(functions);
  const auto factors = multinomials(pt);
  double weight = 0.0;
  const auto add = [&](double w, const std::array<double, 2>& place, std::int32_t d,
                       const std::array<double, 2>& q) {
    std::size_t k = 0;
    while (k < blocks.donor.size() && blocks.donor[k] != d) ++k;
    if (k == blocks.donor.size()) {
      blocks.donor.push_back(d);
      blocks.product.resize(blocks.product.size() + functions * columns, 0.0);
      blocks.mass.resize(blocks.mass.size() + columns, 0.0);
    }
    evaluate_scaled(g.donor_space->degree(ElementId(d)), g.components, g.donor_scaled(d).data(),
                    q[0], q[1], value.data());
    if (k == 0 && weight == 0.0) first = value;
    weight += w;
    basis_at(pt, place[0], place[1], phi.data());
    for (std::size_t n = 0; n < functions; ++n) {
      const double weighted = w * phi[n] / factors[n];
      sums.basis[n] += weighted;
      double* product = blocks.product.data() + (k * functions + n) * columns;
      for (std::size_t c = 0; c < columns; ++c) product[c] += weighted * value[c];
    }
    for (std::size_t c = 0; c < columns; ++c) blocks.mass[k * columns + c] += w * value[c];
  };
  extension_points(g, t, run, centre, add);
  // What the rule misses of the area counts with the first point's values, as in add_extension().
  for (std::size_t c = 0; c < columns; ++c) blocks.mass[c] += first[c] * (area - weight);
  blocks.made_donor = blocks.donor;
  blocks.made = blocks.mass;
}

}  // namespace bezel::detail
