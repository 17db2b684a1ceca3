// Regions of elements that are bent by more than their width: from coordinates in double-double
// arithmetic, taken from a centre in the region, and in the elements' reference triangles.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

bool ElementTransfer::is_bent_pair(std::int32_t t, std::int32_t d) const {
  return is_bent(target_, t) || (d != exterior && is_bent(donor_, d));
}

// Every end is joined to a start, the nearest pairs first. Of the four regions around a crossing
// two have the step from one edge's point to the other's, two the step back: all steps count,
// however short, for an area from the centre to a step along a bent edge is not small beside the
// width.
double ElementTransfer::bent_region_area(std::span<const Segment> run) {
  struct Joint {
    double distance;
    std::size_t end, start;
  };
  std::vector<std::span<const ExactVec2>> pieces;
  const ExactVec2* p = bent_control_.data();
  for (const Segment& segment : run) {
    const auto points =
        static_cast<std::size_t>((segment.target.edge < 0 ? donor_ : target_).degree) + 1;
    pieces.emplace_back(p, points);
    p += points;
  }
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < pieces.size(); ++k)
      joints.push_back({norm(thin_.in_plane(pieces[k].front() - pieces[i].back())), i, k});
  std::sort(joints.begin(), joints.end(), [](const Joint& a, const Joint& b) {
    return std::tie(a.distance, a.end, a.start) < std::tie(b.distance, b.end, b.start);
  });
  DoubleDouble twice;
  for (const auto& piece : pieces) twice += twice_swept_area(piece);
  bent_joints_.clear();
  std::vector<char> ended(pieces.size(), 0), started(pieces.size(), 0);
  for (const Joint& joint : joints) {
    if (ended[joint.end] != 0 || started[joint.start] != 0) continue;
    ended[joint.end] = started[joint.start] = 1;
    const ExactVec2 &from = pieces[joint.end].back(), &to = pieces[joint.start].front();
    if (from == to) continue;
    twice += cross(from, to);
    bent_joints_.push_back({from, to});
  }
  return 0.5 * static_cast<double>(twice);
}

double ElementTransfer::bent_strip_width(double on_target, double on_donor) const {
  const std::span<const ExactVec2> control(bent_control_);
  const auto points = static_cast<std::size_t>(target_.degree + 1);
  const auto [x, slope] = exact_edge_point(control.first(points), on_target);
  const ExactVec2 foot = exact_edge_point(control.subspan(points), on_donor).value;
  return static_cast<double>(cross(slope, foot - x));
}

void ElementTransfer::bent_reference_nodes(const OverlayMesh& mesh, std::int32_t element,
                                           const BentElement& own, bool source,
                                           std::span<const Segment> run, int degree, int points) {
  nodes_.clear();
  BentElement::Place q{};
  bool warm = false;
  const auto add = [&](const ExactVec2& x, const ExactVec2& dx, double weight) {
    warm = own.invert(x, q, warm);
    if (!warm) return;
    Node node;
    node.q = rounded(q);
    const BentElement::Point map = own.at(q);
    const DoubleDouble scale = DoubleDouble(weight) / cross(map.du, map.dv);
    node.dq = {static_cast<double>(cross(dx, map.dv) * scale),
               static_cast<double>(cross(map.du, dx) * scale)};
    nodes_.push_back(node);
  };
  const ExactVec2* p = bent_control_.data();
  for (const Segment& segment : run) {
    const OverlayMesh& other = segment.target.edge < 0 ? donor_ : target_;
    const std::span<const ExactVec2> control(p, static_cast<std::size_t>(other.degree) + 1);
    p += control.size();
    const Part& part = source ? segment.source : segment.target;
    // A piece of both boundaries goes by the target's part.
    if (part.edge >= 0 && (!source || segment.target.edge < 0)) {
      own_side_nodes(mesh, element, part, degree);
      continue;
    }
    warm = false;
    const IntervalRule& line = rule(points);
    for (std::size_t i = 0; i < line.node.size(); ++i) {
      const auto at = exact_edge_point(control, line.node[i]);
      add(at.value, at.derivative, line.weight[i]);
    }
  }
  warm = false;
  for (const auto& [from, to] : bent_joints_) add(DoubleDouble(0.5) * (from + to), to - from, 1.0);
}

// In the plane, and in the triangle of a donor that is not as thin, the rays from a centre leave a
// bent region by many times its width.
bool ElementTransfer::is_in_bent_target(const Group& g, std::int32_t t, std::int32_t d) const {
  return bent_ && g.target_mapped && is_bent(target_, t) &&
         (!g.donor_mapped || roundness(target_, t) < roundness(donor_, d));
}

void ElementTransfer::sum_in_bent_target(const Group& g, std::int32_t t, std::int32_t d,
                                         std::span<const Segment> run,
                                         std::span<const double> constants, Accumulators& sums) {
  const int pt = g.target_space->degree(ElementId(t));
  const int pd = g.donor_space->degree(ElementId(d));
  thin_.bring(target_, t, bent_target_);
  if (g.donor_mapped) thin_.bring(donor_, d, bent_donor_);
  const ExactPlace in_donor =
      g.donor_mapped ? thin_.exact_place_in(donor_, d) : exact_linear_place(g, d);
  BentElement::Place place{};
  bool found = false;
  const auto donor_at = [&](const ExactVec2& x) {
    found = g.donor_mapped && bent_donor_.invert(x, place, found);
    return found ? rounded(place) : in_donor(x);
  };
  const int degree =
      pt + 2 * (target_.degree - 1) + (g.donor_mapped ? pd + inexact_extra : pd * target_.degree);
  bent_reference_nodes(target_, t, bent_target_, false, run, degree, pulled_points(degree));
  reference_rays(reference_centre(), degree, [&](double w, const std::array<double, 2>& q) {
    const auto from = donor_at(bent_target_.at({q[0], q[1]}).value);
    push(w * bent_target_.det(q), q[0], q[1], from[0], from[1]);
  });
  flush(g, d, pt, constants, sums);
}

}  // namespace bezel::detail
