#pragma once
// Internal: T n D of thin elements, computed from the coordinates as they were given.
//
// No plane makes two elements round that are thin in different directions, and points rounded in
// the plane of one are off by a large part of the other's width. Control points are exact numbers,
// though. So the pieces of edges around a region are cut and moved in double-double arithmetic, and
// rounded once, from a centre in the region, in a plane where the thinner element is round.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/transfer/bent_element.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {

/// Diameter over width from which an element is thin: so many roundings are lost in it.
inline constexpr double flat = 256.0;

/// Whether an element is thin in the plane of the mesh.
inline bool is_flat(const OverlayMesh& mesh, std::int32_t e) {
  const auto i = static_cast<std::size_t>(e);
  const double diameter = mesh.element_diameter[i];
  return diameter * diameter > flat * 2.0 * mesh.element_area[i];
}
/// ... and in the plane that the mesh came from.
bool is_flat_as_given(const OverlayMesh& mesh, std::int32_t e);
/// ... and in any plane, for it is bent by more than its width.
bool is_bent(const OverlayMesh& mesh, std::int32_t e);
std::vector<Vec2> given_element(const OverlayMesh& mesh, std::int32_t e);
/// Its area over the square of its diameter there.
double roundness(const OverlayMesh& mesh, std::int32_t e);
double given_diameter(const OverlayMesh& mesh, std::int32_t e);
double largest_given_coordinate(const OverlayMesh& mesh, std::int32_t e);

/// Two functions that are linear on the plane of a region: barycentrics 1 and 2.
struct LinearPlace {
  std::array<double, 2> at;  ///< at the centre
  std::array<Vec2, 2> gradient;

  std::array<double, 2> operator()(const Vec2& x) const {
    return {at[0] + dot(gradient[0], x), at[1] + dot(gradient[1], x)};
  }
};

/// The same of points as they were given, from the centre.
struct ExactPlace {
  std::array<DoubleDouble, 2> at;
  std::array<ExactVec2, 2> gradient;

  std::array<double, 2> operator()(const ExactVec2& x) const {
    return {static_cast<double>(at[0] + dot(gradient[0], x)),
            static_cast<double>(at[1] + dot(gradient[1], x))};
  }
};

/// A curved element in a plane of its own, where it is round.
struct MappedElement {
  std::array<Vec2, 2> from_region;  ///< images of the unit vectors of the region's plane
  AreaMap map;
  std::vector<Vec2> control;  ///< from the centre

  Vec2 moved(const Vec2& x) const { return from_region[0] * x.x() + from_region[1] * x.y(); }
};

/// The plane around a region, and what is brought there. Points there are taken from the centre.
class ThinRegion {
 public:
  ThinRegion(const OverlayMesh& donor, const OverlayMesh& target)
      : donor_(donor), target_(target) {}

  /// A centre in the region that the run bounds, in the plane where the thinner of both elements is
  /// round (d may be exterior), or the donor.
  void begin(std::int32_t t, std::int32_t d, std::span<const Segment> run, bool donors_plane);
  /// Appends the control points of a part of an edge.
  void append(const OverlayMesh& mesh, const Part& part, std::vector<Vec2>& out);
  /// Where points lie in a straight element, or in a frame.
  LinearPlace place_in(const OverlayMesh& mesh, std::int32_t element) const;
  LinearPlace place_in(const Frame& frame) const;
  /// The same from what exact_place_in() says.
  LinearPlace place(const ExactPlace& exact) const;
  void bring(const OverlayMesh& mesh, std::int32_t element, MappedElement& out) const;
  // The same without rounding, for regions of bent elements.
  void append(const OverlayMesh& mesh, const Part& part, std::vector<ExactVec2>& out);
  ExactPlace exact_place_in(const OverlayMesh& mesh, std::int32_t element) const;
  ExactPlace exact_place_in(const Frame& frame) const;
  void bring(const OverlayMesh& mesh, std::int32_t element, BentElement& out) const;
  /// A point, or a step, in the region's plane from the one as given, and back.
  Vec2 in_plane(const ExactVec2& p) const { return rounded(map_.step(p)); }
  ExactVec2 as_given_exactly(const Vec2& p) const {
    return map_.step_back(ExactVec2{{p.x(), p.y()}});
  }
  /// A step there as it was given.
  Vec2 as_given(const Vec2& step) const;
  /// The largest area between a step and a side of an element, over the element's diameter.
  double joint_width(const OverlayMesh& mesh, std::int32_t element, const Vec2& step) const;

 private:
  static ExactVec2 mix(const ExactVec2& a, const ExactVec2& b, double s);
  /// The blossom of exact_ at i times `to` and `from` else.
  const ExactVec2& blossom(const Part& part, std::size_t i);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  Vec2 centre_;
  AreaMap map_;
  std::vector<Vec2> given_;
  std::vector<ExactVec2> exact_, blossom_;
};

}  // namespace bezel::detail
