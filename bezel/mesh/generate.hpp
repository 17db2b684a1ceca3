#pragma once
// Mesh generators and uniform refinement.

#include <cstdint>
#include <memory>

#include "bezel/mesh/mesh.hpp"

namespace bezel {

enum class Pattern {
  structured,   ///< a regular pattern
  unstructured  ///< random interior points (seeded), Delaunay, then smoothing sweeps
};

struct GenerateOptions {
  int degree = 1;  ///< geometric degree 1..10; curved boundaries are interpolated at that degree
  double size = 0.25;  ///< target edge length, > 0, length units
  Pattern pattern = Pattern::unstructured;
  std::uint64_t seed = 1;
  Vec2 centre{};  ///< centre of the shape
  /// Inner edges of degree >= 2 get random bulges of up to this fraction of their length, 0..0.5,
  /// halved where an element would be invalid. The boundary stays as it is.
  double curve_jitter = 0;
};

/// A rectangle of triangles.
///
/// Every generator tags the surface (entity 1, group "domain") and its boundary curves: entities
/// 1, 2, …, one group each, named "bottom", "right", "top", "left" for the rectangle; "boundary"
/// for the disc and the L-shape; "outer", "inner" for the annulus. Tagged edges run with the domain
/// on their left. Every element is proven valid (check_validity). The mesh depends on the arguments
/// alone. Edges are about `size` long, shorter where a shape needs it (a disc has 6 boundary edges
/// at least, a circle of an annulus 8, more where the annulus is thin).
///
/// @throws   InputError for a length outside 1e-100..1e100 or below 1e-12 of the centre's
///           coordinates, a degree outside 1..10, a jitter outside 0..0.5, or a size that would
///           give more than 5e7 elements or 2e9 nodes
/// @accuracy the boundary interpolates arcs at Gauss-Lobatto points equally distributed in angle:
///           degree g is off by O(size^(g+1)), the area by O(size^(2g)); straight boundaries are
///           exact
/// @cost     measured 0.4 s for 1e5 unstructured linear triangles, 0.04 s for structured ones
/// @limits   one size everywhere: a small hole in a large annulus has short edges next to long ones
/// @source   [lenoir1986] for what inner control points must satisfy; [feder1980] for the sampling
TriangleMesh generate_rectangle(double width, double height, const GenerateOptions& options);
TriangleMesh generate_disc(double radius, const GenerateOptions& options);
/// @throws InputError also unless inner_radius < outer_radius, by at least 1e-9 of outer_radius
TriangleMesh generate_annulus(double inner_radius, double outer_radius,
                              const GenerateOptions& options);
/// The square of the given width without its lower right quarter.
TriangleMesh generate_lshape(double width, const GenerateOptions& options);

/// Every element split into four at the midpoints of the reference triangle: the same geometry up
/// to rounding, tags inherited.
///
/// Element e becomes 4e..4e+3 in the order of bernstein::subdivide: one at each corner, then the
/// middle one with corners on sides 1, 2, 0. New control points of an edge are computed once, in
/// canonical direction, so neighbours stay joined bit for bit. A tagged edge becomes its two
/// halves; nodes that are neither corners nor tagged points are not kept.
///
/// @throws   InputError when the mesh would have more than 2^31 - 1 nodes or edges
/// @accuracy each control point within (degree + 4) u max|b| of the exact one
/// @cost     one sparse product of dyadic weights per element; measured 0.15 s for 1e5 quadratic
/// elements
TriangleMesh refine_uniform(const TriangleMesh& mesh);

}  // namespace bezel
