// bezel transfer: fields from one mesh to another, mass conserved.

#include "bezel/transfer/transfer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/transfer/operator.hpp"
#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/progress_bar.hpp"
#include "cli/transfer_processes.hpp"
#include "cli/transfer_series.hpp"

namespace bezel::cli {
namespace {

struct TransferCommand {
  std::string donor, target, out, report, uncovered = "error", conserve = "covered",
                                          continuity = "dg", bounds = "none";
  std::string weight, density, matrix;
  std::vector<std::string> fields;
  std::optional<int> degree;
  Basis basis = Basis::reference;
  CLI::Option* basis_given = nullptr;
  bool keep_boundary = false;
  std::string mass_method = "auto";
  std::optional<Format> format;
};

Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

constexpr std::array<const char*, 4> method_names = {"auto", "cholesky", "conjugate_gradients",
                                                     "petsc"};
const char* method_name(MassMethod method) {
  return method_names[static_cast<std::size_t>(method)];
}

MassMethod method_named(const std::string& name) {
  const auto at = std::find(method_names.begin(), method_names.end(), name);
  return static_cast<MassMethod>(at - method_names.begin());
}

Bounds parse_bounds(const std::string& text) {
  if (text == "none") return {};
  if (text == "local") return Bounds::local();
  const auto comma = text.find(',');
  if (comma != std::string::npos) {
    // An open side is written inf.
    const auto number = [](const std::string& part, double open) {
      return part == (open > 0 ? "inf" : "-inf") ? std::optional(open) : parse_number(part);
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto lo = number(text.substr(0, comma), -infinity);
    const auto hi = number(text.substr(comma + 1), infinity);
    if (lo && hi && *lo <= *hi) return Bounds::between(*lo, *hi);
  }
  throw UsageError(
      "--bounds: expected two ascending numbers such as 0,1 or 0,inf, or local or none, "
      "found '" +
      text + "'");
}

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
                      {"max", f.max_after},
                      {"elements_limited", f.bounds.elements_limited},
                      {"mass_moved", f.bounds.mass_moved}});
    if (!f.mass_solve) continue;
    const MassSolve& solve = *f.mass_solve;
    fields.back()["mass_solve"] = {{"dofs", solve.dofs},
                                   {"method", method_name(solve.method)},
                                   {"iterations", solve.iterations},
                                   {"relative_residual", solve.relative_residual},
                                   {"boundary_mass_change", solve.boundary_mass_change}};
  }
  Json uncovered = Json::array();
  for (const auto& part : r.uncovered_elements)
    uncovered.push_back({{"element", part.first.value}, {"area", part.second}});
  return Json{{"schema", "bezel/transfer/1"},
              {"donor", options.donor},
              {"target", options.target},
              {"output", options.out},
              {"matrix", or_null(options.matrix)},
              {"weight", or_null(options.weight)},
              {"density", or_null(options.density)},
              {"bounds", options.bounds},
              {"fields", fields},
              {"mass_outside", outside},
              {"mass_made", made},
              {"pairs", r.pairs},
              {"crossings", r.crossings},
              {"tangencies", r.tangencies},
              {"overlaps", r.overlaps},
              {"unresolved", r.unresolved},
              {"uncovered_area", r.uncovered_area},
              {"extension_growth", r.extension_growth},
              {"extension_moved_area", r.extension_moved_area},
              {"extension_held_area", r.extension_held_area},
              {"outside_area", r.outside_area},
              {"spread_elements", r.spread_elements},
              {"uncovered_elements", uncovered},
              {"max_partition_residual", r.max_partition_residual},
              {"max_joint_gap", r.max_joint_gap},
              {"seconds",
               {{"total", r.seconds.total},
                {"prepare", r.seconds.prepare},
                {"report", r.seconds.report},
                {"overlay", r.seconds.overlay},
                {"integrate", r.seconds.integrate},
                {"solve", r.seconds.solve}}}};
}

std::string to_table(const TransferReport& r, const TransferCommand& options) {
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
  if (options.bounds != "none") {
    std::int64_t limited = 0;
    for (const FieldReport& f : r.fields) limited += f.bounds.elements_limited;
    text += fmt::format("bounds {}: {} limited", options.bounds,
                        counted(static_cast<std::size_t>(limited), "polynomial"));
    for (std::size_t i = 0; i < labels.size(); ++i)
      text += fmt::format("{} mass moved for {}: {:.3g}", i == 0 ? ";" : ",", labels[i],
                          r.fields[i].bounds.mass_moved);
    text += "\n";
  }
  text +=
      fmt::format("overlay: {} pairs, {} crossings, {} tangencies, {} overlaps, {} unresolved\n",
                  r.pairs, r.crossings, r.tangencies, r.overlaps, r.unresolved);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!r.fields[i].mass_solve) continue;
    const MassSolve& solve = *r.fields[i].mass_solve;
    text += fmt::format("{:<{}}  {} degrees of freedom, {}, residual {:.1e}", labels[i], width,
                        solve.dofs,
                        solve.method == MassMethod::cholesky
                            ? std::string("sparse Cholesky")
                            : counted(static_cast<std::size_t>(solve.iterations), "iteration"),
                        solve.relative_residual);
    if (options.keep_boundary)
      text += fmt::format(", mass changed by {:.3g} for the boundary", solve.boundary_mass_change);
    text += "\n";
  }
  text += fmt::format("largest partition residual {:.1e}, largest joint gap {:.1e}\n",
                      r.max_partition_residual, r.max_joint_gap);
  if (r.uncovered_area > 0) {
    text += fmt::format("target area without donor {:.6g} ({})\n", r.uncovered_area,
                        counted(r.uncovered_elements.size(), "triangle"));
  }
  if (r.extension_moved_area > 0) {
    text += fmt::format("  {:.6g} of it continued from better donors than the nearest\n",
                        r.extension_moved_area);
  }
  if (r.extension_held_area > 0) {
    text += fmt::format("  {:.6g} of it too far from the donor for its polynomials: values held\n",
                        r.extension_held_area);
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

// The output, its report and the matrix appear all or not at all.
void write_all(const TransferCommand& options, const Dataset& data, const WriteOptions& how,
               const Json& report, const TransferOperator* matrix, const Context& context) {
  FileSet files;
  if (!options.report.empty()) files.add(options.report, to_text(report));
  if (matrix != nullptr) matrix->write_matrix_market(files.add(options.matrix));
  const Encoded encoded = encode(options.out, data, how);
  files.add(options.out, encoded.bytes);
  notes(context, options.out, encoded.lost);
  files.commit();
}

void check_usage(const TransferCommand& options) {
  const bool weighted = !options.weight.empty() || !options.density.empty();
  if (!options.matrix.empty() && weighted)
    throw UsageError("--matrix: not with --weight or --density");
  if (!options.matrix.empty() && (options.continuity == "cg" || options.conserve != "covered"))
    throw UsageError("--matrix: not with --continuity cg or --conserve total");
  if (weighted &&
      (options.keep_boundary || options.bounds != "none" || options.conserve != "covered")) {
    throw UsageError(
        "--weight and --density: not with --keep-boundary, --bounds or --conserve total");
  }
  if (options.continuity != "cg") {
    if (options.keep_boundary) throw UsageError("--keep-boundary needs --continuity cg");
    if (options.mass_method != "auto") throw UsageError("--mass-method needs --continuity cg");
    return;
  }
  if (options.keep_boundary && options.bounds != "none") {
    throw UsageError(
        "--bounds: not with --keep-boundary: bounds need the freedom that kept boundary "
        "values take");
  }
  if (options.basis_given->count() > 0 && options.basis == Basis::physical) {
    throw UsageError(
        "--basis physical: not with --continuity cg: along a curved edge a polynomial in x and y "
        "has a higher degree than the edge has coefficients");
  }
  if (options.degree == 0) throw UsageError("--degree 0: --continuity cg needs at least 1");
  if (!is_available(method_named(options.mass_method)))
    throw UsageError("--mass-method petsc: this build of bezel has no PETSc");
}

TransferOptions transfer_options(const TransferCommand& options, const Context& context) {
  TransferOptions how_to;
  how_to.degree = options.degree.value_or(-1);
  how_to.basis = options.basis;
  how_to.same_basis = options.basis_given->count() == 0;
  how_to.uncovered = options.uncovered == "extend" ? Uncovered::extend
                     : options.uncovered == "zero" ? Uncovered::zero
                                                   : Uncovered::error;
  if (!options.weight.empty()) {
    const std::vector<Formula> weight = parse_components("--weight", options.weight);
    if (weight.size() != 1) throw UsageError("--weight: found several formulas, expected one");
    how_to.weight = weight.front();
  }
  how_to.density = options.density;
  how_to.conserve = options.conserve == "total" ? Conserve::total : Conserve::covered;
  how_to.bounds = parse_bounds(options.bounds);
  how_to.continuity =
      options.continuity == "cg" ? Continuity::continuous : Continuity::discontinuous;
  how_to.keep_boundary = options.keep_boundary;
  how_to.mass_method = method_named(options.mass_method);
  how_to.threads = context.threads;
  return how_to;
}

// transfer(), the same by several processes, or by an operator whose matrix is asked for.
TransferResult move(const TransferCommand& options, std::span<const Field> fields,
                    const std::shared_ptr<const TriangleMesh>& target,
                    const TransferOptions& how_to, Processes* processes,
                    std::optional<TransferOperator>& matrix, const Progress& progress) {
  if (options.matrix.empty()) {
    return processes != nullptr ? processes->transfer(fields, target, how_to, progress)
                                : transfer(fields, target, how_to, progress);
  }
  TransferOptions linear = how_to;
  linear.bounds = {};
  const auto& donor = fields.front().space_ptr();
  matrix.emplace(processes != nullptr
                     ? processes->transfer_operator(donor, target, linear, progress)
                     : TransferOperator(donor, target, linear, progress));
  for (const Field& f : fields) {
    if (!matrix->accepts(f.space()))
      throw InputError("donor mesh: field '" + f.name() + "' has another degree or basis than '" +
                       fields.front().name() + "', expected fields that share one matrix");
  }
  return matrix->transfer(fields, how_to.bounds, how_to.threads);
}

int run(const TransferCommand& options, const Context& context) {
  check_usage(options);
  const TransferOptions how_to = transfer_options(options, context);
  const bool series = is_collection(options.donor) || is_collection(options.out);
  const std::unique_ptr<Processes> processes = join_processes();
  if (processes && processes->rank() > 0) {
    // Several processes with all threads each would be in each other's way.
    processes->serve(std::max(how_to.threads, 1));
    return ok;
  }
  if (series) {
    if (!options.matrix.empty()) throw UsageError("--matrix: not with a time series");
    if (options.format && options.format != Format::vtu)
      throw UsageError("--format: the steps of a time series are written as vtu");
    return transfer_series(
        {options.donor, options.target, options.out, options.report, options.fields}, how_to,
        [&](const TransferReport& report) { return to_json(options, report); }, context,
        processes.get());
  }
  WriteOptions how;
  how.format = options.format ? options.format : format_of(options.out);
  require_writable(options.out);
  if (!options.report.empty()) require_writable(options.report);
  if (!options.matrix.empty()) require_writable(options.matrix);

  const std::vector<Dataset> data =
      read_all_noting(context, std::array{options.donor, options.target});
  const Dataset& donor = data[0];
  const Dataset& target = data[1];
  const std::vector<Field> fields = chosen_fields(donor, options.donor, options.fields);

  TransferResult result;
  std::optional<TransferOperator> matrix;
  ProgressBar bar(context, "transfer");  // until the files are whole
  result = naming_files(options.donor, options.target, [&] {
    return move(options, fields, target.mesh, how_to, processes.get(), matrix, bar.callback());
  });
  bar.wipe();
  Dataset moved;
  moved.mesh = target.mesh;
  moved.fields = std::move(result.fields);
  moved.time = donor.time;
  Json report = to_json(options, result.report);
  if (processes) report["processes"] = processes_json(*processes);
  write_all(options, moved, how, report, matrix ? &*matrix : nullptr, context);
  std::vector<std::string> files = {options.out};
  for (const std::string& file : {options.report, options.matrix}) {
    if (!file.empty()) files.push_back(file);
  }
  std::string text = context.json ? to_text(report) : to_table(result.report, options);
  if (processes && !context.json) text += processes_table(*processes);
  print_or_remove(text, files);
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
                  "--report report.json\n  bezel transfer run.pvd target.msh -o moved.pvd",
                  options, run);
  command->add_option("DONOR", o.donor, "File with the fields, or a time series (.pvd)")
      ->required();
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
  command
      ->add_option("--continuity", o.continuity,
                   "dg: the new fields are discontinuous; cg: continuous (reference basis)")
      ->check(CLI::IsMember({"dg", "cg"}))
      ->type_name("CONTINUITY")
      ->capture_default_str();
  command->add_flag(
      "--keep-boundary", o.keep_boundary,
      "With --continuity cg: the boundary takes the donor's values; mass changes a little");
  command
      ->add_option("--mass-method", o.mass_method,
                   "With --continuity cg: auto, cholesky, conjugate_gradients, or petsc in builds "
                   "that have it")
      ->check(CLI::IsMember(std::vector<std::string>(method_names.begin(), method_names.end())))
      ->type_name("METHOD")
      ->capture_default_str();
  command
      ->add_option("--uncovered", o.uncovered,
                   "Where no donor triangle lies: error (refuse), extend (continue the nearest "
                   "polynomial) or zero")
      ->check(CLI::IsMember({"error", "extend", "zero"}))
      ->type_name("HOW")
      ->capture_default_str();
  command
      ->add_option("--weight", o.weight,
                   "A polynomial in x and y, such as the distance x from an axis: project and "
                   "conserve in the inner product with this weight")
      ->type_name("EXPR");
  command
      ->add_option("--density", o.density,
                   "A field that carries the others: density times field is conserved")
      ->type_name("NAME");
  command
      ->add_option("--matrix", o.matrix,
                   "Write the transfer as a sparse matrix there too (Matrix Market)")
      ->type_name("FILE");
  command
      ->add_option("--conserve", o.conserve,
                   "Which mass is kept: covered (before - outside + made) or total (the difference "
                   "goes to triangles at the boundary; constants change there)")
      ->check(CLI::IsMember({"covered", "total"}))
      ->type_name("WHAT")
      ->capture_default_str();
  command
      ->add_option("--bounds", o.bounds,
                   "Keep every value within LO,HI (inf: open), or within the donor's values nearby "
                   "(local)")
      ->type_name("LO,HI|local|none")
      ->capture_default_str();
  command->add_option("--report", o.report, "Write the report there as JSON too")
      ->type_name("FILE");
  add_format_option(*command, o.format, "--format",
                    "Format of the output; default: by the extension");
}

}  // namespace bezel::cli
