#pragma once
// The validity of every element of a mesh.

#include <vector>

#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel::cli {

struct MeshValidity {
  std::vector<ValidityResult> elements;
  std::size_t valid = 0;
  std::vector<std::size_t> inverted, undecided;  ///< element numbers
};
MeshValidity check_elements(const TriangleMesh& mesh, int threads);

}  // namespace bezel::cli
