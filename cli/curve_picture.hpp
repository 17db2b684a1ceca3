#pragma once
// Pictures of curves and their interpolants.

#include <vector>

#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/view/draw_curves.hpp"

namespace bezel::cli {

/// Adds a curve, its pieces, their nodes, and the error: points p(xi) pushed away from the curve by
/// their distance times a power of ten, which stands in the legend, so that it can be seen.
/// @param alone  false: only the interpolant, under the curve's name, and its nodes
void draw_interpolants(CurvePicture& picture, const std::string& name, const SmoothCurve<2>& curve,
                       const std::vector<CurvePiece<2>>& pieces, bool alone);

/// The curve as cubic pieces through its points, for drawing.
std::vector<std::vector<Vec2>> drawn_curve(const SmoothCurve<2>& curve);

/// The shadow on the plane z = 0.
SmoothCurve<2> projected(const SmoothCurve<3>& curve);

}  // namespace bezel::cli
