#include "bezel/view/colour.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"

namespace bezel::view {
namespace {

// viridis (S. van der Walt and N. Smith) and cividis (J. R. Nunez, C. R. Anderton and R. S.
// Renslow), both released under CC0: every fifth entry of the 256-entry table of viridis, which
// piecewise linear interpolation gives back within 0.92/255, and the whole one of cividis, which
// has a kink.
constexpr std::string_view viridis_knots =
    "44015446085c471063481769481d6f482475472a7a46307e453781433d844142873f48893d4e8a3a538b38598c"
    "355e8d33638d31688e2e6d8e2c718e2a768e297b8e27808e25848e23898e218e8d20928c1f978b1e9c891fa188"
    "21a58524aa8328ae802eb37c35b7793dbc7446c06f50c46a5ac86465cb5e70cf577cd25089d54895d840a2da37"
    "b0dd2fbddf26cae11fd8e219e5e419f1e51dfde725";
constexpr std::string_view cividis_knots =
    "00224e00234f00245100255300255400265600275800285900285b00295d002a5f002a61002b62002c64002c66"
    "002d68002e6a002e6c002f6d00306f0030700031700031710132710533710833700c34700f3570123570143670"
    "16377018376f1a386f1c396f1e3a6f203a6f213b6e233c6e243c6e263d6e273e6e293f6e2a3f6d2b406d2d416d"
    "2e416d2f426d31436d32436d33446d34456c35456c36466c38476c39486c3a486c3b496c3c4a6c3d4a6c3e4b6c"
    "3f4c6c404c6c414d6c424e6c434e6c444f6c45506c46516c47516c48526c49536c4a536c4b546c4c556c4d556c"
    "4e566c4f576c50576c51586d52596d535a6d545a6d555b6d555c6d565c6d575d6d585e6d595e6e5a5f6e5b606e"
    "5c616e5d616e5e626e5e636f5f636f60646f61656f62656f636670646770656870656870666970676a71686a71"
    "696b716a6c716b6d726c6d726c6e726d6f726e6f736f7073707173717274727274727374737475747475757575"
    "7676767777767777777878777979777a7a787b7a787c7b787d7c787e7c787e7d787f7e78807f78817f78828079"
    "8381798482798582798683798784788885788985788a86788b87788c88788d88788e89788f8a78908b78918b78"
    "928c78928d78938e78948e77958f779690779791779892779992779a93769b94769c95769d95769e96769f9775"
    "a09875a19975a29975a39a74a49b74a59c74a69c74a79d73a89e73a99f73aaa073aba072aca172ada272aea371"
    "afa471b0a571b1a570b3a670b4a76fb5a86fb6a96fb7a96eb8aa6eb9ab6dbaac6dbbad6dbcae6cbdae6cbeaf6b"
    "bfb06bc0b16ac1b26ac2b369c3b369c4b468c5b568c6b667c7b767c8b866c9b965cbb965ccba64cdbb63cebc63"
    "cfbd62d0be62d1bf61d2c060d3c05fd4c15fd5c25ed6c35dd7c45cd9c55cdac65bdbc75adcc859ddc858dec958"
    "dfca57e0cb56e1cc55e2cd54e4ce53e5cf52e6d051e7d150e8d24fe9d34eead34cebd44bedd54aeed649efd748"
    "f0d846f1d945f2da44f3db42f5dc41f6dd3ff7de3ef8df3cf9e03afbe138fce236fde334fee434fee535fee636"
    "fee838";
// The smooth cool-warm map of K. Moreland, "Diverging Color Maps for Scientific Visualization"
// (2009), sampled from its construction: straight lines in Msh space from (59, 76, 192) over white
// to (180, 4, 38).
constexpr std::string_view coolwarm_knots =
    "3b4cc03d4fc34053c64256c9445acc475dcf4961d24b64d54e68d7506bda536edc5572df5875e15a78e35d7be6"
    "5f7fe86282ea6485ec6788ee6a8bef6c8ef16f91f37294f47497f5779af77a9df87da0f97fa3fa82a5fb85a8fc"
    "88abfd8aadfd8db0fe90b2fe93b4ff95b7ff98b9ff9bbbff9ebdffa0c0ffa3c2ffa6c4fea8c6feabc7fdaec9fd"
    "b0cbfcb3ccfbb6cefab8d0f9bbd1f8bdd2f7c0d4f5c2d5f4c5d6f3c7d7f1c9d8efccd9eeced9ecd0daead2dbe8"
    "d5dbe6d7dce4d9dce1dbdcdfdddddddfdcdae1dbd7e3dad4e5d8d1e7d7cee9d6cbead4c9ecd3c6edd1c3eed0bf"
    "f0cebcf1ccb9f2cab6f3c8b3f4c6b0f5c4adf5c2aaf6c0a7f6bea4f7bba0f7b99df7b69af7b497f7b194f7ae91"
    "f7ac8df7a98af7a687f6a384f6a081f59d7ef49a7bf49778f39375f29072f18d6ff0896cee8669ed8266ec7f63"
    "ea7b60e9785de7745ae57057e46c55e26852e0654fde614cdc5c4ad95847d75445d55042d34b3fd0473dce423a"
    "cb3e38c83936c63333c32e31c0282fbd222cba1a2ab71128b40426";
constexpr std::string_view grey_knots = "000000ffffff";

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

double channel(std::string_view digits) {
  return (16 * hex_digit(digits[0]) + hex_digit(digits[1])) / 255.0;
}

Colour from_digits(std::string_view digits) {
  return {channel(digits.substr(0)), channel(digits.substr(2)), channel(digits.substr(4)), 1.0};
}

}  // namespace

Colour parse_colour(std::string_view text) {
  const bool good =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](char c) { return hex_digit(c) >= 0; });
  if (!good)
    throw InputError("colour \"" + std::string(text) +
                     "\" is not of the form \"#rrggbb\" with hexadecimal digits");
  return from_digits(text.substr(1));
}

std::string hex(const Colour& colour) {
  std::string text = "#";
  for (double part : {colour.r, colour.g, colour.b}) {
    const int value = static_cast<int>(std::lround(255.0 * std::clamp(part, 0.0, 1.0)));
    text += "0123456789abcdef"[value / 16];
    text += "0123456789abcdef"[value % 16];
  }
  return text;
}

ColourMap::ColourMap(std::string_view name) {
  if (name == "viridis") {
    knots_ = viridis_knots;
  } else if (name == "cividis") {
    knots_ = cividis_knots;
  } else if (name == "coolwarm") {
    knots_ = coolwarm_knots;
  } else if (name == "grey") {
    knots_ = grey_knots;
  } else {
    throw InputError("unknown colour map \"" + std::string(name) +
                     "\", expected viridis, cividis, coolwarm or grey");
  }
}

Colour ColourMap::knot(int k) const {
  return from_digits(knots_.substr(6 * static_cast<std::size_t>(k), 6));
}

Colour ColourMap::operator()(double t) const {
  const int last = knot_count() - 1;
  const double place = std::clamp(t, 0.0, 1.0) * last;
  const int k = std::min(static_cast<int>(place), last - 1);
  const double f = place - k;
  const Colour a = knot(k), b = knot(k + 1);
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b), 1.0};
}

}  // namespace bezel::view
