#pragma once
// Straight meshes of the region that curves bound.

#include <cstdint>
#include <span>
#include <string>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel {

struct CurveDomainOptions {
  double size = 0.25;  ///< target edge length, > 0, length units
  double turn =
      0.5;  ///< most by which a boundary edge's direction turns along it, radians, 0.05..1
  std::uint64_t seed = 1;
};

/// Triangles that fill the region between closed chains of curves, their vertices on the boundary
/// exactly on the curves: what `curve_mesh` bends.
///
/// Curves are chained where their ends meet, in any order and direction. A chain inside an odd
/// number of others bounds a hole. Boundary edges are about `size` long, shorter where the curve
/// turns (edges next to each other differ by a third of their length at most); curves have a
/// vertex at each of up to 16 breakpoints. Tags as those of the generators: entity k + 1 and a
/// group for curve k, named `names[k]` or "curve k".
///
/// @param names  none, or one per curve
/// @throws   InputError for a bad option, ends that do not meet (how far apart), chains that touch
///           or cross each other or themselves as polygons, and a size that would give more than
///           1e5 triangles or boundary edges, or 1e8 pairs of them
/// @cost     1e4 triangles with 500 boundary edges: 0.2 s
/// @limits   one size inside: elements next to short boundary edges are long
TriangleMesh mesh_curve_domain(std::span<const SmoothCurve<2>> curves,
                               const CurveDomainOptions& options = {},
                               std::span<const std::string> names = {});

}  // namespace bezel
