// bezel mesh: meshes of simple shapes, and meshes that follow curves.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/mesh/generate.hpp"
#include "cli/arguments.hpp"
#include "cli/mesh_curves.hpp"
#include "cli/output.hpp"

namespace bezel::cli {
namespace {

struct MeshOptions {
  std::string shape, out, pattern = "unstructured", centre = "0,0";
  GenerateOptions generate;
  std::optional<double> width, height, radius, inner_radius;
  int refine = 0;
  MeshCurvesOptions curves;
  std::optional<Format> format;
};

// The same as the generators' limit.
constexpr double most_elements = 5e7;

// Each shape takes only the lengths that describe it.
void refuse(const std::optional<double>& value, const char* option, const std::string& shape) {
  if (value) throw UsageError(std::string(option) + " does not apply to a " + shape);
}

TriangleMesh generate(const MeshOptions& o, const GenerateOptions& g) {
  if (o.shape == "square" || o.shape == "lshape") {
    refuse(o.height, "--height", o.shape);
    refuse(o.radius, "--radius", o.shape);
    refuse(o.inner_radius, "--inner-radius", o.shape);
    const double width = o.width.value_or(2);
    return o.shape == "square" ? generate_rectangle(width, width, g) : generate_lshape(width, g);
  }
  if (o.shape == "rectangle") {
    refuse(o.radius, "--radius", o.shape);
    refuse(o.inner_radius, "--inner-radius", o.shape);
    return generate_rectangle(o.width.value_or(2), o.height.value_or(1), g);
  }
  refuse(o.width, "--width", o.shape);
  refuse(o.height, "--height", o.shape);
  if (o.shape == "annulus")
    return generate_annulus(o.inner_radius.value_or(0.5), o.radius.value_or(1), g);
  refuse(o.inner_radius, "--inner-radius", o.shape);
  return generate_disc(o.radius.value_or(1), g);
}

const std::vector<std::string> shapes = {"square", "rectangle", "disc", "annulus", "lshape"};

/// A shape, refined.
TriangleMesh generated(const MeshOptions& options, const GenerateOptions& g) {
  if (std::find(shapes.begin(), shapes.end(), options.shape) == shapes.end())
    throw UsageError(
        fmt::format("SHAPE: {} not in {{square,rectangle,disc,annulus,lshape}}", options.shape));
  TriangleMesh mesh = generate(options, g);
  const double refined = std::ldexp(static_cast<double>(mesh.element_count()), 2 * options.refine);
  if (refined > most_elements) {
    throw InputError(fmt::format("--refine {} would give {:.3g} triangles, expected at most {:.0e}",
                                 options.refine, refined, most_elements));
  }
  for (int level = 0; level < options.refine; ++level) mesh = refine_uniform(mesh);
  return mesh;
}

CurvedMesh with_curves(const MeshOptions& options, const GenerateOptions& g,
                       const Context& context) {
  if (std::find(shapes.begin(), shapes.end(), options.shape) != shapes.end())
    throw UsageError("--curve: expected 'curves' or a file with a straight mesh, found '" +
                     options.shape + "'");
  for (const auto& [value, option] : {std::pair{&options.width, "--width"},
                                      {&options.height, "--height"},
                                      {&options.radius, "--radius"},
                                      {&options.inner_radius, "--inner-radius"}})
    refuse(*value, option, "mesh with curves");
  if (options.refine > 0) throw UsageError("--refine does not apply to a mesh with curves");
  MeshCurvesOptions how = options.curves;
  how.mesh = options.shape;
  how.domain.size = g.size;
  how.domain.seed = g.seed;
  how.curved.degree = g.degree;
  return mesh_with_curves(how, context);
}

int run(const MeshOptions& options, const Context& context) {
  GenerateOptions g = options.generate;
  g.seed = context.seed;
  g.pattern = options.pattern == "structured" ? Pattern::structured : Pattern::unstructured;
  const std::pair<double, double> centre = parse_pair("--center", options.centre);
  g.centre = Vec2{{centre.first, centre.second}};
  WriteOptions how;
  how.format = options.format ? options.format : format_of(options.out);
  require_writable(options.out);

  std::optional<Json> curved;
  TriangleMesh mesh = [&] {
    if (options.curves.files.empty()) return generated(options, g);
    CurvedMesh found = with_curves(options, g, context);
    curved = curved_mesh_json(found, options.curves.method);
    return std::move(found.mesh);
  }();
  Dataset data;
  data.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  const std::vector<std::string> lost = write(options.out, data, how);
  notes(context, options.out, lost);
  if (context.json) {
    Json object{{"schema", "bezel/mesh/1"},
                {"output", options.out},
                {"shape", options.shape},
                {"seed", context.seed},
                {"geometric_degree", data.mesh->degree()},
                {"vertices", data.mesh->vertex_count()},
                {"elements", data.mesh->element_count()},
                {"lost", lost}};
    if (curved) object.update(*curved);
    print_or_remove(to_text(object), {options.out});
  }
  return ok;
}

}  // namespace

void add_mesh(CLI::App& app, Context& context) {
  auto options = std::make_shared<MeshOptions>();
  MeshOptions& o = *options;
  CLI::App* command =
      add_command(app, context, "mesh", "Mesh a simple shape",
                  "bezel mesh disc --radius 1 --degree 3 --size 0.3 -o disc.msh", options, run);
  command
      ->add_option("SHAPE", o.shape,
                   "square, rectangle, disc, annulus or lshape; with --curve: 'curves' for the "
                   "region they bound, or a file with a straight mesh")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", o.out, "File to write")->required()->type_name("FILE");
  command->add_option("--degree", o.generate.degree, "Geometric degree, 1 to 10")
      ->check(CLI::Range(1, 10))
      ->type_name("G")
      ->capture_default_str();
  command->add_option("--size", o.generate.size, "Target edge length")
      ->type_name("H")
      ->capture_default_str();
  command->add_option("--refine", o.refine, "Split every triangle into four, N times")
      ->check(CLI::Range(0, 12))
      ->type_name("N");
  command->add_option("--pattern", o.pattern, "structured or unstructured (random, by --seed)")
      ->check(CLI::IsMember({"structured", "unstructured"}))
      ->type_name("PATTERN")
      ->capture_default_str();
  command->add_option("--width", o.width, "Width of a square, rectangle or lshape (default 2)")
      ->type_name("W");
  command->add_option("--height", o.height, "Height of a rectangle (default 1)")->type_name("H");
  command->add_option("--radius", o.radius, "Radius of a disc or annulus (default 1)")
      ->type_name("R");
  command->add_option("--inner-radius", o.inner_radius, "Inner radius of an annulus (default 0.5)")
      ->type_name("R");
  command->add_option("--center", o.centre, "Centre of the shape")
      ->type_name("X,Y")
      ->capture_default_str();
  CLI::Option* curve =
      command
          ->add_option("--curve", o.curves.files,
                       "JSON file with curves that boundary edges follow; may be repeated")
          ->allow_extra_args(false)
          ->type_name("FILE");
  command->add_option("--method", o.curves.method, "How edges interpolate their curves")
      ->needs(curve)
      ->check(CLI::IsMember(edge_methods))
      ->type_name("METHOD")
      ->capture_default_str();
  command
      ->add_option("--turn", o.curves.domain.turn,
                   "Most by which a curve may turn along one edge, in radians ('curves')")
      ->needs(curve)
      ->type_name("ANGLE")
      ->capture_default_str();
  command
      ->add_option("--curve-tolerance", o.curves.curved.tolerance,
                   "How far vertices of a file may be from their curves, as a part of the diagonal")
      ->needs(curve)
      ->type_name("PART")
      ->capture_default_str();
  add_format_option(*command, o.format, "--format", "Format; default: by the extension");
}

}  // namespace bezel::cli
