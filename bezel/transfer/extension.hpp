#pragma once
// Internal: which donor's polynomial fills a part of a target element that no donor covers, and
// where it is evaluated.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/group.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {

/// How the fields were continued into what no donor covers.
struct ExtensionReport {
  double max_growth = 0;  ///< largest (sum of |barycentrics|)^degree; 0: nothing was continued
  double moved_area = 0;  ///< filled by a donor that is not the nearest
  double held_area = 0;   ///< where the polynomial was kept at its value nearer to the donor
  /// Of several fields on one target element.
  void widen(const ExtensionReport& other);
  /// Of several target elements.
  void add(const ExtensionReport& other);
};

/// Boxes and distances that decide are widened by this part of themselves.
inline constexpr double widening = 1e-6;
/// A box widened by that, by the rounding of its coordinates, and by a distance.
Box2 widened(const Box2& box, double by);
/// Distance of p from the nearest corner of some elements.
double nearest_corner(const OverlayMesh& mesh, std::span<const std::int32_t> elements,
                      const Vec2& p);

/// The donors that may meet a target element or continue a field to it: those whose boxes are no
/// farther from its box than some donor corner is from the box's farthest point. The same on a part
/// of the donor that holds them.
/// @param out  ascending
/// @return  how many donors' boxes meet the box itself
std::size_t donors_in_reach(const OverlayMesh& donor, const FrontSearch& search, const Box2& box,
                            std::vector<std::int32_t>& out);

/// Continues the donors' polynomials into one gap.
///
/// In barycentrics lambda of its donor a polynomial of degree p may be (sum of |lambda|)^p times
/// its largest coefficient, and so may what rounding and approximation left in the coefficients.
/// The nearest donor serves where this growth is small; else the one in reach that grows least, if
/// it grows much less; and where that is too far still, the value is taken from where the growth is
/// small, on the way from the donor to the point.
class Extension {
 public:
  /// @param run     the boundary of the gap
  /// @param centre  a point in its middle
  Extension(const Group& g, const OverlayMesh& donor, const OverlayMesh& target,
            const FrontSearch& search, std::int32_t t, std::span<const Segment> run,
            const Vec2& centre);

  struct Source {
    std::int32_t donor;
    std::array<double, 2> place;  ///< barycentrics 1 and 2 where its polynomial is evaluated
  };
  /// What point x of the gap gets; `weight`: the area that it stands for.
  Source at(const Vec2& x, double weight);

  const ExtensionReport& report() const { return report_; }

 private:
  /// A donor's triangle through its corners.
  struct Candidate {
    std::int32_t donor;
    int degree;
    bool flat;  // the corners are no measure of the element
    Frame frame;
    std::array<Vec2, 3> corners;
  };
  struct Neighbour {
    Candidate donor;
    Vec2 a, b;  // the part of its edge along the gap
  };
  struct Try {
    std::array<double, 2> place;
    double growth;
    bool far;   // the polynomial is not continued so far
    bool held;  // the map could not be inverted: the place is nearer to the donor
  };
  Candidate candidate(std::int32_t d) const;
  const Candidate& nearest(const Vec2& x) const;
  Try attempt(const Candidate& c, const Vec2& x) const;
  /// The place on the way from the donor to x where its growth is small.
  Try hold(const Candidate& c, const Vec2& x) const;
  void find_others();

  const Group& g_;
  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  std::int32_t t_;
  Vec2 centre_;
  std::vector<Neighbour> neighbours_;  // along the gap
  std::vector<Candidate> others_;      // once asked for
  bool have_others_ = false;
  ExtensionReport report_;
};

}  // namespace bezel::detail
