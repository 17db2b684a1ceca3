#include "bezel/view/marker.hpp"

#include <cmath>
#include <numbers>

namespace bezel::view {

void add_marker(Path& path, Shape shape, const Vec2& p, double radius) {
  if (shape == Shape::circle) {
    path.circle(p, radius);
    return;
  }
  // Regular polygons of about the circle's area.
  const int sides = shape == Shape::square || shape == Shape::diamond ? 4 : 3;
  const double turn = shape == Shape::square     ? 0.25
                      : shape == Shape::diamond  ? 0.0
                      : shape == Shape::triangle ? -0.25
                                                 : 0.25;
  const double r = radius * (sides == 4 ? 1.2 : 1.35);
  for (int k = 0; k < sides; ++k) {
    const double angle =
        (shape == Shape::square ? std::numbers::pi / 4 : 2 * std::numbers::pi * turn) +
        2 * std::numbers::pi * k / sides;
    const Vec2 corner = p + r * Vec2{{std::cos(angle), std::sin(angle)}};
    if (k == 0) {
      path.move(corner);
    } else {
      path.line(corner);
    }
  }
  path.close();
}

}  // namespace bezel::view
