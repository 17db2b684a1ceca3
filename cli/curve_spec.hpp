#pragma once
// Curves as the commands curve and mesh read them: JSON, formulas, or the name of a shape.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"

namespace bezel::cli {

/// One curve, in the plane or in space.
struct CurveSpec {
  std::optional<SmoothCurve<2>> plane;  ///< one of the two is there
  std::optional<SmoothCurve<3>> space;
  /// Values of its own parameter at the ends; -1 and 1 when it has no name that users know.
  double from = -1.0, to = 1.0;
  std::string name;   ///< as given, or the place
  std::string place;  ///< "curve 1"
};

struct CurveSpecs {
  std::vector<CurveSpec> curves;  ///< at least one
  bool list = false;              ///< whether the input was a list
  std::size_t rounded = 0;        ///< how many rationals are no doubles and were rounded
};

/// Reads one curve, a list of curves, or {"curves": [...]}. docs/cli.md describes the forms.
/// @throws InputError with file, line and place ("curve 1, point 2, y", counted from 0)
CurveSpecs read_curve_specs(const std::string& file, std::string_view json);

/// A curve from one formula in t for each coordinate. @param breaks  values of t
/// @throws InputError "--y: column 3: ...": each formula's errors carry its name
CurveSpec formula_spec(const std::vector<std::pair<std::string, std::string>>& components,
                       double from, double to, const std::vector<double>& breaks);

/// "naca 0012 upper", "circle radius=2 to=pi/2": a name, then words and values; values are formulas
/// without variables. @throws InputError for what is not understood
SmoothCurve<2> named_shape(std::string_view text);

/// A formula without variables: "pi/3". @param what  for messages
double constant(const std::string& what, std::string_view text);

}  // namespace bezel::cli
