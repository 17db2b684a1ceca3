#include "bezel/view/draw_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/geometry/curve_shape.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/view/canvas.hpp"
#include "bezel/view/label_placer.hpp"
#include "bezel/view/legend_rows.hpp"
#include "bezel/view/marker.hpp"
#include "bezel/view/ticks.hpp"

namespace bezel {
namespace {

using view::Anchor;
using view::Canvas;
using view::Colour;
using view::LabelPlacer;
using view::Path;
using view::Stroke;
using view::TextStyle;
using view::Ticks;
using view::Viewport;

constexpr std::size_t most_labels = 400, most_names = 12;
constexpr Colour band_colour{0.94, 0.84, 0.15, 0.75}, region_colour{0.0, 0.62, 0.45, 0.40},
    unresolved_colour{0.80, 0.0, 0.10, 1.0}, white{1.0, 1.0, 1.0, 1.0};

using Curves = std::vector<std::vector<Vec2>>;

void check(const CurvePicture& picture, const CurveDrawOptions& options) {
  if (options.width < 64 || options.width > 16384)
    throw InputError("width " + std::to_string(options.width) + ", expected 64 to 16384 pixels");
  if (picture.shapes.empty()) throw InputError("nothing to draw: 0 shapes, expected at least 1");
  const auto check_curves = [](const Curves& curves, const std::string& place) {
    if (curves.empty()) throw InputError(place + ": 0 curves, expected at least 1");
    for (const std::vector<Vec2>& curve : curves)
      if (curve.empty() || curve.size() > 61)
        throw InputError(place + ": " + std::to_string(curve.size()) +
                         " control points, expected 1 to 61");
  };
  for (std::size_t i = 0; i < picture.shapes.size(); ++i)
    check_curves(picture.shapes[i].curves, "shape " + std::to_string(i));
  for (std::size_t i = 0; i < picture.regions.size(); ++i)
    check_curves(picture.regions[i].curves, "region " + std::to_string(i));
  for (std::size_t i = 0; i < picture.bands.size(); ++i)
    check_curves({picture.bands[i].curve}, "band " + std::to_string(i));
  const auto check_point = [](const Vec2& p) {
    // Not a number fails, too.
    if (!(std::fabs(p.x()) <= 1e280 && std::fabs(p.y()) <= 1e280))
      throw InputError("a point to draw is beyond 1e280 or not finite");
  };
  for (const DrawnShape& shape : picture.shapes)
    for (const auto& curve : shape.curves) std::for_each(curve.begin(), curve.end(), check_point);
  for (const DrawnRegion& region : picture.regions)
    for (const auto& curve : region.curves) std::for_each(curve.begin(), curve.end(), check_point);
  for (const DrawnBand& band : picture.bands)
    std::for_each(band.curve.begin(), band.curve.end(), check_point);
  for (const DrawnMark& mark : picture.marks) check_point(mark.point);
}

/// What the picture shows: the curves and marks with some room around, and the control polygons
/// when they do not reach far beyond.
Box2 shown_box(const CurvePicture& picture, bool control_polygons) {
  Box2 curves, control;
  for (const DrawnShape& shape : picture.shapes)
    for (const auto& curve : shape.curves) {
      curves.include(tight_box(curve));
      for (const Vec2& p : curve) control.include(p);
    }
  for (const DrawnMark& mark : picture.marks) curves.include(mark.point);
  const auto extent = [](const Box2& box) {
    return std::max(box.hi.x() - box.lo.x(), box.hi.y() - box.lo.y());
  };
  if (control_polygons && extent(control) <= 1.6 * extent(curves)) curves.include(control);
  double pad = 0.06 * extent(curves);
  if (pad == 0.0) {  // one point
    const double size = std::max(std::fabs(curves.lo.x()), std::fabs(curves.lo.y()));
    pad = size > 0.0 ? 0.5 * size : 1.0;
  }
  if (!(pad >= 1e-280)) throw InputError("the curves to draw spread over less than 1e-280");
  return grown(curves, pad);
}

/// The part of a line inside a box.
std::optional<std::pair<Vec2, Vec2>> clipped(const Vec2& a, const Vec2& b, const Box2& box) {
  double from = 0.0, to = 1.0;
  for (int i = 0; i < 2; ++i) {
    const double d = b[i] - a[i];
    if (d == 0.0) {
      if (a[i] < box.lo[i] || a[i] > box.hi[i]) return {};
      continue;
    }
    const double at_lo = (box.lo[i] - a[i]) / d, at_hi = (box.hi[i] - a[i]) / d;
    from = std::max(from, std::min(at_lo, at_hi));
    to = std::min(to, std::max(at_lo, at_hi));
  }
  if (!(from <= to)) return {};
  return std::pair{a + from * (b - a), a + to * (b - a)};
}

struct LegendEntry {
  enum class Kind { line, net, band, region, mark, text } kind;
  std::string name;
  Colour colour{};
  MarkKind mark{};
};

view::Shape shape_of(MarkKind kind) {
  switch (kind) {
    case MarkKind::crossing:
    case MarkKind::vertex:
      return view::Shape::circle;
    case MarkKind::tangency:
      return view::Shape::diamond;
    case MarkKind::cusp:
      return view::Shape::triangle;
    case MarkKind::unresolved:
      return view::Shape::square;
  }
  return view::Shape::circle;
}

const char* name_of(MarkKind kind) {
  switch (kind) {
    case MarkKind::crossing:
      return "crossing";
    case MarkKind::tangency:
      return "tangency";
    case MarkKind::cusp:
      return "cusp";
    case MarkKind::vertex:
      return "vertex";
    case MarkKind::unresolved:
      return "unresolved";
  }
  return "";
}

class Drawing {
 public:
  Drawing(const CurvePicture& picture, const CurveDrawOptions& options)
      : picture_(picture), options_(options), unit_(std::clamp(options.width / 800.0, 0.5, 4.0)) {
    label_ = TextStyle{13.0 * unit_, view::ink};
    for (std::size_t i = 0; i < picture.shapes.size(); ++i)
      colours_.push_back(view::parse_colour(view::palette[i % view::palette.size()]));
    make_legend();
    lay_out();
  }

  int height() const { return height_; }

  void draw(Canvas& canvas) const {
    draw_grid(canvas);
    draw_areas(canvas);
    for (const DrawnBand& band : picture_.bands) stroke_curve(canvas, band.curve, band_stroke());
    if (options_.control_polygons)
      for (std::size_t i = 0; i < picture_.shapes.size(); ++i) draw_nets(canvas, i);
    for (std::size_t i = 0; i < picture_.shapes.size(); ++i)
      for (const auto& curve : picture_.shapes[i].curves)
        stroke_curve(canvas, curve, {colours_[i], 2.0 * unit_});
    draw_axes(canvas);
    draw_marks(canvas);
    draw_legend(canvas);
  }

 private:
  Stroke band_stroke() const { return {band_colour, 9.0 * unit_}; }
  Stroke net_stroke(Colour colour) const {
    colour.a = 0.65;
    return {colour, 0.9 * unit_, {4.0 * unit_, 3.0 * unit_}};
  }

  // ---- Layout

  void make_legend() {
    std::size_t unnamed = 0;
    for (std::size_t i = 0; i < picture_.shapes.size(); ++i) {
      if (picture_.shapes[i].name.empty()) continue;
      if (legend_.size() < most_names) {
        legend_.push_back({LegendEntry::Kind::line, picture_.shapes[i].name, colours_[i]});
      } else {
        ++unnamed;
      }
    }
    if (unnamed > 0)
      legend_.push_back({LegendEntry::Kind::text, "and " + std::to_string(unnamed) + " more"});
    if (options_.control_polygons)
      legend_.push_back({LegendEntry::Kind::net, "control polygon", Colour{0.4, 0.4, 0.4, 1.0}});
    if (!picture_.regions.empty() && !picture_.region_name.empty())
      legend_.push_back({LegendEntry::Kind::region, picture_.region_name});
    if (!picture_.bands.empty()) legend_.push_back({LegendEntry::Kind::band, "overlap"});
    for (const MarkKind kind : {MarkKind::crossing, MarkKind::tangency, MarkKind::cusp,
                                MarkKind::vertex, MarkKind::unresolved})
      if (std::any_of(picture_.marks.begin(), picture_.marks.end(),
                      [&](const DrawnMark& mark) { return mark.kind == kind; }))
        legend_.push_back({LegendEntry::Kind::mark,
                           kind == MarkKind::vertex ? picture_.vertex_name : name_of(kind),
                           {},
                           kind});
  }

  double entry_width(const LegendEntry& entry) const {
    // Viewers of SVG may have a wider font.
    return (sample_width(entry) + 7.0 + 18.0) * unit_ + 1.1 * view::text_width(entry.name, label_);
  }
  static double sample_width(const LegendEntry& entry) {
    return entry.kind == LegendEntry::Kind::mark   ? 12.0
           : entry.kind == LegendEntry::Kind::text ? 0.0
                                                   : 26.0;
  }

  /// Places of the entries above the frame; the number of rows.
  int place_legend() {
    std::vector<double> widths;
    for (const LegendEntry& entry : legend_) widths.push_back(entry_width(entry));
    view::LegendRows rows = view::legend_rows(widths, Vec2{{14.0 * unit_, 20.0 * unit_}},
                                              options_.width - 10.0 * unit_, 21.0 * unit_);
    entry_places_ = std::move(rows.places);
    return rows.count;
  }

  void lay_out() {
    shown_ = shown_box(picture_, options_.control_polygons);
    middle_ = shown_.centre();
    const Vec2 size = shown_.hi - shown_.lo;
    const double top = (14.0 + 21.0 * place_legend()) * unit_, bottom = 34.0 * unit_,
                 right = 18.0 * unit_;
    // The labels of the vertical axis decide the width of the frame, and that the axis.
    double left = 40.0 * unit_;
    for (int pass = 0; pass < 3; ++pass) {
      const double width = std::max(16.0, options_.width - left - right);
      const double aspect = std::clamp(size.y() / size.x(), 0.3, 1.1);
      const double height = std::max(16.0, width * aspect);
      height_ = static_cast<int>(std::ceil(top + height + bottom));
      frame_ = Box2();
      frame_.include(Vec2{{left, top}});
      frame_.include(Vec2{{left + width, top + height}});
      Box2 centred;
      centred.include(-0.5 * size);
      centred.include(0.5 * size);
      viewport_ = view::fit(centred, frame_);
      const Vec2 lo = viewport_.inverse(Vec2{{frame_.lo.x(), frame_.hi.y()}}) + middle_;
      const Vec2 hi = viewport_.inverse(Vec2{{frame_.hi.x(), frame_.lo.y()}}) + middle_;
      x_ticks_ = ticks(lo.x(), hi.x(), width / (80.0 * unit_));
      y_ticks_ = ticks(lo.y(), hi.y(), height / (55.0 * unit_));
      double widest = 0.0;
      for (const std::string& text : y_ticks_.labels)
        widest = std::max(widest, view::text_width(text, label_));
      left = 20.0 * unit_ + 1.05 * widest;
    }
  }

  /// None where the doubles are too far apart for a scale.
  static Ticks ticks(double lo, double hi, double count) {
    if (!(hi - lo > 1e-9 * std::max(std::fabs(lo), std::fabs(hi)))) return {};
    return view::linear_ticks(lo, hi, std::clamp(static_cast<int>(count), 2, 12));
  }

  // ---- Geometry in pixels

  Vec2 pixel(const Vec2& p) const { return viewport_(p - middle_); }
  std::vector<Vec2> pixels(const std::vector<Vec2>& curve) const {
    std::vector<Vec2> out;
    for (const Vec2& p : curve) out.push_back(pixel(p));
    return out;
  }

  static void append(Path& path, const std::vector<Vec2>& curve) {
    if (curve.size() > 1) {
      path.curve(curve);
    } else {
      path.line(curve[0]);
    }
  }

  void stroke_curve(Canvas& canvas, const std::vector<Vec2>& curve, const Stroke& stroke) const {
    const std::vector<Vec2> control = pixels(curve);
    Path path;
    if (std::all_of(control.begin(), control.end(),
                    [&](const Vec2& p) { return norm(p - control[0]) < 0.01; })) {
      path.circle(control[0], 1.4 * stroke.width);  // a point
      canvas.fill(path, stroke.colour);
      return;
    }
    path.move(control[0]);
    append(path, control);
    canvas.stroke(path, stroke);
  }

  void fill_chains(Canvas& canvas, const Curves& chains, std::span<const std::size_t> further,
                   const Colour& colour) const {
    Path path;
    for (std::size_t i = 0; i < chains.size(); ++i) {
      const std::vector<Vec2> control = pixels(chains[i]);
      const bool next = std::binary_search(further.begin(), further.end(), i);
      if (i > 0 && next) path.close();
      if (i == 0 || next) path.move(control[0]);
      append(path, control);
    }
    path.close();
    canvas.fill(path, colour);
  }

  // ---- Parts of the picture

  void draw_grid(Canvas& canvas) const {
    Path path;
    for (const double x : x_ticks_.major) {
      path.move(Vec2{{x_pixel(x), frame_.lo.y()}});
      path.line(Vec2{{x_pixel(x), frame_.hi.y()}});
    }
    for (const double y : y_ticks_.major) {
      path.move(Vec2{{frame_.lo.x(), y_pixel(y)}});
      path.line(Vec2{{frame_.hi.x(), y_pixel(y)}});
    }
    if (!path.pieces().empty()) canvas.stroke(path, {view::minor_grid, 0.7 * unit_});
  }
  double x_pixel(double x) const { return pixel(Vec2{{x, middle_.y()}}).x(); }
  double y_pixel(double y) const { return pixel(Vec2{{middle_.x(), y}}).y(); }

  void draw_axes(Canvas& canvas) const {
    Path path;
    path.rectangle(frame_);
    const double tick = 4.0 * unit_;
    for (std::size_t k = 0; k < x_ticks_.major.size(); ++k) {
      const Vec2 at{{x_pixel(x_ticks_.major[k]), frame_.hi.y()}};
      path.move(at);
      path.line(at + Vec2{{0.0, tick}});
      TextStyle style = label_;
      style.anchor = Anchor::middle;
      canvas.text(at + Vec2{{0.0, 19.0 * unit_}}, x_ticks_.labels[k], style);
    }
    for (std::size_t k = 0; k < y_ticks_.major.size(); ++k) {
      const Vec2 at{{frame_.lo.x(), y_pixel(y_ticks_.major[k])}};
      path.move(at);
      path.line(at - Vec2{{tick, 0.0}});
      TextStyle style = label_;
      style.anchor = Anchor::end;
      canvas.text(at + Vec2{{-7.0 * unit_, 0.35 * label_.size}}, y_ticks_.labels[k], style);
    }
    canvas.stroke(path, {Colour{0.45, 0.45, 0.45, 1.0}, 0.8 * unit_});
  }

  void draw_areas(Canvas& canvas) const {
    for (std::size_t i = 0; i < picture_.shapes.size(); ++i)
      if (picture_.shapes[i].filled) {
        Colour tint = colours_[i];
        tint.a = 0.10;
        fill_chains(canvas, picture_.shapes[i].curves, {}, tint);
      }
    for (const DrawnRegion& region : picture_.regions)
      fill_chains(canvas, region.curves, region.further, region_colour);
  }

  void draw_nets(Canvas& canvas, std::size_t i) const {
    Path lines, points;
    for (const auto& curve : picture_.shapes[i].curves) {
      const std::vector<Vec2> control = pixels(curve);
      for (std::size_t k = 0; k < control.size(); ++k) {
        if (frame_.contains(control[k])) points.circle(control[k], 2.2 * unit_);
        if (k == 0 || control.size() == 2) continue;  // a straight side is its own polygon
        if (const auto part = clipped(control[k - 1], control[k], frame_)) {
          lines.move(part->first);
          lines.line(part->second);
        }
      }
    }
    if (!lines.pieces().empty()) canvas.stroke(lines, net_stroke(colours_[i]));
    if (!points.pieces().empty()) canvas.fill(points, colours_[i]);
  }

  void draw_marker(Canvas& canvas, MarkKind kind, const Vec2& at) const {
    Path path;
    if (kind == MarkKind::vertex) {
      path.circle(at, 0.8 * marker_radius());
      canvas.fill(path, view::ink);
      return;
    }
    view::add_marker(path, shape_of(kind), at, marker_radius());
    canvas.fill(path, white);
    canvas.stroke(path, {kind == MarkKind::unresolved ? unresolved_colour : view::ink,
                         (labelled() ? 1.5 : 0.8) * unit_});
  }
  bool labelled() const { return picture_.marks.size() + picture_.bands.size() <= most_labels; }
  double marker_radius() const { return (labelled() ? 4.6 : 2.0) * unit_; }

  /// A label and what it belongs to, in pixels.
  struct Label {
    Vec2 at;
    std::string text;
    MarkKind kind;
    bool band;
    int merged;
  };

  void draw_marks(Canvas& canvas) const {
    std::vector<Label> labels;
    for (const DrawnMark& mark : picture_.marks) {
      const Vec2 at = pixel(mark.point);
      const auto same =
          labelled() ? std::find_if(labels.begin(), labels.end(),
                                    [&](const Label& l) {
                                      return l.kind == mark.kind && norm(l.at - at) < 2.5 * unit_;
                                    })
                     : labels.end();
      if (same == labels.end()) {
        labels.push_back({at, mark.label, mark.kind, false, 1});
      } else if (++same->merged <= 4) {
        same->text += ", " + mark.label;
      } else if (same->merged == 5) {
        same->text += ", ...";
      }
    }
    for (const Label& l : labels) draw_marker(canvas, l.kind, l.at);
    if (!labelled()) return;
    for (const DrawnBand& band : picture_.bands)
      labels.push_back({pixel(Curve(band.curve)(0.5)), band.label, MarkKind::crossing, true, 1});
    LabelPlacer placer(frame_);
    avoid_lines(placer);
    for (const Label& l : labels)
      if (!l.band) placer.avoid(l.at, marker_radius() + 2.0 * unit_);
    TextStyle style = label_;
    style.bold = true;
    style.anchor = Anchor::middle;
    for (const Label& l : labels) {
      if (l.text.empty()) continue;
      const Vec2 size{
          {1.05 * view::text_width(l.text, style) + 3.0 * unit_, style.size * 0.85 + 2.0 * unit_}};
      const LabelPlacer::Place place = placer.place(l.at, size, (l.band ? 5.5 : 7.5) * unit_);
      if (place.far) draw_leader(canvas, l.at, place.centre, size);
      draw_text(canvas, place.centre, l.text, style);
    }
  }

  void avoid_lines(LabelPlacer& placer) const {
    for (const DrawnShape& shape : picture_.shapes)
      for (const auto& curve : shape.curves) {
        const std::vector<Vec2> control = pixels(curve);
        std::vector<Vec2> line{control[0]};
        if (control.size() > 1) view::flatten(control, 0.5, line);
        placer.avoid(line);
        if (!options_.control_polygons) continue;
        for (std::size_t k = 1; k < control.size(); ++k)
          if (const auto part = clipped(control[k - 1], control[k], frame_))
            placer.avoid(std::array{part->first, part->second});
      }
  }

  void draw_leader(Canvas& canvas, const Vec2& from, const Vec2& centre, const Vec2& size) const {
    Box2 box;
    box.include(centre - 0.5 * size);
    box.include(centre + 0.5 * size);
    const auto inside = clipped(from, centre, box);
    if (!inside) return;
    const Vec2 d = inside->first - from;
    const double length = norm(d), start = marker_radius() + unit_;
    if (length <= start) return;
    Path path;
    path.move(from + (start / length) * d);
    path.line(inside->first);
    canvas.stroke(path, {Colour{0.35, 0.35, 0.35, 1.0}, 0.8 * unit_});
  }

  /// Text with a white rim, so that lines below do not disturb it.
  void draw_text(Canvas& canvas, const Vec2& centre, const std::string& text,
                 const TextStyle& style) const {
    Box2 box;
    const Vec2 half{{0.5 * view::text_width(text, style), 0.42 * style.size}};
    box.include(centre - half);
    box.include(centre + half);
    Path path;
    path.rectangle(box);
    canvas.fill(path, Colour{1.0, 1.0, 1.0, 0.7});
    canvas.text(centre + Vec2{{0.0, 0.36 * style.size}}, text, style);
  }

  void draw_legend(Canvas& canvas) const {
    for (std::size_t k = 0; k < legend_.size(); ++k) {
      const LegendEntry& entry = legend_[k];
      const double width = sample_width(entry) * unit_;
      const Vec2 left = entry_places_[k], right = left + Vec2{{width, 0.0}};
      Path path;
      switch (entry.kind) {
        case LegendEntry::Kind::line:
        case LegendEntry::Kind::net:
        case LegendEntry::Kind::band: {
          path.move(left);
          path.line(right);
          canvas.stroke(path, entry.kind == LegendEntry::Kind::line
                                  ? Stroke{entry.colour, 2.2 * unit_}
                              : entry.kind == LegendEntry::Kind::net ? net_stroke(entry.colour)
                                                                     : band_stroke());
          break;
        }
        case LegendEntry::Kind::region: {
          Box2 box;
          box.include(left - Vec2{{0.0, 5.0 * unit_}});
          box.include(right + Vec2{{0.0, 5.0 * unit_}});
          path.rectangle(box);
          canvas.fill(path, region_colour);
          break;
        }
        case LegendEntry::Kind::mark:
          draw_marker(canvas, entry.mark, 0.5 * (left + right));
          break;
        case LegendEntry::Kind::text:
          break;
      }
      canvas.text(right + Vec2{{7.0 * unit_, 0.35 * label_.size}}, entry.name, label_);
    }
  }

  const CurvePicture& picture_;
  const CurveDrawOptions& options_;
  double unit_;
  TextStyle label_;
  std::vector<Colour> colours_;
  std::vector<LegendEntry> legend_;
  std::vector<Vec2> entry_places_;
  Box2 shown_, frame_;
  Vec2 middle_;  // of what is shown; far from the origin, differences to it keep their digits
  Viewport viewport_;
  Ticks x_ticks_, y_ticks_;
  int height_ = 0;
};

}  // namespace

void draw_curves(const std::string& path, const CurvePicture& picture,
                 const CurveDrawOptions& options) {
  view::check_extension(path);
  check(picture, options);
  const Drawing drawing(picture, options);
  const std::unique_ptr<Canvas> canvas = view::make_canvas(path, options.width, drawing.height());
  drawing.draw(*canvas);
  write_file(path, canvas->finish());
}

}  // namespace bezel
