#include "cli/transfer_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/io/pvd.hpp"
#include "bezel/transfer/layout.hpp"
#include "bezel/transfer/series.hpp"
#include "cli/command.hpp"
#include "cli/progress_bar.hpp"
#include "cli/transfer_processes.hpp"

namespace bezel::cli {

namespace paths = std::filesystem;

bool is_collection(const std::string& path) {
  return paths::path(path).extension() == ".pvd";
}

std::vector<Field> chosen_fields(const Dataset& data, const std::string& file,
                                 const std::vector<std::string>& names) {
  std::vector<Field> fields;
  for (const std::string& name : names) {
    try {
      fields.push_back(data.field(name));
    } catch (const InputError& error) {
      throw error.in_file(file);
    }
  }
  if (names.empty()) fields = data.fields;
  if (fields.empty())
    throw InputError(InputPlace{file, 0, {}, -1}, "there are no fields to transfer");
  return fields;
}

TransferResult naming_files(const std::string& donor, const std::string& target,
                            const std::function<TransferResult()>& transfer) {
  try {
    return transfer();
  } catch (const UncoveredError& error) {
    throw InputError(InputPlace{target, 0, {}, -1}, std::string(error.what()) + " (--uncovered)");
  } catch (const InputError& error) {
    const std::string& message = error.message();
    const bool of_donor =
        message.find("donor mesh") != std::string::npos || message.find("transfer: ") == 0;
    throw error.in_file(of_donor ? donor : target);
  }
}

namespace {

/// Names of the files of the steps: STEM_0000.vtu, as many digits as needed.
std::vector<TimeStep> output_steps(const std::string& out, const std::vector<TimeStep>& steps) {
  const std::string stem = paths::path(out).stem().string();
  const std::size_t digits = std::max<std::size_t>(4, std::to_string(steps.size() - 1).size());
  std::vector<TimeStep> named;
  for (std::size_t i = 0; i < steps.size(); ++i)
    named.push_back({steps[i].time, fmt::format("{}_{:0{}}.vtu", stem, i, digits)});
  return named;
}

std::string beside(const std::string& collection, const std::string& file) {
  return (paths::path(collection).parent_path() / file).string();
}

/// An output may not replace what is still to be read.
void check_places(const SeriesFiles& files, const std::vector<TimeStep>& from,
                  const std::vector<TimeStep>& to) {
  std::vector<std::string> read = {files.donor, files.target};
  for (const TimeStep& step : from) read.push_back(beside(files.donor, step.file));
  for (const TimeStep& step : to) {
    const paths::path written = beside(files.out, step.file);
    for (const std::string& input : read) {
      std::error_code ignored;
      if (paths::equivalent(written, input, ignored))
        throw UsageError(fmt::format("-o {}: would replace the input {}", files.out, input));
    }
  }
}

std::string table(const std::vector<TimeStep>& steps,
                  const std::vector<std::vector<FieldReport>>& lines) {
  std::size_t width = 5;
  for (const auto& of_step : lines) {
    for (const FieldReport& f : of_step) width = std::max(width, f.name.size() + 3);
  }
  std::string text =
      fmt::format("{:>12}  {:<{}}  {:>17}  {:>17}  {:>8}  {:>12}  {:>12}\n", "time", "field", width,
                  "mass before", "mass after", "defect", "min", "max");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const FieldReport& f : lines[i]) {
      const auto same = [&](const FieldReport& k) { return k.name == f.name; };
      const std::string label = std::ranges::count_if(lines[i], same) > 1
                                    ? fmt::format("{}[{}]", f.name, f.component)
                                    : f.name;
      text +=
          fmt::format("{:>12.6g}  {:<{}}  {:>17.10g}  {:>17.10g}  {:>8.1e}  {:>12.6g}  {:>12.6g}\n",
                      steps[i].time, label, width, f.mass_before, f.mass_after,
                      f.relative_mass_defect, f.min_after, f.max_after);
    }
  }
  return text;
}

}  // namespace

int transfer_series(const SeriesFiles& files, const TransferOptions& options,
                    const std::function<Json(const TransferReport&)>& describe,
                    const Context& context, Processes* processes) {
  if (!is_collection(files.donor) || !is_collection(files.out)) {
    throw UsageError(
        is_collection(files.donor)
            ? "-o: a time series (.pvd) is moved to a time series, expected a .pvd file"
            : "-o: only a time series (.pvd) is moved to a .pvd file");
  }
  require_writable(files.out);
  if (!files.report.empty()) require_writable(files.report);
  const std::vector<TimeStep> steps = read_pvd(files.donor);
  const std::vector<TimeStep> written = output_steps(files.out, steps);
  check_places(files, steps, written);
  const Dataset target = read_noting(context, files.target);
  TransferSeries series(target.mesh, options, TransferSeries::default_memory, processes);

  FileSet set;
  Json entries = Json::array();
  std::vector<std::vector<FieldReport>> lines;
  std::vector<std::string> names;
  ProgressBar bar(context, "transfer");  // until the files are whole
  {
    const Progress shown = bar.callback();
    const auto read_step = [&](std::size_t i) {
      return read_noting(context, beside(files.donor, steps[i].file));
    };
    std::optional<Dataset> next = read_step(0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Dataset donor = std::move(*next);
      const std::string file = beside(files.donor, steps[i].file);
      next.reset();
      if (i + 1 < steps.size()) next = read_step(i + 1);
      const bool comes_again = next && detail::same_mesh(*donor.mesh, *next->mesh);
      const std::vector<Field> fields = chosen_fields(donor, file, files.fields);
      const auto count = static_cast<double>(steps.size());
      const Progress part = [&](double fraction) {
        return shown((static_cast<double>(i) + fraction) / count);
      };
      TransferResult moved =
          naming_files(file, files.target, [&] { return series.step(fields, comes_again, part); });
      tell(part, 1.0);
      Json entry = describe(moved.report);
      for (const char* key :
           {"schema", "donor", "target", "output", "matrix", "weight", "density", "bounds"})
        entry.erase(key);
      Json step = {{"time", steps[i].time}, {"donor", file}, {"output", written[i].file}};
      step.update(entry);
      entries.push_back(step);
      lines.push_back(moved.report.fields);
      Dataset out;
      out.mesh = target.mesh;
      out.fields = std::move(moved.fields);
      out.time = steps[i].time;
      const std::string path = beside(files.out, written[i].file);
      WriteOptions how;
      how.format = Format::vtu;
      const Encoded encoded = encode(path, out, how);
      set.add(path, encoded.bytes);
      notes(context, path, encoded.lost);
      names.push_back(path);
    }
  }
  bar.wipe();
  Json report = {{"schema", "bezel/transfer-series/1"},
                 {"donor", files.donor},
                 {"target", files.target},
                 {"output", files.out},
                 {"geometries", series.geometries()},
                 {"steps", entries}};
  if (processes != nullptr) report["processes"] = processes_json(*processes);
  if (!files.report.empty()) {
    set.add(files.report, to_text(report));
    names.push_back(files.report);
  }
  set.add(files.out, encode_pvd(written));
  names.push_back(files.out);
  set.commit();
  std::string text = context.json ? to_text(report) : table(steps, lines);
  if (processes != nullptr && !context.json) text += processes_table(*processes);
  print_or_remove(text, names);
  return ok;
}

}  // namespace bezel::cli
