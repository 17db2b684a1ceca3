#include "bezel/view/font.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

namespace bezel::view {
namespace {

struct Glyph {
  int advance;  // em / 1000, those of a Helvetica-like sans serif, so that SVG viewers' fonts fit
                // the same layout
  const char* lines;  // em / 100: M move, L line, C cubic, A arc (centre, radii, from and to in
                      // degrees), a: joined to it
};

// Our own drawing: caps and digits stand between 4 and 68, lower case reaches 48, descenders -17.
constexpr std::array<Glyph, 95> ascii{{
    {278, ""},                                              // space
    {278, "M14 68L14 22M14 4L14 6"},                        // !
    {355, "M11 68L11 50M24 68L24 50"},                      // "
    {556, "M20 68L12 4M43 68L35 4M6 47L51 47M4 25L49 25"},  // #
    {556,
     "M46 54C43 62 37 64 28 64C15 64 9 58 9 51C9 42 17 39 28 36.5C40 34 48 31 48 21C48 12 40 8 "
     "28 8"
     "C16 8 9 13 7 22M28 74L28 -3"},                           // $
    {889, "A21 52 15 16 0 360A68 20 15 16 0 360M64 68L25 4"},  // %
    {667,
     "M62 4L22 50C16 58 20 68 30 68C40 68 43 58 36 51C30 45 10 40 10 22C10 10 18 4 29 4C44 4 "
     "53 18 55 34"},
    {191, "M10 68L10 50"},                                                     // '
    {333, "M26 72C8 50 8 10 26 -16"},                                          // (
    {333, "M7 72C25 50 25 10 7 -16"},                                          // )
    {389, "M19.5 69L19.5 45M9 63L30 51M30 63L9 51"},                           // *
    {584, "M29 47L29 7M9 27L49 27"},                                           // +
    {278, "M14 6L14 2L9 -9"},                                                  // ,
    {333, "M5 27L28 27"},                                                      // -
    {278, "M14 4L14 6"},                                                       // .
    {278, "M2 2L26 70"},                                                       // /
    {556, "A28 36 20 32 0 360"},                                               // 0
    {556, "M13 55C22 56 29 61 30 68L30 4"},                                    // 1
    {556, "A28 49 19 19 170 -35L9 4L48 4"},                                    // 2
    {556, "A27 52 17 16 160 -90a27 20 20 16 90 -160"},                         // 3
    {556, "M38 4L38 68L6 22L50 22"},                                           // 4
    {556, "M46 68L15 68L11 38.5a27 25 21 21 140 -152"},                        // 5
    {556, "A28 25 20 21 0 360M45 58C42 66 36 68 30 68C16 68 8 55 8 34L8 25"},  // 6
    {556, "M8 68L48 68C34 52 24 30 21 4"},                                     // 7
    {556, "A28 52 17 16 0 360A28 20 20 16 0 360"},                             // 8
    {556, "A28 47 20 21 0 360M11 14C14 6 20 4 26 4C40 4 48 17 48 38L48 47"},   // 9
    {278, "M14 4L14 6M14 42L14 44"},                                           // :
    {278, "M14 6L14 2L9 -9M14 42L14 44"},                                      // ;
    {584, "M50 46L9 27L50 8"},                                                 // <
    {584, "M9 36L49 36M9 18L49 18"},                                           // =
    {584, "M9 46L50 27L9 8"},                                                  // >
    {556, "A28 51 18 17 165 -45C36 34 28 31 28 20M28 4L28 6"},                 // ?
    {1015,
     "A49 28 15 19 0 360M66 47L62 20C62 10 74 10 82 18C98 36 88 72 52 72C20 72 6 46 6 26C6 -2 "
     "30 -16 52 -16"
     "C62 -16 70 -13 76 -9"},                  // @
    {667, "M5 4L33.3 68L62 4M14 25L52.6 25"},  // A
    {667,
     "M10 37L39 37M10 4L10 68L38 68a38 52.5 17 15.5 90 -90M38 37a41 20.5 19 16.5 90 -90L10 "
     "4"},                                                           // B
    {722, "A38 36 30 32 40 320"},                                    // C
    {722, "M10 4L10 68L32 68a32 36 32 32 90 -90L10 4"},              // D
    {667, "M58 68L10 68L10 4L60 4M10 37L55 37"},                     // E
    {611, "M56 68L10 68L10 4M10 36L50 36"},                          // F
    {778, "A39 36 31 32 42 338L69 34L44 34"},                        // G
    {722, "M10 4L10 68M62 4L62 68M10 37L62 37"},                     // H
    {278, "M14 4L14 68"},                                            // I
    {500, "M40 68L40 22a23 22 17 18 0 -180L6 26"},                   // J
    {667, "M10 4L10 68M60 68L10 26M26 40L62 4"},                     // K
    {556, "M10 68L10 4L52 4"},                                       // L
    {833, "M9 4L9 68L41.5 10L74 68L74 4"},                           // M
    {722, "M10 4L10 68L62 4L62 68"},                                 // N
    {778, "A39 36 31 32 0 360"},                                     // O
    {667, "M10 4L10 68L39 68a39 50 20 18 90 -90L10 32"},             // P
    {778, "A39 36 31 32 0 360M48 18L69 0"},                          // Q
    {722, "M10 4L10 68L42 68a42 51 19 17 90 -90L10 34M40 34L63 4"},  // R
    {667,
     "M58 54C54 64 46 68 34 68C18 68 9 61 9 51C9 41 18 38 33 35C50 32 60 29 60 19C60 9 49 4 34 "
     "4"
     "C18 4 9 11 7 22"},                            // S
    {611, "M4 68L57 68M30.5 68L30.5 4"},            // T
    {722, "M9 68L9 28a36 28 27 24 180 360L63 68"},  // U
    {667, "M5 68L33.3 4L62 68"},                    // V
    {944, "M4 68L25 4L47 66L69 4L90 68"},           // W
    {667, "M6 68L61 4M61 68L6 4"},                  // X
    {667, "M5 68L33.3 33L62 68M33.3 33L33.3 4"},    // Y
    {611, "M8 68L54 68L6 4L56 4"},                  // Z
    {278, "M24 72L10 72L10 -16L24 -16"},            // [
    {278, "M2 70L26 2"},                            // backslash
    {278, "M4 72L18 72L18 -16L4 -16"},              // ]
    {469, "M6 36L23 68L41 36"},                     // ^
    {556, "M0 -10L56 -10"},                         // _
    {333, "M10 72L20 58"},                          // `
    {556,
     "M9 38C12 46 20 48 27 48C38 48 44 43 44 34L44 12C44 7 46 4 51 4.5M44 29C40 25 32 25.5 24 "
     "24"
     "C14 22.5 8 19.5 8 13.5C8 7.5 13 4 21 4C34 4 44 11 44 20"},                     // a
    {556, "M9 68L9 4A29 26 20 22 0 360"},                                            // b
    {500, "A27 26 20 22 45 315"},                                                    // c
    {556, "A26 26 20 22 0 360M46 68L46 4"},                                          // d
    {556, "M8 27L48 27a28 26 20 22 3 318"},                                          // e
    {278, "M28 67C17 69 13 66 13 56L13 4M3 48L25 48"},                               // f
    {556, "A26 26 20 22 0 360M46 48L46 2C46 -12 38 -17 26 -17C17 -17 11 -14 8 -8"},  // g
    {556, "M9 68L9 4M9 29a28 29 19 19 180 0L47 4"},                                  // h
    {222, "M11 48L11 4M11 65L11 68"},                                                // i
    {222, "M12 48L12 -8C12 -16 9 -17 2 -17M12 65L12 68"},                            // j
    {500, "M9 68L9 4M43 48L9 18M21 29L46 4"},                                        // k
    {222, "M11 68L11 4"},                                                            // l
    {833, "M9 48L9 4M9 33a25 33 16 15 180 0L41 4M41 33a57 33 16 15 180 0L73 4"},     // m
    {556, "M9 48L9 4M9 29a28 29 19 19 180 0L47 4"},                                  // n
    {556, "A28 26 20.5 22 0 360"},                                                   // o
    {556, "M9 48L9 -17A29 26 20 22 0 360"},                                          // p
    {556, "A26 26 20 22 0 360M46 48L46 -17"},                                        // q
    {333, "M9 48L9 4M9 28C10 42 18 49 30 47"},                                       // r
    {500,
     "M42 38C40 45 34 48 25 48C14 48 8 44 8 37C8 30 15 28.5 25 26.5C36 24.5 43 22.5 43 15"
     "C43 8 36 4 25.5 4C14 4 8 8 6 16"},                   // s
    {278, "M13 62L13 14C13 5 16 3 25 4.5M3 48L25 48"},     // t
    {556, "M9 48L9 23a28 23 19 19 180 360L47 48L47 4"},    // u
    {500, "M5 48L25 4L45 48"},                             // v
    {722, "M4 48L19 4L36 46L53 4L68 48"},                  // w
    {500, "M6 48L44 4M44 48L6 4"},                         // x
    {500, "M5 48L25 6M45 48L25 4C21 -10 17 -18 6 -16.5"},  // y
    {500, "M7 48L43 48L6 4L44 4"},                         // z
    {334,
     "M29 72C18 72 16 68 16 58L16 42C16 34 14 29 6 28C14 27 16 22 16 14L16 -2C16 -12 18 -16 29 "
     "-16"},                 // {
    {260, "M13 72L13 -16"},  // |
    {334,
     "M4 72C15 72 17 68 17 58L17 42C17 34 19 29 27 28C19 27 17 22 17 14L17 -2C17 -12 15 -16 4 "
     "-16"},                                             // }
    {584, "M7 22C13 36 22 36 29 27C36 18 45 18 51 32"},  // ~
}};
constexpr Glyph minus_sign{584, "M9 27L49 27"};
constexpr Glyph times_sign{584, "M14 42L44 12M44 42L14 12"};
constexpr Glyph unknown{600, "M9 4L9 62L51 62L51 4L9 4"};

const Glyph& glyph(std::uint32_t code) {
  if (code >= 32 && code < 127) return ascii[code - 32];
  if (code == 0x2212) return minus_sign;
  if (code == 0xd7) return times_sign;
  return unknown;
}

constexpr char32_t replacement = U'?';

void append_utf8(std::uint32_t code, std::string& out) {
  const auto put = [&](std::uint32_t byte) {
    out += static_cast<char>(static_cast<unsigned char>(byte));
  };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | (code >> 6));
    put(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    put(0xe0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3f));
    put(0x80 | (code & 0x3f));
  } else {
    put(0xf0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3f));
    put(0x80 | ((code >> 6) & 0x3f));
    put(0x80 | (code & 0x3f));
  }
}

}  // namespace

std::vector<std::uint32_t> decode_utf8(std::string_view text) {
  std::vector<std::uint32_t> codes;
  std::size_t i = 0;
  while (i < text.size()) {
    const auto byte = [&](std::size_t k) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k]));
    };
    const std::uint32_t first = byte(i);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    bool good = length > 0 && i + length <= text.size();
    std::uint32_t code = length <= 1 ? first : first & (0x7fu >> length);
    for (std::size_t k = 1; good && k < length; ++k) {
      good = (byte(i + k) & 0xc0) == 0x80;
      code = (code << 6) | (byte(i + k) & 0x3f);
    }
    // Overlong forms, surrogates, beyond the last plane, and the two codes XML forbids.
    if (good &&
        ((length == 3 && code < 0x800) || (length == 4 && (code < 0x10000 || code > 0x10ffff)) ||
         (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff))
      good = false;
    if (!good) {
      codes.push_back(replacement);
      ++i;
    } else {
      const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
      codes.push_back(control ? std::uint32_t{' '} : code);
      i += length;
    }
  }
  return codes;
}

std::string clean_utf8(std::string_view text) {
  std::string out;
  for (std::uint32_t code : decode_utf8(text)) append_utf8(code, out);
  return out;
}

double advance(std::uint32_t code) {
  return glyph(code).advance / 1000.0;
}

std::vector<std::vector<Vec2>> strokes(std::uint32_t code) {
  std::vector<std::vector<Vec2>> out;
  const char* at = glyph(code).lines;
  const char* const stop = at + std::strlen(at);
  const auto number = [&] {
    while (*at == ' ') ++at;
    double value = 0.0;
    at = std::from_chars(at, stop, value).ptr;
    return value / 100.0;
  };
  const auto point = [&] {
    const double x = number(), y = number();
    return Vec2{{x, y}};
  };
  while (*at != '\0') {
    const char command = *at++;
    if (command == 'M') {
      out.push_back({point()});
    } else if (command == 'L') {
      out.back().push_back(point());
    } else if (command == 'C') {
      const Vec2 a = out.back().back(), b = point(), c = point(), d = point();
      constexpr int pieces = 10;
      for (int k = 1; k <= pieces; ++k) {
        const double s = static_cast<double>(k) / pieces, r = 1.0 - s;
        out.back().push_back((r * r * r) * a + (3 * r * r * s) * b + (3 * r * s * s) * c +
                             (s * s * s) * d);
      }
    } else {
      const Vec2 centre = point(), radius = point();
      const double from = 100.0 * number(), to = 100.0 * number();
      const int pieces = static_cast<int>(std::ceil(std::abs(to - from) / 10.0));
      if (command == 'A') out.emplace_back();
      for (int k = 0; k <= pieces; ++k) {
        const double angle = (from + (to - from) * k / pieces) * std::numbers::pi / 180.0;
        out.back().push_back(Vec2{{centre.x() + radius.x() * std::cos(angle),
                                   centre.y() + radius.y() * std::sin(angle)}});
      }
    }
  }
  return out;
}

}  // namespace bezel::view
