#include "bezel/view/colour.hpp"

#include "image.hpp"

namespace bezel::view {
namespace {

double lightness(const Colour& c) {
  return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

TEST(Colour, ReadsAndWritesHexadecimal) {
  EXPECT_EQ(hex(parse_colour("#1fA0ff")), "#1fa0ff");
  EXPECT_EQ(parse_colour("#ff0000"), (Colour{1.0, 0.0, 0.0, 1.0}));
  for (const char* bad : {"", "1fa0ff", "#1fa0f", "#1fa0fg", "#1fa0ff0"}) {
    EXPECT_EQ(test::message_of([&] { (void)parse_colour(bad); }),
              "colour \"" + std::string(bad) +
                  "\" is not of the form \"#rrggbb\" with hexadecimal digits");
  }
}

TEST(ColourMap, KnownEnds) {
  // The first and last entries of the published tables.
  EXPECT_EQ(hex(ColourMap("viridis")(0.0)), "#440154");
  EXPECT_EQ(hex(ColourMap("viridis")(1.0)), "#fde725");
  EXPECT_EQ(hex(ColourMap("grey")(0.0)), "#000000");
  EXPECT_EQ(hex(ColourMap("grey")(1.0)), "#ffffff");
  EXPECT_EQ(hex(ColourMap("viridis")(-3.0)), "#440154");
  EXPECT_EQ(hex(ColourMap("viridis")(3.0)), "#fde725");
}

TEST(ColourMap, SequentialMapsGetLighterAllTheWay) {
  for (const char* name : {"viridis", "cividis", "grey"}) {
    const ColourMap map(name);
    for (int k = 1; k < map.knot_count(); ++k) {
      // 8-bit tables repeat an entry here and there.
      EXPECT_GE(lightness(map.knot(k)), lightness(map.knot(k - 1)) - 1e-12) << name << " " << k;
      if (k >= 4) {
        EXPECT_GT(lightness(map.knot(k)), lightness(map.knot(k - 4))) << name << " " << k;
      }
    }
  }
}

TEST(ColourMap, DivergingMapIsLightestInTheMiddle) {
  const ColourMap map("coolwarm");
  EXPECT_GT(lightness(map(0.5)), lightness(map(0.0)));
  EXPECT_GT(lightness(map(0.5)), lightness(map(1.0)));
  EXPECT_GT(map(0.0).b, map(0.0).r);
  EXPECT_GT(map(1.0).r, map(1.0).b);
}

TEST(ColourMap, UnknownNamesAreListed) {
  EXPECT_EQ(test::message_of([] { const ColourMap map("jet"); }),
            "unknown colour map \"jet\", expected viridis, cividis, coolwarm or grey");
}

}  // namespace
}  // namespace bezel::view
