#pragma once
// Straight-sided triangulations with a labelled boundary: what the generators build before curving.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/mesh/mesh.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::planar {

/// A piece of the boundary: straight, or (radius > 0) an arc of a circle.
struct Curve {
  std::string name;
  Vec2 centre{};
  double radius = 0;
};

/// A boundary edge from point a to point b with the domain on its left.
struct Segment {
  int a = 0, b = 0;
  int curve = 0;  ///< position in Triangulation::curves
};

struct Triangulation {
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
  std::vector<Segment> segments;              ///< the whole boundary
  std::vector<Curve> curves;
};

/// Where interior points may lie and which triangles of the convex hull belong to the domain.
struct Domain {
  double area = 0;
  double size = 0;               ///< target edge length
  double margin = 0;             ///< least distance of a sampled point from the boundary
  std::size_t least_points = 0;  ///< inside
  std::function<bool(const Vec2&, double margin)> inside;
  std::function<bool(const std::array<int, 3>&)> keep;  ///< of a triangle's corners
};

/// Fills the domain bounded by t.points and t.segments with random points that keep their distance,
/// triangulates (Delaunay), and moves the inner points until the triangles are well shaped.
/// @return false when the boundary is not part of the triangulation (the points are too sparse)
bool fill(Triangulation& t, const Domain& domain, RandomStream& random);

/// Delaunay flips inside the boundary, then `sweeps` times: every inner point towards the mean of
/// its neighbours where that keeps the worst triangle around it, and flips again. Points below
/// `fixed` stay. @return false when the triangles do not form a surface bounded by t.segments
bool smooth(Triangulation& t, std::size_t fixed, int sweeps);

/// The curved mesh of degree g: arcs are interpolated at Gauss-Lobatto points, inner edges get
/// random bulges of up to `jitter` times their length, halved until every element is valid.
/// @return nothing when an element is invalid without bulges
std::optional<TriangleMesh> curve(const Triangulation& t, int degree, double jitter,
                                  RandomStream& random);

}  // namespace bezel::planar
