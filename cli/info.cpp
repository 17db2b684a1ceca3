// bezel info: what is in a file.

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/validity.hpp"

namespace bezel::cli {
namespace {

struct InfoOptions {
  std::string file;
  std::optional<Format> format;
};

// The box of the elements themselves (that of the control points may be larger): within 1e-6 of its
// size.
Box2 true_box(const TriangleMesh& mesh) {
  const Box2 outer = mesh.box();
  const double tol = 1e-6 * outer.diameter();
  Box2 box;
  std::vector<double> c(static_cast<std::size_t>(mesh.nodes_per_element()));
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (mesh.degree() == 1) {
      box.include(mesh.box(ElementId(e)));
      continue;
    }
    const auto nodes = mesh.nodes(ElementId(e));
    for (int axis = 0; axis < 2; ++axis) {
      for (std::size_t i = 0; i < c.size(); ++i) c[i] = mesh.control(nodes[i])[axis];
      const bernstein::Range range = bernstein::range(mesh.degree(), c, tol);
      box.lo[axis] = std::min(box.lo[axis], range.lo);
      box.hi[axis] = std::max(box.hi[axis], range.hi);
    }
  }
  return box;
}

double total_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    sum += area(mesh.degree(), mesh.gather(ElementId(e)));
  return sum;
}

struct FieldSummary {
  int lowest_degree, highest_degree;
  std::vector<double> min, max, integral;
};

FieldSummary summarise(const Field& field, int threads) {
  FieldSummary s{field.space().highest_degree(),
                 field.space().highest_degree(),
                 {},
                 {},
                 integral(field, threads)};
  for (std::size_t e = 0; e < field.mesh().element_count(); ++e) {
    s.lowest_degree = std::min(s.lowest_degree, field.space().degree(ElementId(e)));
  }
  for (int c = 0; c < field.components(); ++c) {
    const bernstein::Range range = value_range(field, c);
    s.min.push_back(range.lo);
    s.max.push_back(range.hi);
  }
  return s;
}

std::string elements_text(const std::vector<std::size_t>& elements) {
  constexpr std::size_t most = 10;
  const std::vector<std::size_t> first(
      elements.begin(),
      elements.begin() + static_cast<std::ptrdiff_t>(std::min(most, elements.size())));
  return fmt::format("{}{}", fmt::join(first, ", "), elements.size() > most ? ", ..." : "");
}

int run(const InfoOptions& options, const Context& context) {
  const Dataset data = read_noting(context, options.file, options.format);
  const TriangleMesh& mesh = *data.mesh;
  const MeshValidity validity = check_elements(mesh, context.threads);
  const Box2 box = true_box(mesh);
  const double mesh_area = total_area(mesh);

  Json fields = Json::array();
  std::string fields_text;
  for (const Field& field : data.fields) {
    const FieldSummary s = summarise(field, context.threads);
    fields.push_back({{"name", field.name()},
                      {"degree", s.highest_degree},
                      {"lowest_degree", s.lowest_degree},
                      {"components", field.components()},
                      {"basis", to_string(field.space().basis())},
                      {"continuity", to_string(field.space().continuity())},
                      {"dofs", field.space().dof_count()},
                      {"min", per_component(s.min)},
                      {"max", per_component(s.max)},
                      {"integral", per_component(s.integral)}});
    fields_text += fmt::format("field {}\n  degree     {}\n  components {}\n  basis      {}, {}\n",
                               field.name(),
                               s.lowest_degree == s.highest_degree
                                   ? fmt::format("{}", s.highest_degree)
                                   : fmt::format("{} to {}", s.lowest_degree, s.highest_degree),
                               field.components(), to_string(field.space().basis()),
                               to_string(field.space().continuity()));
    for (std::size_t c = 0; c < s.min.size(); ++c) {
      fields_text +=
          fmt::format("  {:<10} min {:.10g}, max {:.10g}, integral {:.10g}\n",
                      s.min.size() == 1 ? std::string("values") : fmt::format("values {}", c),
                      s.min[c], s.max[c], s.integral[c]);
    }
  }

  if (context.json) {
    Json groups = Json::array();
    for (const PhysicalGroup& g : mesh.tags().groups)
      groups.push_back({{"dim", g.dim}, {"tag", g.tag}, {"name", g.name}});
    print_json(
        Json{{"schema", "bezel/info/1"},
             {"file", options.file},
             {"dim", 2},
             {"geometric_degree", mesh.degree()},
             {"vertices", mesh.vertex_count()},
             {"nodes", mesh.node_count()},
             {"edges", mesh.edge_count()},
             {"elements", mesh.element_count()},
             {"area", mesh_area},
             {"bounding_box", {{"min", {box.lo[0], box.lo[1]}}, {"max", {box.hi[0], box.hi[1]}}}},
             {"valid", validity.valid},
             {"inverted", validity.inverted.size()},
             {"undecided", validity.undecided.size()},
             {"inverted_elements", validity.inverted},
             {"undecided_elements", validity.undecided},
             {"groups", groups},
             {"time", data.time ? Json(*data.time) : Json()},
             {"fields", fields},
             {"notes", data.notes}});
    return ok;
  }
  std::string text = fmt::format(
      "mesh\n  elements   {} of geometric degree {}\n  vertices   {}\n  area       {:.10g}\n"
      "  box        [{:.10g}, {:.10g}] x [{:.10g}, {:.10g}]\n  validity   {} valid",
      counted(mesh.element_count(), "triangle"), mesh.degree(), mesh.vertex_count(), mesh_area,
      box.lo[0], box.hi[0], box.lo[1], box.hi[1], validity.valid);
  if (!validity.inverted.empty())
    text += fmt::format(", {} inverted ({})", validity.inverted.size(),
                        elements_text(validity.inverted));
  if (!validity.undecided.empty())
    text += fmt::format(", {} undecided ({})", validity.undecided.size(),
                        elements_text(validity.undecided));
  text += "\n";
  for (const PhysicalGroup& g : mesh.tags().groups)
    text += fmt::format("  group      {} (dimension {}, tag {})\n",
                        g.name.empty() ? "unnamed" : g.name, g.dim, g.tag);
  if (data.time) text += fmt::format("  time       {:.10g}\n", *data.time);
  print(text + fields_text);
  return ok;
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = add_command(app, context, "info", "Say what is in a file",
                                  "bezel info moved.vtu --json", options, run);
  command->add_option("FILE", options->file, "Mesh or field file")->required();
  add_format_option(*command, options->format, "--format",
                    "Format of FILE, when its extension does not say");
}

}  // namespace bezel::cli
