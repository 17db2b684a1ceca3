#pragma once
// Gordon-Hall maps for tests.

#include <cmath>
#include <functional>
#include <vector>

#include "bezel/fit/gordon_hall.hpp"

namespace bezel::test {

/// Values of a curve on [-1, 1] at the Gauss-Lobatto points.
inline std::vector<Vec2> side(int degree, const std::function<Vec2(double)>& curve) {
  std::vector<Vec2> out;
  const LobattoBasis basis(degree);
  for (const double xi : basis.nodes()) out.push_back(curve(xi));
  return out;
}

inline std::vector<Vec2> segment(int degree, const Vec2& a, const Vec2& b) {
  std::vector<Vec2> out =
      side(degree, [&](double xi) { return 0.5 * (1.0 - xi) * a + 0.5 * (1.0 + xi) * b; });
  out.front() = a;
  out.back() = b;
  return out;
}

/// The quadrilateral with straight sides and these corners, counter-clockwise.
inline GordonHall straight_map(int degree, const Vec2& a, const Vec2& b, const Vec2& c,
                               const Vec2& d) {
  return GordonHall(
      {segment(degree, a, b), segment(degree, b, c), segment(degree, d, c), segment(degree, a, d)});
}

/// The part of the ring between the circles of radius 1 and 2, from angle a to b: the angle along
/// xi, the radius along eta (from the outer to the inner circle, so that it is counter-clockwise).
inline GordonHall ring_map(int degree, double a, double b) {
  const auto arc = [&](double radius) {
    return side(degree, [=](double xi) {
      const double angle = 0.5 * (1.0 - xi) * a + 0.5 * (1.0 + xi) * b;
      return radius * Vec2{std::cos(angle), std::sin(angle)};
    });
  };
  const std::vector<Vec2> outer = arc(2.0), inner = arc(1.0);
  return GordonHall({outer, segment(degree, outer.back(), inner.back()), inner,
                     segment(degree, outer.front(), inner.front())});
}

}  // namespace bezel::test
