// The part of a target element that no donor covers.

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"
#include "bezel/transfer/extension.hpp"

namespace bezel::detail {
namespace {

/// Gaps below this fraction of an element hardly change its field, whatever value they have.
constexpr double small_gap = 1e-8;
/// Of a polynomial that is continued across an element for that.
constexpr double most_growth = 256.0;

}  // namespace

template <class Visit>
void ElementTransfer::extension_points(const Group& g, std::int32_t t, const RegionShape& shape,
                                       ExtensionReport& report, const Visit& visit) {
  const Vec2& centre = shape.centre;
  Extension extension(g, donor_, target_, search_, t, shape.run, centre);
  const int pt = g.target_space->degree(ElementId(t));
  struct Point {
    double w;
    std::array<double, 2> place;
    Vec2 x;
    Extension::Source source;
  };
  std::vector<Point> points;
  const auto add = [&](double w, const std::array<double, 2>& place, const Vec2& x) {
    points.push_back({w, place, x, extension.at(x, w)});
  };
  const int pd = g.donor_degree.highest;
  if (g.target_mapped) {
    const int degree = pt + 2 * (target_.degree - 1) + pd + inexact_extra;
    reference_nodes(target_, t, shape, false, degree);
    reference_fan(target_, t, reference_centre(), degree,
                  [&](double w, const std::array<double, 2>& q, const Vec2& x) { add(w, q, x); });
  } else {
    const int degree = pt + pd;
    boundary_nodes(shape, degree);
    const IntervalRule& radial = rule((degree + 3) / 2);
    for (const Node& node : nodes_) {
      const double kappa = cross(node.x - centre, node.dx);
      for (std::size_t i = 0; i < radial.node.size(); ++i) {
        const Vec2 x = centre + (node.x - centre) * radial.node[i];
        add(kappa * radial.weight[i] * radial.node[i], target_place(g, t, x), x);
      }
    }
  }
  // The rays of a fan that leave a bent thin gap sweep much more than it, forth and back, which
  // does not cancel where another donor serves. So small a gap is filled by one donor then.
  double swept = 0.0, sum = 0.0;
  bool one_donor = true;
  for (const Point& point : points) {
    swept += std::abs(point.w);
    sum += point.w;
    one_donor = one_donor && point.source.donor == points.front().source.donor;
  }
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  if (!one_donor && swept > 8.0 * std::abs(sum) && std::abs(sum) <= small_gap * own_area) {
    Extension single(g, donor_, target_, search_, t, shape.run, centre);
    const Extension::Source source = single.at(centre, sum);
    // Its polynomial where that does not grow much, else one value.
    const int degree = g.donor_space->degree(ElementId(source.donor));
    std::array<double, 3> warm{};
    bool found = false, near = true;
    for (Point& point : points) {
      const auto q = donor_place(g, source.donor, point.x, warm, found);
      const double size = std::abs(1.0 - q[0] - q[1]) + std::abs(q[0]) + std::abs(q[1]);
      near = near && (found || !g.donor_mapped) && std::pow(size, degree) <= most_growth;
      point.source = {source.donor, q};
    }
    for (const Point& point : points)
      visit(point.w, point.place, source.donor, near ? point.source.place : source.place);
    report.widen(single.report());
    return;
  }
  for (const Point& point : points)
    visit(point.w, point.place, point.source.donor, point.source.place);
  report.widen(extension.report());
}

void ElementTransfer::add_extension(const Group& g, std::int32_t t, const RegionShape& shape,
                                    double area, GroupState& own, std::span<double> made,
                                    ExtensionReport& report) {
  const int pt = g.target_space->degree(ElementId(t));
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<double> value(nc);
  std::vector<double> constant;  // of the first donor: taken off before a polynomial is continued,
                                 // so that a constant stays what it is
  std::vector<double> phi(static_cast<std::size_t>(bernstein::triangle_size(pt)));
  std::int32_t donor = exterior;
  const auto factors = multinomials(pt);
  std::fill(made.begin(), made.end(), 0.0);
  const auto add = [&](double w, const std::array<double, 2>& place, std::int32_t d,
                       const std::array<double, 2>& q) {
    const int pd = g.donor_space->degree(ElementId(d));
    if (d != donor) {
      const auto scaled = g.donor_scaled(d);
      if (donor == exterior) {
        constant.resize(nc);
        g.constants_of(donor_, d, constant);
      }
      take_off(pd, scaled, constant);
      donor = d;
    }
    evaluate_scaled(pd, g.components, shifted_.data(), q[0], q[1], value.data());
    basis_at(pt, place[0], place[1], phi.data());
    for (std::size_t n = 0; n < phi.size(); ++n) {
      const double weighted = w * phi[n] / factors[n];
      own.sums.basis[n] += weighted;
      for (std::size_t c = 0; c < nc; ++c)
        own.sums.product[n * nc + c] += weighted * (value[c] + (constant[c] - own.base[c]));
    }
    for (std::size_t c = 0; c < nc; ++c) made[c] += w * value[c];
  };
  extension_points(g, t, shape, report, add);
  for (std::size_t c = 0; c < nc; ++c) made[c] += constant[c] * area;
}

void ElementTransfer::extension_blocks(const Group& g, std::int32_t t, const RegionShape& shape,
                                       double area, Accumulators& sums, ElementBlocks& blocks,
                                       ExtensionReport& report) {
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
  extension_points(g, t, shape, report, add);
  // What the rule misses of the area counts with the first point's values, as in add_extension().
  for (std::size_t c = 0; c < columns; ++c) blocks.mass[c] += first[c] * (area - weight);
  blocks.made_donor = blocks.donor;
  blocks.made = blocks.mass;
}

}  // namespace bezel::detail
