// bezel transfer: fields from one mesh to another, mass conserved.

#include "bezel/transfer/transfer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/progress_bar.hpp"

namespace bezel::cli {
namespace {

struct TransferCommand {
  std::string donor, target, out, report, uncovered = "error", conserve = "covered",
                                          continuity = "dg";
  std::vector<std::string> fields;
  std::optional<int> degree;
  Basis basis = Basis::reference;
  CLI::Option* basis_given = nullptr;
  std::optional<Format> format;
};

Json to_json(const TransferCommand& options, const TransferReport& r) {
  Json fields = Json::array();
  double outside = 0, made = 0;
  for (const FieldReport& f : r.fields) {
    outside += f.mass_outside;
    made += f.mass_made;
    fields.push_back({{"name", f.name},
                      {"component", f.component},
                      {"mass_before", f.mass_before},
                      {"mass_after", f.mass_after},
                      {"mass_outside", f.mass_outside},
                      {"mass_made", f.mass_made},
                      {"mass_spread", f.mass_spread},
                      {"max_spread_change", f.max_spread_change},
                      {"relative_mass_defect", f.relative_mass_defect},
                      {"max_element_defect", f.max_element_defect},
                      {"min_before", f.min_before},
                      {"max_before", f.max_before},
                      {"min", f.min_after},
                      {"max", f.max_after}});
  }
  Json uncovered = Json::array();
  for (const auto& part : r.uncovered_elements)
    uncovered.push_back({{"element", part.first.value}, {"area", part.second}});
  return Json{{"schema", "bezel/transfer/1"},
              {"donor", options.donor},
              {"target", options.target},
              {"output", options.out},
              {"fields", fields},
              {"mass_outside", outside},
              {"mass_made", made},
              {"pairs", r.pairs},
              {"crossings", r.crossings},
              {"tangencies", r.tangencies},
              {"overlaps", r.overlaps},
              {"unresolved", r.unresolved},
              {"uncovered_area", r.uncovered_area},
              {"outside_area", r.outside_area},
              {"spread_elements", r.spread_elements},
              {"uncovered_elements", uncovered},
              {"max_partition_residual", r.max_partition_residual},
              {"max_joint_gap", r.max_joint_gap},
              {"seconds",
               {{"total", r.seconds.total},
                {"overlay", r.seconds.overlay},
                {"integrate", r.seconds.integrate},
                {"solve", r.seconds.solve}}}};
}

std::string to_table(const TransferReport& r) {
  std::size_t width = 5;
  const auto label = [](const FieldReport& f, bool several) {
    return several ? fmt::format("{}[{}]", f.name, f.component) : f.name;
  };
  std::vector<std::string> labels;
  for (const FieldReport& f : r.fields) {
    const auto same = [&](const FieldReport& k) { return k.name == f.name; };
    labels.push_back(label(f, std::count_if(r.fields.begin(), r.fields.end(), same) > 1));
    width = std::max(width, labels.back().size());
  }
  std::string text =
      fmt::format("{:<{}}  {:>17}  {:>17}  {:>10}  {:>10}  {:>8}  {:>12}  {:>12}\n", "field", width,
                  "mass before", "mass after", "outside", "made", "defect", "min", "max");
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const FieldReport& f = r.fields[i];
    text += fmt::format(
        "{:<{}}  {:>17.10g}  {:>17.10g}  {:>10.3g}  {:>10.3g}  {:>8.1e}  {:>12.6g}  {:>12.6g}\n",
        labels[i], width, f.mass_before, f.mass_after, f.mass_outside, f.mass_made,
        f.relative_mass_defect, f.min_after, f.max_after);
  }
  text +=
      fmt::format("overlay: {} pairs, {} crossings, {} tangencies, {} overlaps, {} unresolved\n",
                  r.pairs, r.crossings, r.tangencies, r.overlaps, r.unresolved);
  text += fmt::format("largest partition residual {:.1e}, largest joint gap {:.1e}\n",
                      r.max_partition_residual, r.max_joint_gap);
  if (r.uncovered_area > 0) {
    text += fmt::format("target area without donor {:.6g} ({})\n", r.uncovered_area,
                        counted(r.uncovered_elements.size(), "triangle"));
  }
  if (r.outside_area > 0) {
    text += fmt::format("donor area without target {:.6g}\n", r.outside_area);
  }
  if (r.spread_elements > 0) {
    double change = 0;
    for (const FieldReport& f : r.fields) change = std::max(change, f.max_spread_change);
    text += fmt::format(
        "total mass kept: values in {} at the boundary changed by up to {:.3g}, constants too\n",
        counted(static_cast<std::size_t>(r.spread_elements), "triangle"), change);
  }
  return text;
}

// The output and its report appear both or not at all.
void write_both(const TransferCommand& options, const Dataset& data, const WriteOptions& how,
                const Json& report, const Context& context) {
  std::optional<AtomicFile> report_file;
  if (!options.report.empty()) {
    report_file.emplace(options.report);
    report_file->write(to_text(report));
  }
  notes(context, options.out, write(options.out, data, how));
  if (!report_file) return;
  try {
    report_file->commit();
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(options.out, ignored);
    throw;
  }
}

int run(const TransferCommand& options, const Context& context) {
  WriteOptions how;
  how.format = options.format ? options.format : format_of(options.out);
  require_writable(options.out);
  if (!options.report.empty()) require_writable(options.report);

  const Dataset donor = read_noting(context, options.donor);
  std::vector<Field> fields;
  for (const std::string& name : options.fields) {
    try {
      fields.push_back(donor.field(name));
    } catch (const InputError& error) {
      throw error.in_file(options.donor);
    }
  }
  if (options.fields.empty()) fields = donor.fields;
  if (fields.empty())
    throw InputError(InputPlace{options.donor, 0, {}, -1}, "there are no fields to transfer");
  const Dataset target = read_noting(context, options.target);

  TransferOptions how_to;
  how_to.degree = options.degree.value_or(-1);
  how_to.basis = options.basis;
  how_to.same_basis = options.basis_given->count() == 0;
  how_to.uncovered = options.uncovered == "extend" ? Uncovered::extend
                     : options.uncovered == "zero" ? Uncovered::zero
                                                   : Uncovered::error;
  how_to.conserve = options.conserve == "total" ? Conserve::total : Conserve::covered;
  how_to.threads = context.threads;
  TransferResult result;
  {
    ProgressBar bar(context, "transfer");
    try {
      result = transfer(fields, target.mesh, how_to, bar.callback());
    } catch (const UncoveredError& error) {
      throw InputError(InputPlace{options.target, 0, {}, -1},
                       std::string(error.what()) + " (--uncovered)");
    } catch (const InputError& error) {
      throw error.in_file(error.message().find("donor mesh") == 0 ? options.donor : options.target);
    }
  }
  Dataset moved;
  moved.mesh = target.mesh;
  moved.fields = std::move(result.fields);
  moved.time = donor.time;
  const Json report = to_json(options, result.report);
  write_both(options, moved, how, report, context);
  std::vector<std::string> files = {options.out};
  if (!options.report.empty()) files.push_back(options.report);
  print_or_remove(context.json ? to_text(report) : to_table(result.report), files);
  if (!context.json && context.verbose > 0) {
    const auto& s = result.report.seconds;
    note(context, fmt::format("{:.3g} s: overlay {:.3g}, integrate {:.3g}, solve {:.3g}", s.total,
                              s.overlay, s.integrate, s.solve));
  }
  return ok;
}

}  // namespace

void add_transfer(CLI::App& app, Context& context) {
  auto options = std::make_shared<TransferCommand>();
  TransferCommand& o = *options;
  CLI::App* command =
      add_command(app, context, "transfer", "Move fields from one mesh to another, conserving mass",
                  "bezel transfer donor.msh target.msh -f u --uncovered extend -o moved.vtu "
                  "--report report.json",
                  options, run);
  command->add_option("DONOR", o.donor, "File with the fields")->required();
  command->add_option("TARGET", o.target, "File with the mesh to move them to")->required();
  command->add_option("-o,--output", o.out, "File to write")->required()->type_name("FILE");
  command->add_option("-f,--field", o.fields, "A field to move; may be repeated (default: all)")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command
      ->add_option("--degree", o.degree, "Degree of the new fields, 0 to 10 (default: the donor's)")
      ->check(CLI::Range(0, 10))
      ->type_name("P");
  o.basis_given = add_basis_option(
      *command, o.basis,
      "reference (mapped) or physical (polynomials in x and y); default: each field's own");
  command->add_option("--continuity", o.continuity, "dg: the new fields are discontinuous")
      ->check(CLI::IsMember({"dg"}))
      ->type_name("CONTINUITY")
      ->capture_default_str();
  command
      ->add_option("--uncovered", o.uncovered,
                   "Where no donor triangle lies: error (refuse), extend (continue the nearest "
                   "polynomial) or zero")
      ->check(CLI::IsMember({"error", "extend", "zero"}))
      ->type_name("HOW")
      ->capture_default_str();
  command
      ->add_option("--conserve", o.conserve,
                   "Which mass is kept: covered (before - outside + made) or total (the difference "
                   "goes to triangles at the boundary; constants change there)")
      ->check(CLI::IsMember({"covered", "total"}))
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_option("--report", o.report, "Write the report there as JSON too")
      ->type_name("FILE");
  add_format_option(*command, o.format, "--format",
                    "Format of the output; default: by the extension");
}

}  // namespace bezel::cli
