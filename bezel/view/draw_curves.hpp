#pragma once
// Pictures of Bezier curves, of curved polygons, and of the points they share: SVG and PNG.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curved_polygon.hpp"
#include "bezel/geometry/self_intersection.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// Curves with one name and colour: a single curve, or the sides of a triangle.
struct DrawnShape {
  std::string name;                       ///< in the legend; empty: not there
  std::vector<std::vector<Vec2>> curves;  ///< control points, 1 to 61 each
  bool filled = false;                    ///< with a tint; the curves form a closed chain then
};

/// The inside of a closed chain of curves, filled; further chains in the opposite direction are
/// holes.
struct DrawnRegion {
  std::vector<std::vector<Vec2>> curves;
  std::vector<std::size_t> further{};  ///< where in `curves` a further chain begins, ascending
};

/// A part of a curve, drawn as a broad band.
struct DrawnBand {
  std::vector<Vec2> curve;
  std::string label;
};

enum class MarkKind : std::uint8_t { crossing, tangency, cusp, vertex, unresolved };
struct DrawnMark {
  MarkKind kind;
  Vec2 point;
  std::string label;
};

struct CurvePicture {
  std::vector<DrawnShape> shapes;
  std::vector<DrawnRegion> regions;
  std::vector<DrawnBand> bands;
  std::vector<DrawnMark> marks;
  std::string region_name;             ///< of the regions in the legend; empty: not there
  std::string vertex_name = "vertex";  ///< of marks of that kind in the legend
};

struct CurveDrawOptions {
  int width = 800;               ///< pixels, 64 to 16384; the height follows
  bool control_polygons = true;  ///< of the shapes
};

/// Draws curves, regions and marks with axes and a legend to a .svg or .png file (by extension),
/// atomically. Both axes have one scale. What is shown are the curves; control polygons that reach
/// far beyond them are cut at the frame. Labels keep off lines, marks and each other where there is
/// room; marks of one kind at one place share a marker; more than 400 marks are small and have no
/// labels.
///
/// @throws InputError for an unknown extension or a bad width, nothing to draw, control points that
///         are not 1 to 61 finite ones, and coordinates beyond 1e280, or spread over less than
///         1e-280
void draw_curves(const std::string& path, const CurvePicture& picture,
                 const CurveDrawOptions& options = {});

/// Adds what curve a shares with another: marks and bands, with labels counted on from `first`, in
/// the order crossings, tangencies, overlaps, unresolved.
/// @return the number after the last
int add_intersections(CurvePicture& picture, const std::vector<Vec2>& a,
                      const CurveIntersections& found, int first = 1);

/// Adds the cusps of a curve and where it meets itself, in this order, as add_intersections.
int add_self_intersections(CurvePicture& picture, const std::vector<Vec2>& curve,
                           const SelfIntersections& found, int first = 1);

/// The three sides of a curved triangle, filled. @param control  triangle_size(g) points, 1 <= g
DrawnShape drawn_triangle(std::string name, int g, std::span<const Vec2> control);

/// Adds curved polygons as regions, and their vertices as marks, with labels counted on from
/// `first`, polygon by polygon in the order of their edges.
/// @return the number after the last
int add_polygons(CurvePicture& picture, std::span<const CurvedPolygon> polygons, int first = 1);

/// Adds the loops around a region and its holes (`difference`) as one region, otherwise as
/// add_polygons.
int add_loops(CurvePicture& picture, std::span<const CurvedPolygon> loops, int first = 1);

}  // namespace bezel
