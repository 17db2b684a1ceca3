#include "bezel/transfer/thin_region.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/numeric/box.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel::detail {
namespace {

DoubleDouble difference(double a, double b) {
  const WithError d = two_sum(a, -b);
  return {d.value, d.error};
}

Vec2 rounded(const Vec<2, DoubleDouble>& a) {
  return {{static_cast<double>(a.x()), static_cast<double>(a.y())}};
}

std::vector<Vec2> given_element(const OverlayMesh& mesh, std::int32_t e) {
  std::vector<Vec2> control;
  for (const NodeId n : mesh.mesh->nodes(ElementId(e))) control.push_back(mesh.given(n));
  return control;
}

/// Area over the square of the diameter.
double roundness(const OverlayMesh& mesh, std::int32_t e) {
  const double diameter = given_diameter(mesh, e);
  return mesh.element_area[static_cast<std::size_t>(e)] / (diameter * diameter);
}

}  // namespace

double given_diameter(const OverlayMesh& mesh, std::int32_t e) {
  if (mesh.given_control.empty()) return mesh.element_diameter[static_cast<std::size_t>(e)];
  Box2 box;
  for (const NodeId n : mesh.mesh->nodes(ElementId(e))) box.include(mesh.given(n));
  return box.diameter();
}

double largest_given_coordinate(const OverlayMesh& mesh, std::int32_t e) {
  double largest = 0.0;
  for (const NodeId n : mesh.mesh->nodes(ElementId(e))) {
    const Vec2& p = mesh.given(n);
    largest = std::max({largest, std::abs(p.x()), std::abs(p.y())});
  }
  return largest;
}

bool is_flat_as_given(const OverlayMesh& mesh, std::int32_t e) {
  return roundness(mesh, e) * (flat * 2.0) < 1.0;
}

ThinRegion::Exact ThinRegion::from_centre(const Vec2& p) const {
  return {{difference(p.x(), centre_.x()), difference(p.y(), centre_.y())}};
}

ThinRegion::Exact ThinRegion::mix(const Exact& a, const Exact& b, double s) {
  const DoubleDouble t(s), rest = difference(1.0, s);
  return {{rest * a.x() + t * b.x(), rest * a.y() + t * b.y()}};
}

void ThinRegion::begin(std::int32_t t, std::int32_t d, std::span<const Segment> run,
                       bool donors_plane) {
  centre_ = {};
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const Part& part = source ? segment.source : segment.target;
    const OverlayMesh& mesh = source ? donor_ : target_;
    given_.clear();
    for (const NodeId n : mesh.mesh->edge_nodes(EdgeId(part.edge))) given_.push_back(mesh.given(n));
    centre_ += curve_point(given_, part.from);
  }
  centre_ *= 1.0 / static_cast<double>(run.size());
  const bool of_donor =
      d != exterior && (donors_plane || roundness(donor_, d) < roundness(target_, t));
  map_ = round_map(of_donor ? given_element(donor_, d) : given_element(target_, t));
}

// Control point i is the blossom at i times `to` and `from` else.
void ThinRegion::append(const OverlayMesh& mesh, const Part& part, std::vector<Vec2>& out) {
  exact_.clear();
  for (const NodeId n : mesh.mesh->edge_nodes(EdgeId(part.edge)))
    exact_.push_back(map_.step(from_centre(mesh.given(n))));
  const std::size_t count = exact_.size();
  for (std::size_t i = 0; i < count; ++i) {
    blossom_ = exact_;
    for (std::size_t level = 1; level < count; ++level) {
      const double s = level <= i ? part.to : part.from;
      for (std::size_t k = 0; k + level < count; ++k)
        blossom_[k] = mix(blossom_[k], blossom_[k + 1], s);
    }
    out.push_back(rounded(blossom_[0]));
  }
}

LinearPlace ThinRegion::place(const std::array<DoubleDouble, 2>& at,
                              const std::array<Exact, 2>& gradient) const {
  LinearPlace place{};
  for (std::size_t k = 0; k < 2; ++k) {
    place.at[k] = static_cast<double>(at[k]);
    place.gradient[k] = rounded(map_.gradient(gradient[k]));
  }
  return place;
}

LinearPlace ThinRegion::place_in(const OverlayMesh& mesh, std::int32_t element) const {
  const auto nodes = mesh.mesh->nodes(ElementId(element));
  const auto g = static_cast<std::size_t>(mesh.degree);
  const Exact p = from_centre(mesh.given(nodes[0])), p1 = from_centre(mesh.given(nodes[g])),
              p2 = from_centre(mesh.given(nodes.back()));
  const Exact a = p1 - p, b = p2 - p;
  const DoubleDouble det = cross(a, b);
  return place({cross(b, p) / det, cross(p, a) / det},
               {Exact{{b.y() / det, -b.x() / det}}, Exact{{-a.y() / det, a.x() / det}}});
}

LinearPlace ThinRegion::place_in(const Frame& frame) const {
  const Exact offset = -from_centre(frame.centre);
  std::array<DoubleDouble, 2> at;
  std::array<Exact, 2> gradient;
  for (std::size_t k = 0; k < 2; ++k) {
    gradient[k] = {{frame.gradient[k + 1].x(), frame.gradient[k + 1].y()}};
    at[k] = DoubleDouble(1.0 / 3.0) + gradient[k].x() * offset.x() + gradient[k].y() * offset.y();
  }
  return place(at, gradient);
}

void ThinRegion::bring(const OverlayMesh& mesh, std::int32_t element, MappedElement& out) const {
  const std::vector<Vec2> given = given_element(mesh, element);
  out.map = round_map(given);
  out.control.clear();
  for (const Vec2& p : given) out.control.push_back(rounded(out.map.step(from_centre(p))));
  out.from_region = {rounded(out.map.step(map_.step_back(Exact{{1.0, 0.0}}))),
                     rounded(out.map.step(map_.step_back(Exact{{0.0, 1.0}})))};
}

Vec2 ThinRegion::as_given(const Vec2& step) const {
  return map_.step_back(step);
}

double ThinRegion::joint_width(const OverlayMesh& mesh, std::int32_t element,
                               const Vec2& step) const {
  const auto nodes = mesh.mesh->nodes(ElementId(element));
  const std::array<Vec2, 3> corner{mesh.given(nodes[0]),
                                   mesh.given(nodes[static_cast<std::size_t>(mesh.degree)]),
                                   mesh.given(nodes.back())};
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& a = corner[k];
    const Vec2& b = corner[(k + 1) % 3];
    const Exact side{{difference(b.x(), a.x()), difference(b.y(), a.y())}};
    largest = std::max(largest, std::abs(cross(step, rounded(map_.step(side)))));
  }
  return largest / given_diameter(mesh, element);
}

}  // namespace bezel::detail
