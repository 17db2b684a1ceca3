#pragma once
// Colours and colour maps.

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace bezel::view {

/// An sRGB colour with opacity, each part in [0, 1].
struct Colour {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Reads "#rrggbb" (hexadecimal, either case), opaque.
/// @throws InputError for anything else
Colour parse_colour(std::string_view text);
/// "#rrggbb" of the colour, each part rounded to 8 bits; the opacity is dropped.
std::string hex(const Colour& colour);

/// A colour map: piecewise linear in sRGB between equally spaced knots.
class ColourMap {
 public:
  /// @param name  viridis, cividis, coolwarm or grey
  /// @throws InputError for another name, listing these four
  explicit ColourMap(std::string_view name);
  /// Colour at t; t outside [0, 1] takes the nearer end.
  /// @accuracy within 1.5/255 of the published 256-entry table at each of its entries
  Colour operator()(double t) const;
  int knot_count() const { return static_cast<int>(knots_.size() / 6); }
  /// Colour of knot k, 0 <= k < knot_count(), which stands at t = k / (knot_count() - 1).
  Colour knot(int k) const;

 private:
  std::string_view knots_;  // six hexadecimal digits a knot
};

}  // namespace bezel::view
