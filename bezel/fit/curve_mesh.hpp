#pragma once
// Straight meshes whose boundary becomes curved.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel {

struct CurveMeshOptions {
  int degree = 2;                          ///< geometric degree of the new mesh, 1..10
  CurveMethod method = CurveMethod::best;  ///< how edges interpolate their part of a curve
  /// Instead of `method`: nodes at equal steps of the curve's parameter, one control point lattice
  /// later, as mesh generators place them.
  bool equal_parameter = false;
  /// How far a vertex may be from its curve, as a part of the mesh's diagonal; it is moved onto it.
  double tolerance = 1e-6;
};

/// A boundary edge that lies on a curve.
struct FittedEdge {
  EdgeId edge;         ///< of the new mesh
  std::size_t curve;   ///< position among the curves
  double t0, t1;       ///< parameters of the curve at the ends, t0 < t1 unless through its seam
  CurveErrors errors;  ///< of this edge
};

struct CurvedMesh {
  TriangleMesh mesh;
  std::vector<FittedEdge> edges;
  std::size_t straight_edges = 0;  ///< boundary edges on none of the curves: left straight
  double largest_move = 0.0;       ///< of a vertex onto its curve
  double distance_max = 0.0;       ///< largest distance of an edge to its curve
  double distance_l2 = 0.0;        ///< L2 norm of the distance over all these edges
  int relaxation_steps = 0;  ///< 0: blending was enough; else in how many steps the boundary moved
  std::vector<ElementId> invalid;  ///< elements that could not be proven valid; empty as a rule
};

/// A straight mesh with its boundary edges bent onto curves.
///
/// A boundary edge belongs to a curve when both its vertices lie on it (within the tolerance) and
/// the arc between them is at most 4 times as long as the edge; of several, the shortest arc. A
/// part between neighbouring vertices is interpolated by one edge; corners belong at vertices.
///
/// Inner control points follow by the extension that keeps isoparametric order [lenoir1986]. Where
/// that leaves an element whose map cannot be proven one to one, all inner control points and
/// vertices move as an elastic body would whose small parts are stiff, in 1, 4 or 16 steps
/// (the isoparametric order inside is then not kept; the boundary is the same).
///
/// @param straight  degree 1
/// @param curves    at least one
/// @return   the mesh, with the straight mesh's tags, and what was reached; look at `invalid`
/// @throws   InputError for another degree, a tolerance outside (0, 0.1), no curve at all that an
///           edge lies on, curves that do not meet at a vertex both pass through (how far apart),
///           and where a method does not apply to an edge's part of a curve
/// @cost     some 0.1 ms per boundary edge; relaxation: 0.1 s per 1000 elements and step at degree
/// 3
/// @limits   two curves closer to each other than the tolerance are not told apart
CurvedMesh curve_mesh(const TriangleMesh& straight, std::span<const SmoothCurve<2>> curves,
                      const CurveMeshOptions& options = {});

}  // namespace bezel
