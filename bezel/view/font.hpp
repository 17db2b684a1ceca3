#pragma once
// A stroke font for pictures without fonts of their own.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::view {

/// Code points of UTF-8 text; a control character becomes a space, a byte that is no UTF-8 a
/// question mark.
std::vector<std::uint32_t> decode_utf8(std::string_view text);
/// The same text as valid UTF-8, cleaned as decode_utf8 does.
std::string clean_utf8(std::string_view text);

/// Advance of a character in em.
double advance(std::uint32_t code);
/// Centre lines of a character as polylines, in em, y upwards from the baseline; an unknown
/// character is a box.
std::vector<std::vector<Vec2>> strokes(std::uint32_t code);
/// Width of the pen in em.
inline constexpr double pen_width = 0.082, bold_pen_width = 0.118;

}  // namespace bezel::view
