#include <png.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/view/canvas.hpp"
#include "bezel/view/font.hpp"
#include "bezel/view/png_field.hpp"
#include "bezel/view/raster.hpp"

namespace bezel::view {
namespace {

constexpr double flatness = 0.05;  // pixels, of lines and filled outlines

/// The polylines of a path's subpaths.
std::vector<std::vector<Vec2>> polylines(const Path& path) {
  std::vector<std::vector<Vec2>> out;
  for (const Path::Piece& piece : path.pieces()) {
    if (piece.verb == Path::Verb::move) {
      out.push_back({path.points()[piece.first]});
    } else if (piece.verb == Path::Verb::close) {
      out.back().push_back(out.back().front());
    } else {
      flatten(path.control(piece), flatness, out.back());
    }
  }
  return out;
}

class PngCanvas final : public Canvas {
 public:
  PngCanvas(int width, int height)
      : width_(width),
        height_(height),
        rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 1.0f) {}

  void fill(const Path& path, const Colour& colour) override {
    const auto lines = polylines(path);
    Box2 box;
    for (const auto& line : lines)
      for (const Vec2& p : line) box.include(p);
    if (box.empty()) return;
    AreaCoverage area;
    area.reset(box);
    for (const auto& line : lines) {
      for (std::size_t i = 1; i < line.size(); ++i) area.edge(line[i - 1], line[i]);
      area.edge(line.back(), line.front());
    }
    area.finish();
    for (int row = 0; row < area.height(); ++row)
      for (int column = 0; column < area.width(); ++column)
        blend(area.x0() + column, area.y0() + row, colour,
              std::min(1.0, std::abs(area.value(column, row))));
  }

  void stroke(const Path& path, const Stroke& stroke) override {
    auto lines = polylines(path);
    if (!stroke.dash.empty()) {
      std::vector<std::vector<Vec2>> dashes;
      for (const auto& line : lines)
        for (auto& piece : cut_dashes(line, stroke.dash)) dashes.push_back(std::move(piece));
      lines = std::move(dashes);
    }
    draw_lines(lines, stroke.width, stroke.colour);
  }

  void text(const Vec2& p, std::string_view text, const TextStyle& style) override {
    const double width = text_width(text, style);
    double x = style.anchor == Anchor::start    ? 0.0
               : style.anchor == Anchor::middle ? -0.5 * width
                                                : -width;
    const double stretch = style.bold ? bold_stretch : 1.0;
    std::vector<std::vector<Vec2>> lines;
    const auto add = [&](std::string_view part, double size, double rise) {
      for (std::uint32_t code : decode_utf8(part)) {
        for (std::vector<Vec2> line : strokes(code)) {
          for (Vec2& q : line) {
            const double right = x + q.x() * size * stretch, up = rise + q.y() * size;
            q = style.upwards ? Vec2{{p.x() - up, p.y() - right}}
                              : Vec2{{p.x() + right, p.y() - up}};
          }
          lines.push_back(std::move(line));
        }
        x += advance(code) * size * stretch;
      }
    };
    add(text, style.size, 0.0);
    add(style.superscript, superscript_size * style.size, superscript_rise * style.size);
    draw_lines(lines, (style.bold ? bold_pen_width : pen_width) * style.size, style.colour);
  }

  void gradient(const Box2& box, const ColourMap& map) override {
    const int first = static_cast<int>(std::floor(box.lo.y())),
              last = static_cast<int>(std::ceil(box.hi.y()));
    const double height = box.hi.y() - box.lo.y();
    for (int y = first; y < last; ++y) {
      Path strip;
      Box2 part = box;
      part.lo[1] = std::max(box.lo.y(), static_cast<double>(y));
      part.hi[1] = std::min(box.hi.y(), y + 1.0);
      strip.rectangle(part);
      fill(strip, map((box.hi.y() - part.centre().y()) / height));
    }
  }

  void field(const FieldPaint& paint) override {
    const FieldPixels pixels = paint_field(paint, width_, height_);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const std::size_t q = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x);
        const Colour colour{pixels.rgb[3 * q], pixels.rgb[3 * q + 1], pixels.rgb[3 * q + 2], 1.0};
        blend(x, y, colour, pixels.cover[q]);
      }
  }

  std::string finish() override {
    std::vector<png_byte> bytes(rgb_.size());
    std::transform(rgb_.begin(), rgb_.end(), bytes.begin(), [](float v) {
      return static_cast<png_byte>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f)));
    });
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_);
    image.height = static_cast<png_uint_32>(height_);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string out(size, '\0');
    if (png_image_write_to_memory(&image, out.data(), &size, 0, bytes.data(), 0, nullptr) == 0)
      throw InternalError(std::string("libpng: ") + image.message);
    out.resize(size);
    return out;
  }

 private:
  void blend(int x, int y, const Colour& colour, double cover) {
    if (cover <= 0.0 || x < 0 || y < 0 || x >= width_ || y >= height_) return;
    const double alpha = colour.a * cover;
    float* at = &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x))];
    const double parts[3] = {colour.r, colour.g, colour.b};
    for (int c = 0; c < 3; ++c)
      at[c] = static_cast<float>((1.0 - alpha) * static_cast<double>(at[c]) + alpha * parts[c]);
  }

  void draw_lines(const std::vector<std::vector<Vec2>>& lines, double width, const Colour& colour) {
    Box2 box;
    for (const auto& line : lines)
      for (const Vec2& p : line) box.include(p);
    if (box.empty()) return;
    LineCoverage coverage(box, width_, height_, width);
    for (const auto& line : lines) {
      if (line.size() == 1) coverage.segment(line[0], line[0]);
      for (std::size_t i = 1; i < line.size(); ++i) coverage.segment(line[i - 1], line[i]);
    }
    for (int row = 0; row < coverage.height(); ++row)
      for (int column = 0; column < coverage.width(); ++column)
        blend(coverage.x0() + column, coverage.y0() + row, colour, coverage.value(column, row));
  }

  int width_, height_;
  std::vector<float> rgb_;
};

}  // namespace

std::unique_ptr<Canvas> make_png_canvas(int width, int height) {
  return std::make_unique<PngCanvas>(width, height);
}

}  // namespace bezel::view
