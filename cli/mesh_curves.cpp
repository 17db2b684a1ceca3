#include "cli/mesh_curves.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "cli/curve_spec.hpp"
#include "cli/json_text.hpp"

namespace bezel::cli {
namespace {

struct NamedCurves {
  std::vector<SmoothCurve<2>> curves;
  std::vector<std::string> names;
};

NamedCurves read_curves(const std::vector<std::string>& files, const Context& context) {
  NamedCurves out;
  for (const std::string& file : files) {
    const InputText text = read_input_text(file);
    CurveSpecs specs = read_curve_specs(text.name, text.text);
    if (specs.rounded > 0)
      note(context, fmt::format("{}: {} rounded to the nearest double", text.name,
                                counted(specs.rounded, "rational number")));
    for (CurveSpec& spec : specs.curves) {
      if (!spec.plane)
        throw InputError(InputPlace{text.name, 0, spec.name, -1},
                         "found a curve in space, expected one in the plane");
      const bool named = spec.name != spec.place;
      out.names.push_back(named ? spec.name : fmt::format("curve {}", out.curves.size()));
      out.curves.push_back(*spec.plane);
    }
  }
  return out;
}

}  // namespace

CurvedMesh mesh_with_curves(const MeshCurvesOptions& options, const Context& context) {
  CurveMeshOptions how = options.curved;
  how.equal_parameter = options.method == "equal-parameter";
  how.method = options.method == "equal-tangent" ? CurveMethod::equal_tangent
               : options.method == "arclength"   ? CurveMethod::arc_length
                                                 : CurveMethod::best;
  const NamedCurves input = read_curves(options.files, context);
  const auto work = [&](const TriangleMesh& straight) {
    return curve_mesh(straight, input.curves, how);
  };
  CurvedMesh found = [&] {
    if (options.mesh == "curves")
      return work(mesh_curve_domain(input.curves, options.domain, input.names));
    const Dataset data = read_noting(context, options.mesh);
    try {
      return work(*data.mesh);
    } catch (const InputError& error) {
      throw InputError(InputPlace{options.mesh, 0, {}, -1}, error.message());
    }
  }();
  if (!found.invalid.empty()) {
    const ElementId first = found.invalid[0];
    const Vec2 place = found.mesh.box(first).centre();
    throw NumericsError(
        fmt::format("{} could not be made valid, the first is number {} near ({:.6g}, {:.6g}): "
                    "shorter edges along the curves may help",
                    counted(found.invalid.size(), "element"), first.value, place.x(), place.y()));
  }
  return found;
}

Json curved_mesh_json(const CurvedMesh& mesh, const std::string& method) {
  return {{"method", method},
          {"curved_edges", mesh.edges.size()},
          {"straight_edges", mesh.straight_edges},
          {"distance_max", mesh.distance_max},
          {"distance_l2", mesh.distance_l2},
          {"largest_move", mesh.largest_move},
          {"relaxation_steps", mesh.relaxation_steps}};
}

}  // namespace bezel::cli
