#include "bezel/view/canvas.hpp"

#include <algorithm>
#include <fstream>
#include <pugixml.hpp>

#include "bezel/bernstein/interval.hpp"
#include "image.hpp"

namespace bezel::view {
namespace {

TEST(Canvas, SvgHoldsWhatWasDrawn) {
  const auto canvas = make_svg_canvas(200, 100);
  Path path;
  path.move({{10, 10}});
  const std::array<Vec2, 4> cubic = {{{{10, 10}}, {{20, 0}}, {{30, 20}}, {{40, 10}}}};
  path.curve(cubic);
  canvas->stroke(path, {parse_colour("#ff0000"), 2.0, {}});
  Path box;
  box.rectangle([] {
    Box2 b;
    b.include({{50, 50}});
    b.include({{60, 70}});
    return b;
  }());
  canvas->fill(box, parse_colour("#00ff00"));
  canvas->text({{100, 50}}, "a < b & c", {});
  const std::string text = canvas->finish();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  EXPECT_STREQ(document.child("svg").attribute("width").value(), "200");
  EXPECT_NE(text.find("C20 0 30 20 40 10"), std::string::npos) << text;
  EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
}

TEST(Canvas, PngHoldsWhatWasDrawn) {
  const auto canvas = make_png_canvas(60, 40);
  Path box;
  Box2 b;
  b.include({{10, 10}});
  b.include({{30, 20}});
  box.rectangle(b);
  canvas->fill(box, parse_colour("#3366cc"));
  const std::string path = test::scratch("canvas.png");
  {
    std::ofstream file(path, std::ios::binary);
    file << canvas->finish();
  }
  const test::Image image(path);
  EXPECT_EQ(image.width, 60);
  EXPECT_EQ(image.height, 40);
  EXPECT_EQ(image.at(20, 15), (std::array<int, 3>{0x33, 0x66, 0xcc}));
  EXPECT_EQ(image.at(5, 5), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(image.at(31, 15), (std::array<int, 3>{255, 255, 255}));
}

TEST(Canvas, ExtensionsAreChecked) {
  check_extension("a.SVG");
  check_extension("a.png");
  EXPECT_EQ(test::message_of([] { check_extension("picture.gif"); }),
            "picture.gif: unknown extension \".gif\", expected .svg or .png");
  EXPECT_EQ(test::message_of([] { check_extension("picture"); }),
            "picture: no file extension, expected .svg or .png");
}

TEST(Flatten, StaysWithinTheTolerance) {
  const std::vector<Vec2> c = {{{0, 0}}, {{100, 200}}, {{-50, 150}}, {{80, 0}}};
  for (const double tolerance : {1.0, 0.1, 0.01}) {
    std::vector<Vec2> points = {c.front()};
    flatten(c, tolerance, points);
    EXPECT_EQ(points.back(), c.back());
    for (int i = 0; i <= 500; ++i) {
      const Vec2 p = bernstein::evaluate<Vec2>(c, i / 500.0);
      double nearest = 1e9;
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec2 d = points[k + 1] - points[k];
        const double t = std::clamp(dot(p - points[k], d) / dot(d, d), 0.0, 1.0);
        nearest = std::min(nearest, norm(p - (points[k] + d * t)));
      }
      EXPECT_LE(nearest, tolerance);
    }
  }
}

TEST(TextWidth, GrowsWithTextAndSize) {
  TextStyle style;
  EXPECT_LT(text_width("i", style), text_width("w", style));
  const double small = text_width("quadratic", style);
  style.size *= 2;
  EXPECT_NEAR(text_width("quadratic", style), 2 * small, 1e-9);
}

}  // namespace
}  // namespace bezel::view
