// bezel view: pictures of meshes and fields.

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/view/draw.hpp"
#include "cli/arguments.hpp"
#include "cli/output.hpp"

namespace bezel::cli {
namespace {

struct ViewOptions {
  std::vector<std::string> files, fields;
  std::string out, range, component;
  DrawOptions draw;
  bool lines = true;
};

int component_of(const ViewOptions& options, const Field& field, const std::string& file) {
  if (options.component.empty()) return field.components() == 1 ? 0 : -1;
  if (options.component == "norm") return -1;
  const int component = std::stoi(options.component);
  if (component >= field.components()) {
    throw InputError(
        InputPlace{file, 0, {}, -1},
        fmt::format("field '{}' has {}, found --component {} (they count from 0)", field.name(),
                    counted(static_cast<std::size_t>(field.components()), "component"), component));
  }
  return component;
}

// Wide pictures are stacked, others stand side by side.
int columns_for(const std::vector<Panel>& panels) {
  Box2 box;
  for (const Panel& panel : panels) box.include(panel.layers[0].mesh->box());
  return box.hi[0] - box.lo[0] > 1.5 * (box.hi[1] - box.lo[1]) ? 1 : 0;
}

int run(const ViewOptions& options, const Context& context) {
  DrawOptions how = options.draw;
  if (!options.range.empty()) {
    const std::pair<double, double> range = parse_pair("--range", options.range);
    if (!(range.first < range.second))
      throw UsageError("--range: expected LO < HI, found '" + options.range + "'");
    how.lo = range.first;
    how.hi = range.second;
  }
  require_writable(options.out);
  std::vector<Panel> panels;
  Json list = Json::array();
  for (const std::string& file : options.files) {
    const Dataset data = read_noting(context, file);
    std::vector<std::string> names = options.fields;
    if (names.empty() && !data.fields.empty()) names = {data.fields[0].name()};
    const std::string base = std::filesystem::path(file).filename().string();
    const auto add = [&](std::optional<Field> field, int component, const std::string& title) {
      Layer layer;
      layer.mesh = data.mesh;
      layer.field = std::move(field);
      layer.component = component;
      layer.mesh_lines = options.lines;
      Panel panel;
      panel.title = title;
      panel.layers.push_back(std::move(layer));
      panels.push_back(std::move(panel));
    };
    if (names.empty()) {
      add(std::nullopt, 0, base);
      list.push_back({{"file", file}, {"field", nullptr}, {"component", nullptr}});
    }
    for (const std::string& name : names) {
      try {
        const Field& field = data.field(name);
        const int component = component_of(options, field, file);
        add(field, component,
            base + ": " + field.name() +
                (field.components() == 1 ? ""
                 : component < 0         ? " (norm)"
                                         : fmt::format("[{}]", component)));
        list.push_back({{"file", file},
                        {"field", field.name()},
                        {"component", component < 0 ? Json("norm") : Json(component)}});
      } catch (const InputError& error) {
        throw error.in_file(file);
      }
    }
  }
  if (how.columns == 0) how.columns = columns_for(panels);
  draw(options.out, panels, how);
  if (context.json)
    print_or_remove(
        to_text(Json{{"schema", "bezel/view/1"}, {"output", options.out}, {"panels", list}}),
        {options.out});
  return ok;
}

}  // namespace

void add_view(CLI::App& app, Context& context) {
  auto options = std::make_shared<ViewOptions>();
  ViewOptions& o = *options;
  CLI::App* command =
      add_command(app, context, "view", "Draw meshes and fields to an SVG or PNG file",
                  "bezel view donor.msh moved.vtu -f u -o u.png", options, run);
  command->add_option("FILE", o.files, "Files to draw, one panel each")->required();
  command->add_option("-o,--output", o.out, "Picture to write: .svg or .png")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-f,--field", o.fields,
                   "Field to colour by; may be repeated (default: the first)")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command
      ->add_option("--component", o.component,
                   "Component, from 0, or norm (default: norm of a vector field)")
      ->check(CLI::IsMember({"norm", "0", "1", "2", "3", "4", "5", "6", "7", "8"}))
      ->type_name("C");
  command->add_option("--colormap", o.draw.colour_map, "viridis, cividis, coolwarm or grey")
      ->check(CLI::IsMember({"viridis", "cividis", "coolwarm", "grey"}))
      ->type_name("MAP")
      ->capture_default_str();
  command
      ->add_option("--range", o.range,
                   "Values of the first and last colour (default: the fields' range)")
      ->type_name("LO,HI");
  command->add_option("--width", o.draw.width, "Width in pixels")
      ->check(CLI::Range(16, 20000))
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_option("--columns", o.draw.columns, "Panels per row (default: by their shape)")
      ->check(CLI::Range(1, 100))
      ->type_name("N");
  command->add_flag("--same-scale", o.draw.same_scale,
                    "A length is equally long in all panels (default: each fills its place)");
  command->add_flag("--lines,!--no-lines", o.lines, "Draw the mesh lines, or not (default: drawn)");
}

}  // namespace bezel::cli
