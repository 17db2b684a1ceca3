#include "bezel/view/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/view/font.hpp"

namespace bezel::view {

void Path::move(const Vec2& p) {
  pieces_.push_back({Verb::move, points_.size(), 0});
  points_.push_back(p);
  start_ = current_ = p;
}

void Path::line(const Vec2& p) {
  const std::array<Vec2, 2> control{current_, p};
  curve(control);
}

void Path::curve(std::span<const Vec2> control) {
  pieces_.push_back({Verb::curve, points_.size(), static_cast<int>(control.size()) - 1});
  points_.insert(points_.end(), control.begin(), control.end());
  current_ = control.back();
}

void Path::close() {
  pieces_.push_back({Verb::close, points_.size(), 0});
  current_ = start_;
}

void Path::rectangle(const Box2& box) {
  move(box.lo);
  line(Vec2{{box.hi.x(), box.lo.y()}});
  line(box.hi);
  line(Vec2{{box.lo.x(), box.hi.y()}});
  close();
}

void Path::circle(const Vec2& centre, double radius) {
  constexpr double k = 0.5522847498;  // 4/3 (sqrt 2 - 1): the cubic meets the circle in the middle
  constexpr std::array<Vec2, 4> axis{Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{-1, 0}}, Vec2{{0, -1}}};
  move(centre + radius * axis[0]);
  for (std::size_t q = 0; q < 4; ++q) {
    const Vec2 a = axis[q], b = axis[(q + 1) % 4];
    const std::array<Vec2, 4> control{current_, centre + radius * (a + k * b),
                                      centre + radius * (b + k * a), centre + radius * b};
    curve(control);
  }
  close();
}

std::span<const Vec2> Path::control(const Piece& piece) const {
  return std::span<const Vec2>(points_).subspan(piece.first,
                                                static_cast<std::size_t>(piece.degree) + 1);
}

Viewport fit(const Box2& plane, const Box2& pixels) {
  const Vec2 size = plane.hi - plane.lo, room = pixels.hi - pixels.lo;
  Viewport viewport;
  viewport.scale = std::min(room.x() / size.x(), room.y() / size.y());
  const Vec2 middle = plane.centre(), centre = pixels.centre();
  viewport.origin =
      Vec2{{centre.x() - viewport.scale * middle.x(), centre.y() + viewport.scale * middle.y()}};
  return viewport;
}

void flatten(std::span<const Vec2> control, double tolerance, std::vector<Vec2>& out) {
  const std::size_t d = control.size() - 1;
  // A chord over 1/n of the parameter is within d (d-1) / 8 n^2 times the largest second
  // difference.
  double bend = 0.0;
  for (std::size_t i = 0; i + 2 <= d; ++i)
    bend = std::max(bend, norm(control[i] - 2.0 * control[i + 1] + control[i + 2]));
  const double dd = static_cast<double>(d);
  const int n = static_cast<int>(
      std::clamp(std::ceil(std::sqrt(dd * (dd - 1.0) / 8.0 * bend / tolerance)), 1.0, 4096.0));
  std::array<Vec2, 64> b;
  for (int k = 1; k < n; ++k) {
    const double r = static_cast<double>(n - k) / n, s = static_cast<double>(k) / n;
    std::copy(control.begin(), control.end(), b.begin());
    for (std::size_t level = d; level > 0; --level)
      for (std::size_t i = 0; i < level; ++i) b[i] = r * b[i] + s * b[i + 1];
    out.push_back(b[0]);
  }
  out.push_back(control.back());
}

double text_width(std::string_view text, const TextStyle& style) {
  double width = 0.0;
  for (std::uint32_t code : decode_utf8(text)) width += advance(code);
  for (std::uint32_t code : decode_utf8(style.superscript))
    width += superscript_size * advance(code);
  return width * style.size * (style.bold ? bold_stretch : 1.0);
}

namespace {

enum class Kind { svg, png };

Kind kind_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.find_last_of('.');
  std::string extension = dot == std::string::npos || dot == 0 ? "" : name.substr(dot);
  const std::string given = extension;
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == ".svg") return Kind::svg;
  if (extension == ".png") return Kind::png;
  InputPlace place;
  place.file = path;
  throw InputError(place, given.empty()
                              ? std::string("no file extension, expected .svg or .png")
                              : "unknown extension \"" + given + "\", expected .svg or .png");
}

}  // namespace

void check_extension(const std::string& path) {
  kind_of(path);
}

std::unique_ptr<Canvas> make_canvas(const std::string& path, int width, int height) {
  return kind_of(path) == Kind::svg ? make_svg_canvas(width, height)
                                    : make_png_canvas(width, height);
}

}  // namespace bezel::view
