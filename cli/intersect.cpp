// bezel intersect: everything that curves, or curved triangles, have in common.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/view/canvas.hpp"
#include "cli/intersect_report.hpp"
#include "cli/json_text.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/progress_bar.hpp"

namespace bezel::cli {
namespace {

struct IntersectCommand {
  std::string file, out;
  double coincidence_distance = 0.0;
  bool difference = false, hex = false;
  CurveDrawOptions draw;
};

IntersectReport report_on(const Shapes& input, const std::string& file,
                          const IntersectCommand& options, const Context& context) {
  ProgressBar bar(context, "intersect");
  const ReportOptions how{
      file,          options.coincidence_distance, options.difference, options.hex, context.threads,
      bar.callback()};
  return input.shapes[0].triangle ? report_triangles(input, how) : report_curves(input, how);
}

int run(const IntersectCommand& options, const Context& context) {
  if (!(options.coincidence_distance >= 0.0) || !std::isfinite(options.coincidence_distance))
    throw UsageError("--coincidence-distance: expected a finite number, at least 0");
  std::vector<std::string> files;
  if (!options.out.empty()) {
    view::check_extension(options.out);
    require_writable(options.out);
    files = {options.out};
  }
  const InputText text = read_input_text(options.file);
  const Shapes input = read_shapes(text.name, text.text);
  if (options.difference && !input.shapes[0].triangle)
    throw InputError(InputPlace{text.name, 0, "", -1},
                     "found curves, expected triangles for --difference");
  if (input.rounded > 0)
    note(context, fmt::format("{}: {} rounded to the nearest double", text.name,
                              counted(input.rounded, "rational number")));
  const IntersectReport report = report_on(input, text.name, options, context);
  if (!options.out.empty()) draw_curves(options.out, report.picture, options.draw);
  const Json object{
      {"schema", "bezel/intersect/1"},
      {"file", options.file},
      {"output", options.out.empty() ? Json() : Json(options.out)},
      {"operation", options.difference ? "difference" : "intersection"},
      {"coincidence_distance", number_json(options.coincidence_distance, options.hex)},
      {"unresolved_count", report.unresolved},
      {"results", report.results}};
  print_or_remove(context.json ? to_text(object) : report.text, files);
  return report.unresolved == 0 ? ok : check_failed;
}

}  // namespace

std::string summary(const std::vector<std::pair<std::size_t, const char*>>& counts,
                    const std::string& nothing) {
  std::string text;
  for (const auto& [n, what] : counts) {
    if (n == 0) continue;
    std::string word = what;
    if (n > 1) {
      if (word == "tangency") {
        word = "tangencies";
      } else {
        word.insert(std::min(word.find(' '), word.size()), "s");
      }
    }
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, word);
  }
  return text.empty() ? nothing : text;
}

std::string pair_name(const Shapes& input, std::size_t pair) {
  if (input.in_pairs) return fmt::format("pair {}", pair);
  const auto& [first, second] = input.pairs[pair];
  return input.shapes[first].name + " and " + input.shapes[second].name;
}

Json point_json(const Vec2& point, bool hex) {
  return numbers_json({point.x(), point.y()}, hex);
}

void add_intersect(CLI::App& app, Context& context) {
  auto options = std::make_shared<IntersectCommand>();
  IntersectCommand& o = *options;
  CLI::App* command = add_command(
      app, context, "intersect",
      "Find all that curves or curved triangles have in common; exit code 1 when not resolved",
      "bezel intersect curves.json -o curves.svg", options, run);
  command->add_option("FILE", o.file, "JSON file; '-': the standard input")->required();
  command
      ->add_option("--coincidence-distance", o.coincidence_distance,
                   "Curves nearer to each other than this count as coincident (units of the input; "
                   "0: exact)")
      ->type_name("D")
      ->capture_default_str();
  command->add_flag("--difference", o.difference,
                    "What the second triangle of a pair leaves of the first");
  command->add_option("-o,--output", o.out, "Picture to write: .svg or .png")->type_name("FILE");
  command->add_option("--width", o.draw.width, "Width of the picture in pixels")
      ->check(CLI::Range(64, 16384))
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_flag("--control-polygons,!--no-control-polygons", o.draw.control_polygons,
                    "Draw the control polygons, or not (default: drawn)");
  command->add_flag("--hex", o.hex, "Print hex floats");
}

}  // namespace bezel::cli
