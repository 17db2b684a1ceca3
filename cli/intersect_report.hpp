#pragma once
// What `intersect` says about curves and about triangles: JSON, a table, and a picture.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/progress.hpp"
#include "bezel/view/draw_curves.hpp"
#include "cli/for_all.hpp"
#include "cli/output.hpp"
#include "cli/shapes.hpp"

namespace bezel::cli {

struct ReportOptions {
  std::string file;  ///< for messages
  double coincidence_distance = 0.0;
  bool difference = false;  ///< of triangles: what the second leaves of the first
  bool hex = false;
  int threads = 0;
  Progress progress;
};

struct IntersectReport {
  Json results = Json::array();  ///< one for each pair
  std::string text;
  CurvePicture picture;
  std::size_t unresolved = 0;  ///< places that could not be decided
};

/// Curves, pair by pair, or one curve with itself.
/// @throws InputError with the file and the names of the curves
IntersectReport report_curves(const Shapes& input, const ReportOptions& options);

/// Triangles, pair by pair.
/// @throws InputError with file, line and name for a triangle that is inverted somewhere
IntersectReport report_triangles(const Shapes& input, const ReportOptions& options);

/// "2 crossings, 1 tangency" of all that is not 0; `nothing` when all are.
std::string summary(const std::vector<std::pair<std::size_t, const char*>>& counts,
                    const std::string& nothing);

/// "NAME and NAME", or "pair 3" of an input in pairs.
std::string pair_name(const Shapes& input, std::size_t pair);

/// [x, y].
Json point_json(const Vec2& point, bool hex);

/// meet(a, b) of every pair of shapes, in order. @throws InputError with the file and the pair
template <class Found, class Meet>
std::vector<Found> meet_pairs(const Shapes& input, const ReportOptions& options, Meet meet) {
  std::vector<Found> found(input.pairs.size());
  for_all(found.size(), 32, options.threads, options.progress, [&](std::size_t i) {
    try {
      found[i] = meet(input.shapes[input.pairs[i].first], input.shapes[input.pairs[i].second]);
    } catch (const InputError& error) {
      throw InputError(InputPlace{options.file, 0, pair_name(input, i), -1}, error.message());
    }
  });
  return found;
}

}  // namespace bezel::cli
