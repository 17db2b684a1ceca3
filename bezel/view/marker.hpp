#pragma once
// Markers and colours that plots and drawings of curves share.

#include <array>

#include "bezel/view/canvas.hpp"

namespace bezel::view {

inline constexpr Colour ink{0.13, 0.13, 0.13, 1.0};
inline constexpr Colour major_grid{0.80, 0.80, 0.80, 1.0}, minor_grid{0.92, 0.92, 0.92, 1.0};
/// The palette of M. Okabe and K. Ito, distinguishable with every kind of colour vision, without
/// its yellow; black last.
inline constexpr std::array<const char*, 7> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                    "#e69f00", "#56b4e9", "#000000"};

enum class Shape { circle, square, triangle, diamond, down };

/// Appends a closed marker, a regular polygon of about the circle's area; radius in pixels.
void add_marker(Path& path, Shape shape, const Vec2& p, double radius);

}  // namespace bezel::view
