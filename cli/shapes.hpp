#pragma once
// Curves and curved triangles as `intersect` reads them: JSON.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::cli {

/// A curve, or a triangle with control points in the order of bernstein/index.hpp.
struct Shape {
  bool triangle = false;
  int degree = 0;
  std::vector<Vec2> control;  ///< finite, as many as the degree asks for
  std::int64_t line = 0;      ///< where it begins in the file
  std::string place;          ///< "curve 0", "triangle 1", "pair 0, a", "a"
  std::string name;           ///< as given, or the place
};

/// What one file asks for.
struct Shapes {
  std::vector<Shape> shapes;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< empty: one curve with itself
  bool in_pairs = false;                                   ///< pair i is of shapes 2 i, 2 i + 1
  std::size_t rounded = 0;  ///< how many rationals are no doubles and were rounded
};

/// Largest number of curves or triangles in one list: all pairs of them are met.
inline constexpr std::size_t most_shapes = 1000;

/// Reads one of
///
///     {"curves": [{"control": [[x, y], ...], "degree": d, "name": "..."}, ...]}
///     {"triangles": [{"control": ..., "degree": g, "name": "..."}, ...]}
///     {"pairs": [{"a": {"curve": [[x, ...], [y, ...]]}, "b": {"curve": ...}}, ...]}
///     {"a": {"curve": ...}, "b": {"curve": ...}}
///
/// and in the last two "triangle" instead of "curve"; "degree" and "name" may be left out. A number
/// is a JSON number or a string that parse_number reads.
///
/// @param file  name, for messages
/// @throws  InputError with file, line and element ("curve 1, point 2, y", counted from 0)
Shapes read_shapes(const std::string& file, std::string_view json);

}  // namespace bezel::cli
