#pragma once
// Elements of a mesh that overlap.

#include <cstddef>
#include <string>
#include <vector>

#include "bezel/base/progress.hpp"
#include "bezel/numeric/vec.hpp"
#include "cli/validity.hpp"

namespace bezel::cli {

struct ElementOverlap {
  std::size_t first, second;  ///< first < second
  bool decided;
  double area;         ///< of the common part
  Vec2 place;          ///< a corner of it, or the middle of where it could not be decided
  std::string reason;  ///< when not decided
};

/// Pairs of valid elements with a common area above 1e-10 of the smaller one: hanging vertices, and
/// sides written with fewer digits, make slivers below that. Sorted; at most 10 for each first
/// element, so that the work is bounded. @throws Interrupted
std::vector<ElementOverlap> find_overlaps(const TriangleMesh& mesh, const MeshValidity& validity,
                                          int threads, const Progress& progress);

}  // namespace bezel::cli
