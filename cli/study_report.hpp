#pragma once
// Tables and plots of a study: Markdown, CSV and JSON beside what was expected.

#include <concepts>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/view/draw.hpp"
#include "bezel/view/draw_curves.hpp"
#include "cli/output.hpp"

namespace bezel::cli {

/// A value as shown in Markdown, and as it stands in CSV and JSON.
struct Cell {
  std::string text;
  Json value;
};
/// Three digits, or "-" and null when it is not finite.
Cell number_cell(double value);
/// The double to round-trip.
Cell exact_cell(double value);
Cell count_cell(std::integral auto n) {
  return {std::to_string(n), n};
}
Cell text_cell(const std::string& text);
/// "yes" and true, or "no" and false.
Cell yes_cell(bool yes);

struct StudyColumn {
  std::string label, key;
  bool expected = false;  ///< what the paper, a formula or exact arithmetic says
};

struct StudyRow {
  std::vector<Cell> cells;
  bool shown = true;  ///< in Markdown; CSV and JSON hold every row
};

struct StudyTable {
  std::string file, title, remark;
  std::vector<StudyColumn> columns;
  std::vector<StudyRow> rows;
};

/// Appends a point to a line, its y at least `lowest` so that a logarithmic axis can show it; none
/// when y is not finite.
void add_point(Series& line, double x, double y, double lowest);

/// Collects all of a study, then writes it: nothing is left when something fails before.
class StudyReport {
 public:
  explicit StudyReport(std::string study) : study_(std::move(study)) {}

  void add(StudyTable table);
  /// A plot, shown below the table added last.
  void add_plot(const std::string& file, std::vector<Series> series, PlotOptions options);
  /// A picture of curves, shown in the same place.
  void add_picture(const std::string& file, const std::string& title, CurvePicture picture,
                   CurveDrawOptions options);
  /// Writes <study>.md, a CSV file for each table, the plots and the pictures to a folder, which it
  /// creates, and prints Markdown or one JSON object {"schema": "bezel/study/1", "study", "tables":
  /// [{"title", "columns", "rows", "paper"}]}: in rows (with the keys in columns) what was
  /// measured, in paper what was expected. Leaves nothing when it fails.
  void write(const std::string& folder, bool json) const;

 private:
  struct Plot {
    std::string file;
    std::vector<Series> series;
    PlotOptions options;
    std::size_t table;
  };
  struct Picture {
    std::string file, title;
    CurvePicture picture;
    CurveDrawOptions options;
    std::size_t table;
  };
  std::string markdown() const;
  Json document() const;

  std::string study_;
  std::vector<StudyTable> tables_;
  std::vector<Plot> plots_;
  std::vector<Picture> pictures_;
};

}  // namespace bezel::cli
