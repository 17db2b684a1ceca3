#pragma once
// Mesh generators and uniform refinement.

#include <cstdint>
#include <memory>

#include "bezel/mesh/mesh.hpp"

namespace bezel {

enum class Pattern {
  structured,   ///< a regular pattern
  unstructured  ///< random interior points (seeded), Delaunay by Qhull, a few smoothing sweeps
};

struct GenerateOptions {
  int degree = 1;  ///< geometric degree 1..10; curved boundaries are interpolated at that degree
  double size = 0.25;  ///< target edge length, > 0, length units
  Pattern pattern = Pattern::unstructured;
  std::uint64_t seed = 1;
  Vec2 centre{};  ///< centre of the shape
};

/// Every generator tags the surface (entity 1, group "domain") and its boundary curves (groups
/// "left", "right", "bottom", "top" for rectangles; "boundary" for the disc; "inner", "outer" for
/// the annulus; "boundary" for the L-shape), returns elements all valid (checked), and is
/// deterministic in (options, seed).
/// @throws InputError for lengths that are not positive and finite, or a size that would give more
/// than 5e7 elements
TriangleMesh generate_rectangle(double width, double height, const GenerateOptions& options);
TriangleMesh generate_disc(double radius, const GenerateOptions& options);
TriangleMesh generate_annulus(double inner_radius, double outer_radius,
                              const GenerateOptions& options);
/// The square of the given width without its lower right quarter.
TriangleMesh generate_lshape(double width, const GenerateOptions& options);

/// Every element split into four at the midpoints of the reference triangle: the same geometry
/// exactly (up to rounding), tags inherited. Element e becomes 4e..4e+3 in the order of
/// bernstein::subdivide.
TriangleMesh refine_uniform(const TriangleMesh& mesh);

}  // namespace bezel
