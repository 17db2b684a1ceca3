#pragma once
// Meshes with boundaries that follow curves, for the command mesh.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bezel/fit/curve_domain.hpp"
#include "bezel/fit/curve_mesh.hpp"
#include "cli/output.hpp"

namespace bezel::cli {

struct MeshCurvesOptions {
  std::string mesh;                ///< a file with a straight mesh, or "curves": mesh their inside
  std::vector<std::string> files;  ///< with curves
  std::string method = "best";     ///< or another method, or equal-parameter
  CurveDomainOptions domain;
  CurveMeshOptions curved;
};

inline const std::vector<std::string> edge_methods = {"best", "equal-tangent", "arclength",
                                                      "equal-parameter"};

/// @throws InputError with the file; NumericsError when an element could not be made valid
CurvedMesh mesh_with_curves(const MeshCurvesOptions& options, const Context& context);

/// What is said about it in JSON, besides what every mesh says.
Json curved_mesh_json(const CurvedMesh& mesh, const std::string& method);

}  // namespace bezel::cli
