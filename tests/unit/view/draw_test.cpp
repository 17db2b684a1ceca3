#include "bezel/view/draw.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bezel/base/atomic_file.hpp"
#include "image.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::message_of;
using test::scratch;

Field linear(const std::shared_ptr<const TriangleMesh>& mesh) {
  const Formula x("x");
  return project("x", Space::discontinuous(mesh, 1, Basis::physical), {&x, 1});
}

Panel panel_of(const Field& field, bool lines) {
  Layer layer;
  layer.field = field;
  layer.mesh_lines = lines;
  return {{layer}, "title"};
}

TEST(Draw, PngShowsTheFieldsColoursInTheRightPlaces) {
  const auto mesh = test::grid_mesh(4, 3, 1.0, test::bend(0.15, 0.12));
  const std::string path = scratch("field.png");
  DrawOptions options;
  options.width = 500;
  options.colour_bar = false;
  draw(path, {panel_of(linear(mesh), false)}, options);
  const test::Image image(path);
  EXPECT_EQ(image.width, 500);
  // The square's left and right ends in the middle row, found by colour.
  const view::ColourMap map("viridis");
  const int row = image.height * 11 / 20;
  int left = 0;
  while (left < 250 && image.at(left, row) == std::array<int, 3>{255, 255, 255}) ++left;
  int right = 499;
  while (right > 250 && image.at(right, row) == std::array<int, 3>{255, 255, 255}) --right;
  ASSERT_GT(right - left, 300);
  for (int x = left + 3; x < right - 3; ++x) {
    const double t = (x + 0.5 - left) / (right + 1.0 - left);
    EXPECT_LE(test::difference(image.at(x, row), map(t)), 4) << x;
  }
}

TEST(Draw, SvgIsWellFormedAndCurved) {
  const auto mesh = test::grid_mesh(2, 3, 1.0, test::bend(0.15, 0.12));
  const std::string path = scratch("mesh.svg");
  Layer layer;
  layer.mesh = mesh;
  draw(path, {{{layer}, "a < b"}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(path.c_str()));
  const std::string text = read_file(path);
  // Cubic sides are cubic path commands.
  bool curved = false;
  for (const auto& path_node : document.select_nodes("//path")) {
    const std::string d = path_node.node().attribute("d").value();
    curved = curved || d.find_first_of("Cc") != std::string::npos;
  }
  EXPECT_TRUE(curved);
  EXPECT_NE(text.find("a &lt; b"), std::string::npos);
}

TEST(Draw, MeshLinesAreDrawn) {
  const auto mesh = test::grid_mesh(1, 1, 1.0, test::same_place);
  const std::string with = scratch("with.png");
  const std::string without = scratch("without.png");
  DrawOptions options;
  options.width = 300;
  draw(with, {panel_of(linear(mesh), true)}, options);
  draw(without, {panel_of(linear(mesh), false)}, options);
  const test::Image a(with);
  const test::Image b(without);
  ASSERT_EQ(a.bytes.size(), b.bytes.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) different += a.bytes[i] != b.bytes[i] ? 1U : 0U;
  EXPECT_GT(different, 3U * 200U);            // about five lines of 200 pixels
  EXPECT_LT(different, a.bytes.size() / 10);  // and nothing else
}

TEST(Draw, SameBytesTwice) {
  const auto mesh = test::grid_mesh(3, 2, 1.0, test::bend(0.1, 0.1));
  for (const char* name : {"same.png", "same.svg"}) {
    const std::string path = scratch(name);
    draw(path, {panel_of(linear(mesh), true)});
    const std::string first = read_file(path);
    draw(path, {panel_of(linear(mesh), true)});
    EXPECT_EQ(first, read_file(path));
  }
}

TEST(Draw, ConstantAndVectorFieldsAndSeveralPanels) {
  const auto mesh = test::grid_mesh(1, 2, 1.0, test::bend(0.1, 0.1));
  const Formula one("1");
  const std::vector<Formula> velocity = {Formula("x"), Formula("y")};
  Panel a = panel_of(project("one", Space::discontinuous(mesh, 0), {&one, 1}), true);
  Panel b = panel_of(project("v", Space::discontinuous(mesh, 2), velocity), true);
  b.layers[0].component = -1;
  DrawOptions options;
  options.columns = 1;
  for (const char* name : {"panels.png", "panels.svg"}) {
    draw(scratch(name), {a, b}, options);
    EXPECT_GT(std::filesystem::file_size(scratch(name)), 500U);
  }
}

/// How wide each mesh of straight elements is drawn in an SVG file.
std::vector<double> drawn_widths(const std::string& svg) {
  std::vector<double> widths;
  const std::string begin = "<path d=\"";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    std::string path =
        svg.substr(at + begin.size(), svg.find('"', at + begin.size()) - at - begin.size());
    if (path.find('M', 1) == std::string::npos) continue;  // one line: of something else
    std::replace_if(
        path.begin(), path.end(), [](char c) { return c == 'M' || c == 'L'; }, ' ');
    std::istringstream numbers(path);
    double lo = 1e9, hi = -1e9;
    for (double x = 0, y = 0; numbers >> x >> y;) {
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    widths.push_back(hi - lo);
  }
  return widths;
}

TEST(Draw, PanelsMayHaveOneScale) {
  std::vector<Panel> panels(2);
  for (std::size_t i = 0; i < 2; ++i) {
    Layer layer;
    layer.mesh = test::grid_mesh(1, 1, i == 0 ? 1.0 : 0.25, test::same_place);
    panels[i].layers = {layer};
  }
  DrawOptions options;
  draw(scratch("filled.svg"), panels, options);
  options.same_scale = true;
  draw(scratch("scaled.svg"), panels, options);
  const std::vector<double> filled = drawn_widths(read_file(scratch("filled.svg"))),
                            scaled = drawn_widths(read_file(scratch("scaled.svg")));
  ASSERT_EQ(filled.size(), 2U);
  ASSERT_EQ(scaled.size(), 2U);
  EXPECT_NEAR(filled[1], filled[0], 0.1);
  EXPECT_NEAR(scaled[0], filled[0], 0.1);
  EXPECT_NEAR(scaled[1], 0.25 * scaled[0], 0.1);
}

TEST(Draw, ErrorsNameWhatIsWrongAndLeaveNoFile) {
  const auto mesh = test::grid_mesh(1, 1, 1.0, test::same_place);
  const Panel good = panel_of(linear(mesh), true);
  const std::string path = scratch("bad.png");
  std::filesystem::remove(path);
  EXPECT_EQ(message_of([&] { draw(path, {}); }), "nothing to draw: 0 panels, expected at least 1");
  EXPECT_EQ(message_of([&] { draw(path, {Panel{}}); }), "panel 1: 0 layers, expected at least 1");
  EXPECT_EQ(message_of([&] {
              draw(path, {Panel{{Layer{}}, ""}});
            }),
            "panel 1: layer 1: neither a mesh nor a field, expected one");
  Panel component = good;
  component.layers[0].component = 1;
  EXPECT_EQ(message_of([&] { draw(path, {component}); }),
            "panel 1: layer 1: component 1 of field \"x\", expected -1 to 0");
  DrawOptions options;
  options.colour_map = "jet";
  EXPECT_EQ(message_of([&] { draw(path, {good}, options); }),
            "unknown colour map \"jet\", expected viridis, cividis, coolwarm or grey");
  options = {};
  options.lo = 1.0;
  options.hi = 0.0;
  EXPECT_EQ(message_of([&] { draw(path, {good}, options); }),
            "colour range 1.000000 to 0.000000, expected a lower end below the upper end");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(message_of([&] { draw("x.gif", {good}); }),
            "x.gif: unknown extension \".gif\", expected .svg or .png");
  EXPECT_EQ(message_of([&] { draw("/nowhere/x.png", {good}); }),
            "/nowhere/x.png: cannot be written: no such directory");
}

TEST(Plot, DrawsSeriesOnLogarithmicAxes) {
  PlotOptions options;
  options.title = "error";
  options.log_x = options.log_y = true;
  const Series series{"ours", {0.1, 0.2, 0.4}, {1e-6, 1e-4, 1e-2}, false};
  const std::string path = scratch("plot.svg");
  plot(path, {series}, options);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(path.c_str()));
  EXPECT_NE(read_file(path).find(">ours<"), std::string::npos);
  plot(scratch("plot.png"), {series}, options);
  EXPECT_EQ(test::Image(scratch("plot.png")).width, 800);
  EXPECT_EQ(message_of([&] { plot(path, {}); }), "nothing to plot: 0 series, expected at least 1");
}

/// The y of a text in an SVG file; NAN when there is none.
double height_of(const pugi::xml_document& picture, const std::string& text) {
  const auto found = picture.select_node(("//text[normalize-space(.)='" + text + "']").c_str());
  return found.node().attribute("y").as_double(NAN);
}
/// The least y of the first line of a colour: the curve, which is drawn before the legend.
double top_of(const pugi::xml_document& picture, const std::string& colour) {
  std::istringstream d(picture.select_node(("//path[@stroke='" + colour + "']").c_str())
                           .node()
                           .attribute("d")
                           .value());
  double x = 0.0, y = 0.0, least = NAN;
  for (char letter = ' '; d >> letter >> x >> y;) least = std::fmin(least, y);
  return least;
}

// Where lines leave room the legend stands inside the frame, else in rows above it.
TEST(Plot, LegendCoversNoLine) {
  PlotOptions options;
  options.title = "title";
  std::vector<Series> series{{"the first", {0, 1, 2}, {0, 1, 2}, false, false, "#123456"}};
  const std::string path = scratch("legend.svg");
  plot(path, series, options);
  pugi::xml_document picture;
  ASSERT_TRUE(picture.load_file(path.c_str()));
  EXPECT_GT(height_of(picture, "the first"), top_of(picture, "#123456"));
  for (int i = 3; i <= 400; ++i) {
    series[0].x.push_back(i);
    series[0].y.push_back(2 * (i % 2));
  }
  series.resize(9, series[0]);
  series[8].name = "the last one";
  plot(path, series, options);
  ASSERT_TRUE(picture.load_file(path.c_str()));
  const double first = height_of(picture, "the first"), last = height_of(picture, "the last one");
  EXPECT_GT(first, height_of(picture, "title") + 10.0);
  EXPECT_GT(last, first + 15.0);  // another row
  EXPECT_LT(last, top_of(picture, "#123456"));
  // Where rows would take half of the picture, it stays inside.
  options.height = 100;
  plot(path, series, options);
  ASSERT_TRUE(picture.load_file(path.c_str()));
  EXPECT_LT(top_of(picture, "#123456"), 50.0);
}

// How often a text stands in a file.
std::size_t count_of(const std::string& path, const std::string& text) {
  const std::string all = read_file(path);
  std::size_t n = 0;
  for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++n;
  return n;
}

TEST(Plot, ScatterHasMarkersAndNoLine) {
  Series series{"", {}, {}, false};
  for (int i = 0; i < 100; ++i) {
    series.x.push_back(i);
    series.y.push_back(i % 7);
  }
  series.colour = "#123456";
  const std::string path = scratch("scatter.svg");
  plot(path, {series});
  EXPECT_EQ(count_of(path, "stroke=\"#123456\""), 1U);
  EXPECT_EQ(count_of(path, "fill=\"#123456\""), 0U);  // a curve of many points has no markers
  const auto curve_size = std::filesystem::file_size(path);
  series.scatter = true;
  plot(path, {series});
  EXPECT_EQ(count_of(path, "stroke=\"#123456\""), 0U);
  EXPECT_EQ(count_of(path, "fill=\"#123456\""), 1U);  // one path of 100 markers
  EXPECT_GT(std::filesystem::file_size(path), curve_size + 100 * 20);
  series.colour = "blue";
  EXPECT_EQ(message_of([&] { plot(path, {series}); }),
            "colour \"blue\" is not of the form \"#rrggbb\" with hexadecimal digits");
}

}  // namespace
}  // namespace bezel
