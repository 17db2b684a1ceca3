#include "bezel/transfer/thin_region.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/numeric/box.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel::detail {
namespace {

/// 1 - s without rounding.
DoubleDouble rest_of(double s) {
  const WithError d = two_sum(1.0, -s);
  return {d.value, d.error};
}

}  // namespace

std::vector<Vec2> given_element(const OverlayMesh& mesh, std::int32_t e) {
  std::vector<Vec2> control;
  for (const NodeId n : mesh.mesh->nodes(ElementId(e))) control.push_back(mesh.given(n));
  return control;
}

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

double roundness(const OverlayMesh& mesh, std::int32_t e) {
  const double diameter = given_diameter(mesh, e);
  return mesh.element_area[static_cast<std::size_t>(e)] / (diameter * diameter);
}

bool is_flat_as_given(const OverlayMesh& mesh, std::int32_t e) {
  return roundness(mesh, e) * (flat * 2.0) < 1.0;
}

bool is_bent(const OverlayMesh& mesh, std::int32_t e) {
  if (mesh.degree == 1 || !is_flat_as_given(mesh, e)) return false;
  const std::vector<Vec2> control = given_element(mesh, e);
  return bezel::is_bent(RoundControl(control).points(),
                        mesh.element_area[static_cast<std::size_t>(e)]);
}

ExactVec2 ThinRegion::mix(const ExactVec2& a, const ExactVec2& b, double s) {
  const DoubleDouble t(s), rest = rest_of(s);
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

const ExactVec2& ThinRegion::blossom(const Part& part, std::size_t i) {
  blossom_ = exact_;
  for (std::size_t level = 1; level < exact_.size(); ++level) {
    const double s = level <= i ? part.to : part.from;
    for (std::size_t k = 0; k + level < exact_.size(); ++k)
      blossom_[k] = mix(blossom_[k], blossom_[k + 1], s);
  }
  return blossom_[0];
}

void ThinRegion::append(const OverlayMesh& mesh, const Part& part, std::vector<Vec2>& out) {
  exact_.clear();
  for (const NodeId n : mesh.mesh->edge_nodes(EdgeId(part.edge)))
    exact_.push_back(map_.step(exact_step(centre_, mesh.given(n))));
  for (std::size_t i = 0; i < exact_.size(); ++i) out.push_back(rounded(blossom(part, i)));
}

void ThinRegion::append(const OverlayMesh& mesh, const Part& part, std::vector<ExactVec2>& out) {
  exact_.clear();
  for (const NodeId n : mesh.mesh->edge_nodes(EdgeId(part.edge)))
    exact_.push_back(exact_step(centre_, mesh.given(n)));
  for (std::size_t i = 0; i < exact_.size(); ++i) out.push_back(blossom(part, i));
}

LinearPlace ThinRegion::place(const ExactPlace& exact) const {
  LinearPlace place{};
  for (std::size_t k = 0; k < 2; ++k) {
    place.at[k] = static_cast<double>(exact.at[k]);
    place.gradient[k] = rounded(map_.gradient(exact.gradient[k]));
  }
  return place;
}

LinearPlace ThinRegion::place_in(const OverlayMesh& mesh, std::int32_t element) const {
  return place(exact_place_in(mesh, element));
}

LinearPlace ThinRegion::place_in(const Frame& frame) const {
  return place(exact_place_in(frame));
}

ExactPlace ThinRegion::exact_place_in(const OverlayMesh& mesh, std::int32_t element) const {
  const auto nodes = mesh.mesh->nodes(ElementId(element));
  const auto g = static_cast<std::size_t>(mesh.degree);
  const Vec2 &p0 = mesh.given(nodes[0]), &p1 = mesh.given(nodes[g]), &p2 = mesh.given(nodes.back());
  const ExactVec2 p = exact_step(centre_, p0), a = exact_step(centre_, p1) - p,
                  b = exact_step(centre_, p2) - p;
  const DoubleDouble det = cross(a, b);
  return {{cross(b, p) / det, cross(p, a) / det},
          {ExactVec2{{b.y() / det, -b.x() / det}}, ExactVec2{{-a.y() / det, a.x() / det}}}};
}

ExactPlace ThinRegion::exact_place_in(const Frame& frame) const {
  const ExactVec2 offset = exact_step(frame.centre, centre_);
  ExactPlace place;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2& g = frame.gradient[k + 1];
    place.gradient[k] = {{g.x(), g.y()}};
    place.at[k] = DoubleDouble(1.0 / 3.0) + place.gradient[k].x() * offset.x() +
                  place.gradient[k].y() * offset.y();
  }
  return place;
}

void ThinRegion::bring(const OverlayMesh& mesh, std::int32_t element, MappedElement& out) const {
  const std::vector<Vec2> given = given_element(mesh, element);
  out.map = round_map(given);
  out.control.clear();
  for (const Vec2& p : given) out.control.push_back(rounded(out.map.step(exact_step(centre_, p))));
  out.from_region = {rounded(out.map.step(map_.step_back(ExactVec2{{1.0, 0.0}}))),
                     rounded(out.map.step(map_.step_back(ExactVec2{{0.0, 1.0}})))};
}

void ThinRegion::bring(const OverlayMesh& mesh, std::int32_t element, BentElement& out) const {
  out.set(mesh.degree, given_element(mesh, element), centre_);
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
    largest = std::max(largest, std::abs(cross(step, in_plane(exact_step(a, b)))));
  }
  return largest / given_diameter(mesh, element);
}

}  // namespace bezel::detail
