// bezel check: is every element valid, and do the elements fit together?

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/overlaps.hpp"
#include "cli/progress_bar.hpp"
#include "cli/validity.hpp"

namespace bezel::cli {
namespace {

struct CheckOptions {
  std::string file;
  std::optional<Format> format;
  std::size_t limit = 10;
  bool overlaps = false;
};

struct Defect {
  std::string kind, message;
  std::vector<std::size_t> elements;
};

std::vector<Defect> element_defects(const TriangleMesh& mesh, const MeshValidity& validity) {
  std::vector<Defect> defects;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const ValidityResult& r = validity.elements[e];
    if (r.status == Validity::valid) continue;
    const bool inverted = r.status == Validity::inverted;
    defects.push_back({inverted ? "inverted" : "undecided",
                       fmt::format("triangle {}: {}: the smallest Jacobian determinant seen is "
                                   "{:.6g}, at barycentric ({:.4g}, {:.4g}, {:.4g})",
                                   e, inverted ? "inverted" : "neither proven valid nor inverted",
                                   r.det, r.where[0], r.where[1], r.where[2]),
                       {e}});
  }
  return defects;
}

// Edges that more than two elements share, or that two valid elements use from the same side.
std::vector<Defect> edge_defects(const TriangleMesh& mesh, const MeshValidity& validity) {
  std::vector<Defect> defects;
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) {
    const EdgeId edge(i);
    const auto sides = mesh.adjacent(edge);
    if (sides.size() < 2) continue;
    std::vector<std::size_t> elements;
    for (const ElementSide& side : sides) elements.push_back(side.element.index());
    const auto nodes = mesh.edge_nodes(edge);
    const Vec2 a = mesh.control(nodes.front()), b = mesh.control(nodes.back());
    const std::string where =
        fmt::format("the edge from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g})", a[0], a[1], b[0], b[1]);
    if (sides.size() > 2) {
      defects.push_back({"shared_edge",
                         fmt::format("triangles {}: all share {}, expected at most two",
                                     fmt::join(elements, ", "), where),
                         elements});
    } else if (sides[0].reversed == sides[1].reversed &&
               validity.elements[elements[0]].status == Validity::valid &&
               validity.elements[elements[1]].status == Validity::valid) {
      defects.push_back({"folded_edge",
                         fmt::format("triangles {}: both lie on the same side of {}",
                                     fmt::join(elements, ", "), where),
                         elements});
    }
  }
  return defects;
}

std::vector<Defect> overlap_defects(const TriangleMesh& mesh, const MeshValidity& validity,
                                    const Context& context) {
  std::vector<Defect> defects;
  ProgressBar bar(context, "check");
  for (const ElementOverlap& o : find_overlaps(mesh, validity, context.threads, bar.callback())) {
    const std::string where = fmt::format("({:.6g}, {:.6g})", o.place[0], o.place[1]);
    defects.push_back(
        {o.decided ? "overlap" : "undecided_overlap",
         o.decided ? fmt::format(
                         "triangles {}, {}: they overlap in an area of {:.6g}, with a corner at {}",
                         o.first, o.second, o.area, where)
                   : fmt::format("triangles {}, {}: whether they overlap is undecided: {}, near {}",
                                 o.first, o.second, o.reason, where),
         {o.first, o.second}});
  }
  return defects;
}

int run(const CheckOptions& options, const Context& context) {
  const Dataset data = read_noting(context, options.file, options.format);
  const TriangleMesh& mesh = *data.mesh;
  const MeshValidity validity = check_elements(mesh, context.threads);
  std::vector<Defect> defects = element_defects(mesh, validity);
  for (Defect& defect : edge_defects(mesh, validity)) defects.push_back(std::move(defect));
  if (options.overlaps)
    for (Defect& defect : overlap_defects(mesh, validity, context))
      defects.push_back(std::move(defect));

  const std::size_t shown = std::min(options.limit, defects.size());
  if (context.json) {
    Json list = Json::array();
    for (std::size_t i = 0; i < shown; ++i) {
      list.push_back({{"kind", defects[i].kind},
                      {"elements", defects[i].elements},
                      {"message", defects[i].message}});
    }
    print_json(Json{{"schema", "bezel/check/1"},
                    {"file", options.file},
                    {"ok", defects.empty()},
                    {"elements", mesh.element_count()},
                    {"valid", validity.valid},
                    {"inverted", validity.inverted.size()},
                    {"undecided", validity.undecided.size()},
                    {"overlaps_checked", options.overlaps},
                    {"defect_count", defects.size()},
                    {"defects", list}});
  } else if (defects.empty()) {
    const std::size_t n = mesh.element_count();
    print(n == 1 ? fmt::format("{}: ok, its only triangle is valid\n", options.file)
                 : fmt::format("{}: ok, all {} triangles are valid and fit together\n",
                               options.file, n));
  } else {
    std::string text =
        fmt::format("{}: {} in {}\n", options.file, counted(defects.size(), "defect"),
                    counted(mesh.element_count(), "triangle"));
    for (std::size_t i = 0; i < shown; ++i) text += "  " + defects[i].message + "\n";
    if (shown < defects.size())
      text += fmt::format("  ... and {} more (--limit)\n", defects.size() - shown);
    print(text);
  }
  return defects.empty() ? ok : check_failed;
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = add_command(app, context, "check",
                                  "Check that every curved element is valid; exit code 1 when not",
                                  "bezel check disc.msh", options, run);
  command->add_option("FILE", options->file, "Mesh file")->required();
  command->add_option("--limit", options->limit, "Show at most N defects")
      ->check(CLI::Range(0, 1000000000))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--overlaps", options->overlaps,
                    "Also look for elements that have an area in common");
  add_format_option(*command, options->format, "--format",
                    "Format of FILE, when its extension does not say");
}

}  // namespace bezel::cli
