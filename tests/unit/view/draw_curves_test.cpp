#include "bezel/view/draw_curves.hpp"

#include <filesystem>
#include <pugixml.hpp>

#include "bezel/base/atomic_file.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "image.hpp"

namespace bezel {
namespace {

using test::message_of;
using test::scratch;

const std::vector<Vec2> parabola{Vec2{{-1, 1}}, Vec2{{0, -1}}, Vec2{{1, 1}}};
const std::vector<Vec2> line{Vec2{{-1, 0.25}}, Vec2{{1, 0.25}}};

CurvePicture crossing_curves() {
  CurvePicture picture;
  picture.shapes = {{"parabola", {parabola}}, {"line", {line}}};
  EXPECT_EQ(add_intersections(picture, parabola, intersect(parabola, line)), 3);
  return picture;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++n;
  return n;
}

TEST(DrawCurves, SvgHoldsTheCurvesTheMarksAndTheLegend) {
  const std::string path = scratch("curves.svg");
  draw_curves(path, crossing_curves());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(path.c_str()));
  const std::string text = read_file(path);
  for (const char* word : {">parabola<", ">line<", ">control polygon<", ">crossing<", ">1<", ">2<"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
  EXPECT_EQ(text.find(">tangency<"), std::string::npos);
  // The parabola is one quadratic piece.
  EXPECT_EQ(count(text, "Q"), 1U);
  CurveDrawOptions without;
  without.control_polygons = false;
  draw_curves(path, crossing_curves(), without);
  EXPECT_EQ(read_file(path).find("control polygon"), std::string::npos);
}

// Both axes have one scale, and y points upwards: the square's corners.
TEST(DrawCurves, ScalesAreEqual) {
  CurvePicture picture;
  const std::vector<Vec2> a{Vec2{{0, 0}}, Vec2{{4, 2}}}, b{Vec2{{0, 2}}, Vec2{{4, 0}}};
  picture.shapes = {{"", {a}}, {"", {b}}};
  CurveDrawOptions options;
  options.control_polygons = false;
  const std::string path = scratch("cross.svg");
  draw_curves(path, picture, options);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(path.c_str()));
  std::vector<std::array<double, 4>> lines;
  for (const pugi::xml_node node : document.child("svg").children("path")) {
    std::array<double, 4> p{};
    if (std::string(node.attribute("stroke").value()) != "#0072b2" &&
        std::string(node.attribute("stroke").value()) != "#d55e00")
      continue;
    ASSERT_EQ(
        std::sscanf(node.attribute("d").value(), "M%lf %lfL%lf %lf", &p[0], &p[1], &p[2], &p[3]),
        4);
    lines.push_back(p);
  }
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_GT(lines[0][1], lines[0][3]);  // a rises
  EXPECT_LT(lines[1][1], lines[1][3]);
  EXPECT_NEAR((lines[0][2] - lines[0][0]) / (lines[0][1] - lines[0][3]), 2.0, 1e-3);
}

TEST(DrawCurves, PngShowsTheColours) {
  const std::string path = scratch("curves.png");
  CurveDrawOptions options;
  options.width = 600;
  CurvePicture picture = crossing_curves();
  picture.regions.push_back({{line, {line[1], Vec2{{1, -0.5}}}, {Vec2{{1, -0.5}}, line[0]}}});
  picture.region_name = "common part";
  draw_curves(path, picture, options);
  const test::Image image(path);
  EXPECT_EQ(image.width, 600);
  int blue = 0, orange = 0, green = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      blue += test::difference(image.at(x, y), view::parse_colour("#0072b2")) < 20 ? 1 : 0;
      orange += test::difference(image.at(x, y), view::parse_colour("#d55e00")) < 20 ? 1 : 0;
      green += test::difference(image.at(x, y), {0.6, 0.848, 0.78, 1.0}) < 3 ? 1 : 0;
    }
  EXPECT_GT(blue, 100);
  EXPECT_GT(orange, 100);
  EXPECT_GT(green, 10000);
}

// A control polygon far outside is cut at the frame; curves are never.
TEST(DrawCurves, NothingIsDrawnOutsideTheFrame) {
  CurvePicture picture;
  const std::vector<Vec2> cubic{Vec2{{-3, -3}}, Vec2{{-1, 15}}, Vec2{{1, -15}}, Vec2{{3, 3}}};
  picture.shapes = {{"cubic", {cubic}}};
  const std::string path = scratch("cubic.png");
  draw_curves(path, picture);
  const test::Image image(path);
  const auto coloured = [&](int x, int y) {
    const auto c = image.at(x, y);
    return std::abs(c[0] - c[2]) > 30;
  };
  for (int x = 0; x < image.width; ++x)
    for (const int y : {image.height - 20, image.height - 1}) EXPECT_FALSE(coloured(x, y));
  for (int y = 60; y < image.height; ++y)
    for (const int x : {0, 10, image.width - 1}) EXPECT_FALSE(coloured(x, y));
}

TEST(DrawCurves, MarksAtOnePlaceShareALabel) {
  CurvePicture picture;
  picture.shapes = {{"line", {line}}};
  for (int i = 1; i <= 3; ++i)
    picture.marks.push_back({MarkKind::crossing, Vec2{{0.25, 0.25}}, std::to_string(i)});
  picture.marks.push_back({MarkKind::tangency, Vec2{{0.25, 0.25}}, "4"});
  const std::string path = scratch("shared.svg");
  draw_curves(path, picture);
  const std::string text = read_file(path);
  EXPECT_NE(text.find(">1, 2, 3<"), std::string::npos);
  EXPECT_NE(text.find(">4<"), std::string::npos);
}

TEST(DrawCurves, ExtremeAndDegenerateInput) {
  for (const double scale : {0x1p-400, 1.0, 0x1p400})
    for (const double shift : {0.0, 0x1p30, 0x1p50}) {
      CurvePicture picture;
      std::vector<Vec2> curve;
      for (const Vec2& p : parabola) curve.push_back(scale * (p + Vec2{{shift, -shift}}));
      picture.shapes = {{"a", {curve}}, {"point", {{curve[0]}}}};
      for (const char* name : {"extreme.svg", "extreme.png"}) draw_curves(scratch(name), picture);
      const std::string text = read_file(scratch("extreme.svg"));
      EXPECT_EQ(text.find("nan"), std::string::npos);
      EXPECT_EQ(text.find("inf"), std::string::npos);
    }
  CurvePicture point;
  point.shapes = {{"point", {{Vec2{{3, 4}}}}}};
  draw_curves(scratch("point.svg"), point);
  point.shapes = {{"flat", {{Vec2{{0, 0}}, Vec2{{1, 0}}}}}};
  CurveDrawOptions narrow;
  narrow.width = 64;
  draw_curves(scratch("flat.png"), point, narrow);
  // Degree 60.
  point.shapes = {{"high", {std::vector<Vec2>(61, Vec2{{1, 1}})}}};
  point.shapes[0].curves[0].back() = Vec2{{2, 3}};
  draw_curves(scratch("high.svg"), point);
}

TEST(DrawCurves, BadInputIsNamed) {
  CurvePicture picture = crossing_curves();
  EXPECT_EQ(message_of([&] { draw_curves("x.gif", picture); }),
            "x.gif: unknown extension \".gif\", expected .svg or .png");
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", {}); }),
            "nothing to draw: 0 shapes, expected at least 1");
  CurveDrawOptions options;
  options.width = 63;
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", picture, options); }),
            "width 63, expected 64 to 16384 pixels");
  picture.shapes[1].curves[0].clear();
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", picture); }),
            "shape 1: 0 control points, expected 1 to 61");
  picture.shapes[1].curves.clear();
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", picture); }),
            "shape 1: 0 curves, expected at least 1");
  picture = crossing_curves();
  picture.marks[0].point = Vec2{{NAN, 0}};
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", picture); }),
            "a point to draw is beyond 1e280 or not finite");
  picture = {};
  picture.shapes = {{"", {{Vec2{{0, 0}}, Vec2{{1e-290, 0}}}}}};
  EXPECT_EQ(message_of([&] { draw_curves("x.svg", picture); }),
            "the curves to draw spread over less than 1e-280");
  EXPECT_FALSE(std::filesystem::exists("x.svg"));
}

TEST(CurveMarks, NumbersGoOnInTheOrderOfTheLists) {
  CurvePicture picture;
  CurveIntersections found;
  found.crossings.push_back({0.5, 0.5, 0, 1, 0, 1, 1, true, Vec2{{0, 0}}, Vec2{{0, 0}}, 1});
  found.tangencies.push_back({0.25, 0.5, 2});
  found.overlaps.push_back({0.0, 0.5, 0.5, 1.0, 0.0});
  found.unresolved.push_back({0.75, 0.75, 0, 1, "reason"});
  EXPECT_EQ(add_intersections(picture, line, found, 7), 11);
  ASSERT_EQ(picture.marks.size(), 3U);
  EXPECT_EQ(picture.marks[0].label, "7");
  EXPECT_EQ(picture.marks[1].label, "8");
  EXPECT_EQ(picture.marks[1].kind, MarkKind::tangency);
  EXPECT_EQ(picture.marks[1].point, (Vec2{{-0.5, 0.25}}));
  ASSERT_EQ(picture.bands.size(), 1U);
  EXPECT_EQ(picture.bands[0].label, "9");
  EXPECT_EQ(picture.bands[0].curve.back(), (Vec2{{0, 0.25}}));
  EXPECT_EQ(picture.marks[2].label, "10");
  EXPECT_EQ(picture.marks[2].kind, MarkKind::unresolved);

  CurvePicture self;
  const std::vector<Vec2> cusp{Vec2{{0, 0}}, Vec2{{1, 1}}, Vec2{{0, 1}}, Vec2{{1, 0}}};
  EXPECT_EQ(add_self_intersections(self, cusp, self_intersections(cusp)), 2);
  EXPECT_EQ(self.marks[0].kind, MarkKind::cusp);
  EXPECT_EQ(self.marks[0].point, (Vec2{{0.5, 0.75}}));
}

TEST(CurveMarks, TrianglesHaveThreeSidesAndPolygonsTheirVertices) {
  const std::vector<Vec2> a{Vec2{{0, 0}},   Vec2{{2, 0.5}}, Vec2{{4, 0}},
                            Vec2{{0.5, 2}}, Vec2{{2.5, 2}}, Vec2{{0, 4}}};
  const DrawnShape shape = drawn_triangle("a", 2, a);
  EXPECT_TRUE(shape.filled);
  EXPECT_EQ(shape.curves, (std::vector<std::vector<Vec2>>{
                              {a[0], a[1], a[2]}, {a[2], a[4], a[5]}, {a[5], a[3], a[0]}}));
  const std::vector<Vec2> b{Vec2{{1, 1}}, Vec2{{5, 1}}, Vec2{{1, 5}}};
  const TriangleIntersections common = intersect(2, a, 1, b);
  ASSERT_EQ(common.polygons.size(), 1U);
  CurvePicture picture;
  picture.shapes = {shape, drawn_triangle("b", 1, b)};
  EXPECT_EQ(add_polygons(picture, common.polygons, 3),
            3 + static_cast<int>(common.polygons[0].size()));
  ASSERT_EQ(picture.regions.size(), 1U);
  ASSERT_EQ(picture.marks.size(), common.polygons[0].size());
  for (std::size_t i = 0; i < picture.marks.size(); ++i) {
    EXPECT_EQ(picture.marks[i].kind, MarkKind::vertex);
    EXPECT_EQ(picture.marks[i].label, std::to_string(3 + i));
    EXPECT_EQ(picture.marks[i].point, picture.regions[0].curves[i][0]);
  }
  draw_curves(scratch("triangles.svg"), picture);
  const std::string text = read_file(scratch("triangles.svg"));
  EXPECT_NE(text.find(">vertex<"), std::string::npos);
  EXPECT_EQ(count(text, "fill-opacity=\"0.1\""), 2U);  // the tints
}

TEST(CurveMarks, LoopsAreOneRegionWithHoles) {
  const std::vector<Vec2> a{Vec2{{0, 0}}, Vec2{{4, 0}}, Vec2{{0, 4}}};
  const std::vector<Vec2> b{Vec2{{1, 1}}, Vec2{{2, 1}}, Vec2{{1, 2}}};
  CurvePicture picture;
  picture.shapes = {{"a", {{a[0], a[1]}}}};
  EXPECT_EQ(add_loops(picture, difference(1, b, 1, a).loops), 1);  // nothing remains
  EXPECT_TRUE(picture.regions.empty());
  EXPECT_EQ(add_loops(picture, difference(1, a, 1, b).loops), 7);
  ASSERT_EQ(picture.regions.size(), 1U);
  EXPECT_EQ(picture.regions[0].curves.size(), 6U);
  EXPECT_EQ(picture.regions[0].further, std::vector<std::size_t>{3});
  // One path of two closed parts, the second the other way round: a hole in it.
  draw_curves(scratch("hole.svg"), picture);
  const std::string text = read_file(scratch("hole.svg"));
  const std::size_t fill = text.find("fill-opacity=\"0.4\"");
  ASSERT_NE(fill, std::string::npos);
  const std::size_t start = text.rfind("<path", fill);
  EXPECT_EQ(count(text.substr(start, fill - start), "M"), 2U);
  EXPECT_EQ(count(text.substr(start, fill - start), "Z"), 2U);
}

TEST(DrawCurves, LongLegendsAreCut) {
  CurvePicture picture;
  for (int i = 0; i < 20; ++i) picture.shapes.push_back({std::to_string(i), {line}});
  const std::string path = scratch("legend.svg");
  draw_curves(path, picture);
  const std::string text = read_file(path);
  EXPECT_NE(text.find(">11<"), std::string::npos);
  EXPECT_EQ(text.find(">12<"), std::string::npos);
  EXPECT_NE(text.find(">and 8 more<"), std::string::npos);
}

}  // namespace
}  // namespace bezel
