#include "cli/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

std::string csv_text(const Cell& cell) {
  if (cell.value.is_null()) return {};
  if (cell.value.is_number_float()) return exact_text(cell.value);
  if (!cell.value.is_string() && !cell.value.is_object()) return cell.value.dump();
  return cell.text.find(',') == std::string::npos ? cell.text : '"' + cell.text + '"';
}

std::string csv(const StudyTable& table) {
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    text += (c > 0 ? "," : "") + table.columns[c].key;
  for (const StudyRow& row : table.rows) {
    for (std::size_t c = 0; c < row.cells.size(); ++c)
      text += (c > 0 ? "," : "\n") + csv_text(row.cells[c]);
  }
  return text + "\n";
}

}  // namespace

Cell number_cell(double value) {
  if (!std::isfinite(value)) return {"-", {}};
  return {value == 0.0 ? "0" : fmt::format("{:.2e}", value), value};
}
Cell exact_cell(double value) {
  return {exact_text(value), value};
}
Cell text_cell(const std::string& text) {
  return {text, text};
}
Cell yes_cell(bool yes) {
  return {yes ? "yes" : "no", yes};
}

void add_point(Series& line, double x, double y, double lowest) {
  if (!std::isfinite(y)) return;
  line.x.push_back(x);
  line.y.push_back(std::max(y, lowest));
}

void StudyReport::add(StudyTable table) {
  for (const StudyRow& row : table.rows)
    if (row.cells.size() != table.columns.size())
      throw InternalError("a row of the study's table " + table.file + " has the wrong length");
  tables_.push_back(std::move(table));
}

void StudyReport::add_plot(const std::string& file, std::vector<Series> series,
                           PlotOptions options) {
  plots_.push_back({file, std::move(series), std::move(options), tables_.size()});
}

void StudyReport::add_picture(const std::string& file, const std::string& title,
                              CurvePicture picture, CurveDrawOptions options) {
  pictures_.push_back({file, title, std::move(picture), options, tables_.size()});
}

std::string StudyReport::markdown() const {
  std::string text;
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const StudyTable& table = tables_[t];
    text += "### " + table.title + "\n\n";
    if (!table.remark.empty()) text += table.remark + "\n\n";
    std::string rule = "|";
    text += "|";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text +=
          " " + table.columns[c].label + (table.columns[c].expected ? " (expected)" : "") + " |";
      rule += c == 0 ? "---|" : "---:|";
    }
    text += "\n" + rule + "\n";
    for (const StudyRow& row : table.rows) {
      if (!row.shown) continue;
      text += "|";
      for (const Cell& cell : row.cells) text += " " + cell.text + " |";
      text += "\n";
    }
    text += "\n";
    for (const Plot& p : plots_)
      if (p.table == t + 1) text += fmt::format("![{}]({})\n\n", p.options.title, p.file);
    for (const Picture& p : pictures_)
      if (p.table == t + 1) text += fmt::format("![{}]({})\n\n", p.title, p.file);
  }
  return text;
}

Json StudyReport::document() const {
  Json tables = Json::array();
  for (const StudyTable& table : tables_) {
    Json columns = Json::array(), rows = Json::array(), paper = Json::array();
    for (const StudyColumn& column : table.columns)
      if (!column.expected) columns.push_back(column.key);
    for (const StudyRow& row : table.rows) {
      Json ours = Json::object(), theirs = Json::object();
      for (std::size_t c = 0; c < row.cells.size(); ++c)
        (table.columns[c].expected ? theirs : ours)[table.columns[c].key] = row.cells[c].value;
      rows.push_back(std::move(ours));
      paper.push_back(std::move(theirs));
    }
    tables.push_back(
        {{"title", table.title}, {"columns", columns}, {"rows", rows}, {"paper", paper}});
  }
  return {{"schema", "bezel/study/1"}, {"study", study_}, {"tables", tables}};
}

void StudyReport::write(const std::string& folder, bool json) const {
  std::error_code error;
  const bool made = std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError(InputPlace{folder, 0, {}, -1}, "the folder cannot be made");
  const std::string text = markdown();
  std::vector<std::string> files;
  const auto path = [&](const std::string& name) {
    return files.emplace_back((std::filesystem::path(folder) / name).string());
  };
  try {
    write_file(path(study_ + ".md"), text);
    for (const StudyTable& table : tables_) write_file(path(table.file + ".csv"), csv(table));
    for (const Plot& p : plots_) plot(path(p.file), p.series, p.options);
    for (const Picture& p : pictures_) draw_curves(path(p.file), p.picture, p.options);
    print(json ? to_text(document()) : text);
  } catch (...) {
    for (const std::string& file : files) std::filesystem::remove(file, error);
    if (made) std::filesystem::remove(folder, error);
    throw;
  }
}

}  // namespace bezel::cli
