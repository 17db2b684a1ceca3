#include "cli/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/io/cursor.hpp"

namespace bezel::cli {

std::string exact_text(double value, bool hex) {
  std::string text;
  if (hex && std::isfinite(value)) {
    files::append_hex(text, value);
  } else {
    files::append_number(text, value);
  }
  return text;
}

std::string aligned(const std::vector<std::string>& header,
                    const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const std::string& cell : header) width.push_back(cell.size());
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t c = 0; c + 1 < row.size(); ++c)
      text += fmt::format("{:<{}}  ", row[c], width[c]);
    text += row.back() + "\n";
  };
  add(header);
  for (const auto& row : rows) add(row);
  return text;
}

}  // namespace bezel::cli
