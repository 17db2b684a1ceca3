#include "bezel/view/font.hpp"

#include <gtest/gtest.h>

namespace bezel::view {
namespace {

TEST(Font, EveryPrintableCharacterHasStrokesInItsCell) {
  const auto unknown = strokes(0x1F600);
  for (std::uint32_t code = 33; code < 127; ++code) {
    const auto lines = strokes(code);
    EXPECT_FALSE(lines.empty()) << code;
    EXPECT_NE(lines, unknown) << code;
    EXPECT_GT(advance(code), 0.15) << code;
    EXPECT_LT(advance(code), 1.2) << code;
    for (const auto& line : lines) {
      for (const Vec2& p : line) {
        EXPECT_GE(p[0], -0.15) << code;
        EXPECT_LE(p[0], advance(code) + 0.15) << code;
        EXPECT_GE(p[1], -0.35) << code;
        EXPECT_LE(p[1], 1.05) << code;
      }
    }
  }
  EXPECT_TRUE(strokes(' ').empty());
}

TEST(Utf8, IsDecodedAndCleaned) {
  EXPECT_EQ(decode_utf8("a\xc3\xa9"), (std::vector<std::uint32_t>{'a', 0xE9}));
  EXPECT_EQ(clean_utf8("a\nb\xff"), "a b?");
}

}  // namespace
}  // namespace bezel::view
