#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/view/canvas.hpp"
#include "bezel/view/font.hpp"
#include "bezel/view/svg_cells.hpp"

namespace bezel::view {
namespace {

constexpr double straight_tolerance = 0.005;  // pixels: below what two decimals can show
constexpr double curve_tolerance =
    0.05;  // pixels, of cubics that stand for curves of higher degree

/// At most two decimals, without trailing zeros; independent of the locale.
std::string number(double value) {
  const long long hundredths = std::llround(100.0 * value);
  const long long size = hundredths < 0 ? -hundredths : hundredths;
  std::string text = hundredths < 0 ? "-" : "";
  text += std::to_string(size / 100);
  const int rest = static_cast<int>(size % 100);
  if (rest != 0) {
    text += '.';
    text += static_cast<char>('0' + rest / 10);
    if (rest % 10 != 0) text += static_cast<char>('0' + rest % 10);
  }
  return text;
}

/// Three decimals of a value in [0, 1].
std::string three_decimals(double value) {
  const long long thousandths = std::llround(1000.0 * value);
  std::string text = thousandths >= 1000 ? "1." : "0.";
  for (long long power = 100; power > 0; power /= 10)
    text += static_cast<char>('0' + thousandths / power % 10);
  return text;
}

std::string escape(std::string_view text) {
  std::string out;
  for (char c : clean_utf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

void add_point(std::string& out, const Vec2& p) {
  out += number(p.x());
  out += ' ';
  out += number(p.y());
}

bool is_straight(std::span<const Vec2> b) {
  const Vec2 d = b.back() - b.front();
  const double length = norm(d);
  for (const Vec2& p : b) {
    const Vec2 r = p - b.front();
    const double along = dot(r, d);
    if (std::abs(cross(d, r)) > straight_tolerance * length || along < 0.0 ||
        along > length * length)
      return false;
  }
  return length > 0.0;
}

Vec2 point_at(std::span<const Vec2> control, double s) {
  return bernstein::evaluate<Vec2>(control, s);
}

// Cubics through end points and end tangents of pieces, halved until every one is close at the same
// parameter.
void add_cubics(std::string& out, std::span<const Vec2> b, int depth) {
  const double d = static_cast<double>(b.size() - 1);
  const std::array<Vec2, 4> cubic{b.front(), b.front() + (d / 3.0) * (b[1] - b.front()),
                                  b.back() + (d / 3.0) * (b[b.size() - 2] - b.back()), b.back()};
  double worst = 0.0;
  for (int k = 1; k < 16; ++k) {
    const double s = k / 16.0;
    worst = std::max(worst, norm(point_at(b, s) - point_at(cubic, s)));
  }
  if (worst <= 0.5 * curve_tolerance || depth == 0) {
    out += 'C';
    add_point(out, cubic[1]);
    out += ' ';
    add_point(out, cubic[2]);
    out += ' ';
    add_point(out, cubic[3]);
    return;
  }
  const auto [left, right] = bernstein::subdivide<Vec2>(b, 0.5);
  add_cubics(out, left, depth - 1);
  add_cubics(out, right, depth - 1);
}

void add_curve(std::string& out, std::span<const Vec2> b) {
  const std::size_t degree = b.size() - 1;
  if (degree == 1 || is_straight(b)) {
    out += 'L';
    add_point(out, b.back());
  } else if (degree <= 3) {
    out += degree == 2 ? 'Q' : 'C';
    for (std::size_t i = 1; i <= degree; ++i) {
      if (i > 1) out += ' ';
      add_point(out, b[i]);
    }
  } else {
    add_cubics(out, b, 8);
  }
}

std::string path_data(const Path& path) {
  std::string out;
  for (const Path::Piece& piece : path.pieces()) {
    if (piece.verb == Path::Verb::move) {
      out += 'M';
      add_point(out, path.points()[piece.first]);
    } else if (piece.verb == Path::Verb::close) {
      out += 'Z';
    } else {
      add_curve(out, path.control(piece));
    }
  }
  return out;
}

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(int width, int height) {
    put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"");
    attribute("width", width);
    attribute("height", height);
    put(" viewBox=\"0 0 ", std::to_string(width), " ", std::to_string(height),
        "\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\">\n<rect");
    attribute("width", width);
    attribute("height", height);
    put(" fill=\"#ffffff\"/>\n");
  }

  void fill(const Path& path, const Colour& colour) override {
    put("<path d=\"", path_data(path), "\" fill=\"", hex(colour), "\"");
    if (colour.a < 1.0) attribute("fill-opacity", colour.a);
    put("/>\n");
  }

  void stroke(const Path& path, const Stroke& stroke) override {
    put("<path d=\"", path_data(path), "\" fill=\"none\" stroke=\"", hex(stroke.colour), "\"");
    if (stroke.colour.a < 1.0) attribute("stroke-opacity", stroke.colour.a);
    attribute("stroke-width", stroke.width);
    put(" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
    if (!stroke.dash.empty()) {
      put(" stroke-dasharray=\"");
      for (std::size_t i = 0; i < stroke.dash.size(); ++i)
        put(i > 0 ? " " : "", number(stroke.dash[i]));
      put("\"");
    }
    put("/>\n");
  }

  void text(const Vec2& p, std::string_view text, const TextStyle& style) override {
    put("<text");
    if (style.upwards) {
      put(" transform=\"translate(", number(p.x()), " ", number(p.y()), ") rotate(-90)\"");
    } else {
      attribute("x", p.x());
      attribute("y", p.y());
    }
    attribute("font-size", style.size);
    put(" fill=\"", hex(style.colour), "\"");
    if (style.anchor == Anchor::middle) put(" text-anchor=\"middle\"");
    if (style.anchor == Anchor::end) put(" text-anchor=\"end\"");
    if (style.bold) put(" font-weight=\"bold\"");
    put(">", escape(text));
    if (!style.superscript.empty()) {
      put("<tspan");
      attribute("dy", -superscript_rise * style.size);
      attribute("font-size", superscript_size * style.size);
      put(">", escape(style.superscript), "</tspan>");
    }
    put("</text>\n");
  }

  void gradient(const Box2& box, const ColourMap& map) override {
    const std::string base = map_id(map), id = next_id();
    linear_gradient(id, base, Vec2{{0.0, box.hi.y()}}, Vec2{{0.0, box.lo.y()}});
    put("\n<rect");
    attribute("x", box.lo.x());
    attribute("y", box.lo.y());
    attribute("width", box.hi.x() - box.lo.x());
    attribute("height", box.hi.y() - box.lo.y());
    put(" fill=\"url(#", id, ")\"/>\n");
  }

  void field(const FieldPaint& paint) override {
    const std::string base = map_id(*paint.map);
    // Each cell is outlined in its own paint: neighbours overlap by less than half a pixel and no
    // seam shows.
    put("<g stroke-width=\"0.8\" stroke-linejoin=\"round\">\n");
    for (const Cell& cell : make_cells(paint)) {
      std::string colour;
      if (cell.flat) {
        colour = hex((*paint.map)(cell.t));
      } else {
        const std::string id = next_id();
        linear_gradient(id, base, cell.from, cell.to);
        for (const char* part : {"url(#", id.c_str(), ")"}) colour += part;
      }
      put("<path d=\"", path_data(cell.outline), "\" fill=\"", colour, "\" stroke=\"", colour,
          "\"/>\n");
    }
    put("</g>\n");
  }

  std::string finish() override {
    put("</svg>\n");
    return std::move(out_);
  }

 private:
  template <class... Parts>
  void put(const Parts&... parts) {
    ((out_ += parts), ...);
  }
  void attribute(const char* name, double value) { put(" ", name, "=\"", number(value), "\""); }

  std::string next_id() {
    std::string id = "g";
    id += std::to_string(ids_++);
    return id;
  }

  void linear_gradient(const std::string& id, const std::string& base, const Vec2& from,
                       const Vec2& to) {
    put("<linearGradient id=\"", id, "\" xlink:href=\"#", base, "\"");
    attribute("x1", from.x());
    attribute("y1", from.y());
    attribute("x2", to.x());
    attribute("y2", to.y());
    put("/>");
  }

  /// The gradient that holds the map's stops; the others refer to it.
  std::string map_id(const ColourMap& map) {
    std::string stops;
    for (int k = 0; k < map.knot_count(); ++k)
      for (const std::string& part :
           {std::string("<stop offset=\""),
            three_decimals(static_cast<double>(k) / (map.knot_count() - 1)),
            std::string("\" stop-color=\""), hex(map.knot(k)), std::string("\"/>\n")})
        stops += part;
    for (const auto& [known, id] : maps_)
      if (known == stops) return id;
    std::string id = "map";
    id += std::to_string(maps_.size());
    put("<linearGradient id=\"", id, "\" gradientUnits=\"userSpaceOnUse\">\n", stops,
        "</linearGradient>\n");
    maps_.emplace_back(std::move(stops), id);
    return id;
  }

  std::string out_;
  int ids_ = 0;
  std::vector<std::pair<std::string, std::string>> maps_;  // stops, id
};

}  // namespace

std::unique_ptr<Canvas> make_svg_canvas(int width, int height) {
  return std::make_unique<SvgCanvas>(width, height);
}

}  // namespace bezel::view
