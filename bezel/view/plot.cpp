#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/view/canvas.hpp"
#include "bezel/view/draw.hpp"
#include "bezel/view/label_placer.hpp"
#include "bezel/view/legend_rows.hpp"
#include "bezel/view/marker.hpp"
#include "bezel/view/ticks.hpp"

namespace bezel {
namespace {

using view::add_marker;
using view::Anchor;
using view::Canvas;
using view::Colour;
using view::ink;
using view::major_grid;
using view::minor_grid;
using view::palette;
using view::Path;
using view::Shape;
using view::Stroke;
using view::TextStyle;
using view::Ticks;

constexpr int most_markers =
    40;  // points beyond which a curve has no markers, a scatter small ones

void check(const std::vector<Series>& series, const PlotOptions& options) {
  if (series.empty()) throw InputError("nothing to plot: 0 series, expected at least 1");
  for (const Series& s : series) {
    const std::string place = "series \"" + s.name + "\": ";
    if (s.x.size() != s.y.size())
      throw InputError(place + std::to_string(s.x.size()) + " x values and " +
                       std::to_string(s.y.size()) + " y values, expected as many");
    if (s.x.empty()) throw InputError(place + "0 points, expected at least 1");
    const auto check_values = [&](const char* name, const std::vector<double>& values,
                                  bool logarithmic) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string which = place + name + " value " + std::to_string(i + 1) + " is ";
        if (!std::isfinite(values[i])) throw InputError(which + "not finite");
        if (logarithmic && !(values[i] > 0.0))
          throw InputError(which + std::to_string(values[i]) +
                           ", expected above 0 on a logarithmic axis");
      }
    };
    check_values("x", s.x, options.log_x);
    check_values("y", s.y, options.log_y);
  }
  for (const auto& [name, value] : {std::pair{"width", options.width}, {"height", options.height}})
    if (value < 64 || value > 16384)
      throw InputError(std::string(name) + " " + std::to_string(value) +
                       ", expected 64 to 16384 pixels");
}

/// One axis: data to a fraction of its length.
struct Axis {
  bool logarithmic = false;
  double lo = 0.0, hi = 1.0;
  Ticks ticks;
  double operator()(double value) const {
    if (logarithmic) return (std::log(value) - std::log(lo)) / (std::log(hi) - std::log(lo));
    return (value / 2 - lo / 2) /
           (hi / 2 - lo / 2);  // halves: the difference of huge values is finite
  }
};

Axis make_axis(bool logarithmic, double lo, double hi, int count) {
  Axis axis;
  axis.logarithmic = logarithmic;
  if (logarithmic) {
    const double ratio = hi / lo;
    const double pad = ratio > 1.0 + 1e-9 ? std::pow(ratio, 0.05) : 2.0;
    axis.lo = std::max(lo / pad, 1e-307);
    axis.hi = std::min(hi * pad, 1e307);
    axis.ticks = view::log_ticks(axis.lo, axis.hi, count);
  } else {
    const double size = std::max(std::abs(lo), std::abs(hi));
    double pad = 0.05 * (hi / 2 - lo / 2) * 2;
    if (!(pad > 1e-12 * size)) pad = size > 0.0 ? 0.1 * size : 1.0;
    axis.lo = std::max(lo - pad, -8e307);
    axis.hi = std::min(hi + pad, 8e307);
    axis.ticks = view::linear_ticks(axis.lo, axis.hi, count);
  }
  return axis;
}

constexpr std::array<Shape, 5> shapes{Shape::circle, Shape::square, Shape::diamond, Shape::triangle,
                                      Shape::down};

struct Look {
  Colour colour;
  Shape shape;
  bool markers;
  double radius;  // of a marker, in units
};

class Plot {
 public:
  Plot(const std::vector<Series>& series, const PlotOptions& options)
      : series_(series), options_(options), unit_(std::clamp(options.width / 800.0, 0.5, 4.0)) {
    Box2 data;
    for (const Series& s : series)
      for (std::size_t i = 0; i < s.x.size(); ++i) data.include(Vec2{{s.x[i], s.y[i]}});
    const int across = std::clamp(static_cast<int>(options.width / (95.0 * unit_)), 2, 10);
    const int up = std::clamp(static_cast<int>(options.height / (62.0 * unit_)), 2, 12);
    x_ = make_axis(options.log_x, data.lo.x(), data.hi.x(), across);
    y_ = make_axis(options.log_y, data.lo.y(), data.hi.y(), up);
    label_ = TextStyle{14.0 * unit_, ink};
    title_ = TextStyle{18.0 * unit_, ink, Anchor::middle};

    double widest = 0.0;
    for (std::size_t k = 0; k < y_.ticks.major.size(); ++k)
      widest = std::max(widest, view::text_width(y_.ticks.labels[k], tick_style(y_, k)));
    const double left =
        14.0 * unit_ + (options.y_label.empty() ? 0.0 : 24.0 * unit_) + widest + 8.0 * unit_;
    const double top = options.title.empty() ? 16.0 * unit_ : 44.0 * unit_;
    const double bottom = 34.0 * unit_ + (options.x_label.empty() ? 0.0 : 24.0 * unit_);
    frame_.include(Vec2{{std::min(left, 0.5 * options.width), top}});
    frame_.include(Vec2{{options.width - 22.0 * unit_, options.height - bottom}});
    for (std::size_t i = 0; i < series.size(); ++i) {
      const bool many = series[i].x.size() > most_markers;
      const std::string colour =
          series[i].colour.empty() ? palette[i % palette.size()] : series[i].colour;
      looks_.push_back({view::parse_colour(colour), shapes[i % shapes.size()],
                        series[i].scatter || (!series[i].dashed && !many),
                        series[i].scatter && many ? 2.6 : 4.0});
    }
    lay_out_legend();
  }

  void draw(Canvas& canvas) const {
    draw_grid(canvas);
    for (std::size_t i = 0; i < series_.size(); ++i) draw_series(canvas, i);
    draw_frame(canvas);
    draw_legend(canvas);
  }

 private:
  TextStyle tick_style(const Axis& axis, std::size_t k) const {
    TextStyle style = label_;
    style.superscript = axis.ticks.superscripts[k];
    return style;
  }

  Vec2 place(double fx, double fy) const {
    return Vec2{{frame_.lo.x() + fx * (frame_.hi.x() - frame_.lo.x()),
                 frame_.hi.y() - fy * (frame_.hi.y() - frame_.lo.y())}};
  }

  void draw_grid(Canvas& canvas) const {
    const auto lines = [&](const std::vector<double>& xs, const std::vector<double>& ys,
                           const Colour& colour, double width) {
      Path path;
      for (double v : xs) {
        path.move(place(x_(v), 0.0));
        path.line(place(x_(v), 1.0));
      }
      for (double v : ys) {
        path.move(place(0.0, y_(v)));
        path.line(place(1.0, y_(v)));
      }
      if (!path.pieces().empty()) canvas.stroke(path, {colour, width});
    };
    lines(x_.ticks.minor, y_.ticks.minor, minor_grid, 0.6 * unit_);
    lines(x_.ticks.major, y_.ticks.major, major_grid, 0.8 * unit_);
  }

  void draw_frame(Canvas& canvas) const {
    Path path;
    path.rectangle(frame_);
    const auto ticks = [&](const Axis& axis, bool horizontal) {
      for (const auto& [values, length] :
           {std::pair{&axis.ticks.major, 6.0}, {&axis.ticks.minor, 3.0}})
        for (double v : *values) {
          const Vec2 at = horizontal ? place(axis(v), 0.0) : place(0.0, axis(v));
          path.move(at);
          path.line(at + length * unit_ * (horizontal ? Vec2{{0.0, -1.0}} : Vec2{{1.0, 0.0}}));
        }
    };
    ticks(x_, true);
    ticks(y_, false);
    canvas.stroke(path, {ink, 0.9 * unit_});

    for (std::size_t k = 0; k < x_.ticks.major.size(); ++k) {
      TextStyle style = tick_style(x_, k);
      // Centred as a whole, superscript included (SVG viewers centre the run of both as well).
      style.anchor = Anchor::middle;
      canvas.text(place(x_(x_.ticks.major[k]), 0.0) + Vec2{{0.0, 20.0 * unit_}}, x_.ticks.labels[k],
                  style);
    }
    for (std::size_t k = 0; k < y_.ticks.major.size(); ++k) {
      TextStyle style = tick_style(y_, k);
      style.anchor = Anchor::end;
      canvas.text(place(0.0, y_(y_.ticks.major[k])) + Vec2{{-8.0 * unit_, 0.35 * label_.size}},
                  y_.ticks.labels[k], style);
    }
    TextStyle name = label_;
    name.size = 15.0 * unit_;
    name.anchor = Anchor::middle;
    if (!options_.x_label.empty())
      canvas.text(Vec2{{frame_.centre().x(), options_.height - 12.0 * unit_}}, options_.x_label,
                  name);
    if (!options_.y_label.empty()) {
      name.upwards = true;
      canvas.text(Vec2{{22.0 * unit_, frame_.centre().y()}}, options_.y_label, name);
    }
    if (!options_.title.empty()) {
      TextStyle style = title_;
      const double room = options_.width - 20.0 * unit_,
                   width = view::text_width(options_.title, style);
      style.size *= std::clamp(room / std::max(width, 1.0), 0.5, 1.0);
      const double half = 0.5 * view::text_width(options_.title, style);
      const double centre =
          std::min(frame_.centre().x(),
                   std::max(0.5 * options_.width, options_.width - 10.0 * unit_ - half));
      canvas.text(Vec2{{centre, 29.0 * unit_}}, options_.title, style);
    }
  }

  std::vector<Vec2> points(std::size_t i) const {
    const Series& s = series_[i];
    std::vector<Vec2> out;
    for (std::size_t k = 0; k < s.x.size(); ++k) out.push_back(place(x_(s.x[k]), y_(s.y[k])));
    return out;
  }

  Stroke line_style(std::size_t i) const {
    Stroke stroke{looks_[i].colour, 1.8 * unit_};
    if (series_[i].dashed) stroke.dash = {7.0 * unit_, 5.0 * unit_};
    return stroke;
  }

  void draw_line(Canvas& canvas, std::size_t i, const std::vector<Vec2>& points) const {
    Path line, markers;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k == 0) {
        line.move(points[k]);
      } else {
        line.line(points[k]);
      }
      add_marker(markers, looks_[i].shape, points[k], looks_[i].radius * unit_);
    }
    if (points.size() > 1 && !series_[i].scatter) canvas.stroke(line, line_style(i));
    if (looks_[i].markers || points.size() == 1) canvas.fill(markers, looks_[i].colour);
  }

  void draw_series(Canvas& canvas, std::size_t i) const { draw_line(canvas, i, points(i)); }

  // ---- Legend: inside the frame where it hides nothing, else in rows above the frame

  double sample_width() const { return 34.0 * unit_; }

  void lay_out_legend() {
    double widest = 0.0;
    std::vector<double> widths;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      if (series_[i].name.empty()) continue;
      named_.push_back(i);
      // Viewers of SVG may have a wider font.
      const double width = 1.15 * view::text_width(series_[i].name, label_);
      widest = std::max(widest, width);
      widths.push_back(sample_width() + width + 28.0 * unit_);
    }
    if (named_.empty()) return;
    const double row = 21.0 * unit_, inset = 10.0 * unit_;
    const Vec2 size{
        {3.0 * inset + sample_width() + widest, inset + row * static_cast<double>(named_.size())}};
    view::LabelPlacer placer(frame_);
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const std::vector<Vec2> p = points(i);
      if (series_[i].scatter) {
        for (const Vec2& q : p) placer.avoid({&q, 1});
      } else {
        placer.avoid(p);
      }
    }
    const view::LabelPlacer::Room room = placer.room_at_side(size, 12.0 * unit_, 6.0 * unit_);
    const Vec2 first{{frame_.lo.x(), frame_.lo.y() + 0.3 * row}};
    view::LegendRows rows = view::legend_rows(widths, first, frame_.hi.x(), row);
    if (rows.count > 1) {  // in columns where that takes no more rows
      widths.assign(widths.size(), *std::max_element(widths.begin(), widths.end()));
      view::LegendRows columns = view::legend_rows(widths, first, frame_.hi.x(), row);
      if (columns.count == rows.count) rows = std::move(columns);
    }
    const double top = frame_.lo.y() + row * rows.count;
    if (room.covered && frame_.hi.y() - top > 0.5 * options_.height) {
      frame_.lo = Vec2{{frame_.lo.x(), top}};
      entries_ = std::move(rows.places);
      return;
    }
    legend_box_.include(room.corner);
    legend_box_.include(room.corner + size);
    for (std::size_t k = 0; k < named_.size(); ++k)
      entries_.push_back(room.corner +
                         Vec2{{inset, 0.5 * inset + row * (static_cast<double>(k) + 0.5)}});
  }

  void draw_legend(Canvas& canvas) const {
    if (!legend_box_.empty()) {
      Path outline;
      outline.rectangle(legend_box_);
      canvas.fill(outline, Colour{1.0, 1.0, 1.0, 0.88});
      canvas.stroke(outline, {major_grid, 0.8 * unit_});
    }
    for (std::size_t k = 0; k < named_.size(); ++k) {
      const std::size_t i = named_[k];
      const Vec2 from = entries_[k], to = from + Vec2{{sample_width(), 0.0}};
      Path line, marker;
      line.move(from);
      line.line(to);
      if (!series_[i].scatter) canvas.stroke(line, line_style(i));
      add_marker(marker, looks_[i].shape, 0.5 * (from + to), 4.0 * unit_);
      if (looks_[i].markers) canvas.fill(marker, looks_[i].colour);
      canvas.text(to + Vec2{{10.0 * unit_, 0.35 * label_.size}}, series_[i].name, label_);
    }
  }

  const std::vector<Series>& series_;
  const PlotOptions& options_;
  double unit_;
  Axis x_, y_;
  TextStyle label_, title_;
  Box2 frame_;
  std::vector<Look> looks_;
  std::vector<std::size_t> named_;  // series in the legend
  std::vector<Vec2> entries_;       // where their samples begin
  Box2 legend_box_;                 // empty: the legend is above the frame
};

}  // namespace

void plot(const std::string& path, const std::vector<Series>& series, const PlotOptions& options) {
  view::check_extension(path);
  check(series, options);
  const std::unique_ptr<Canvas> canvas = view::make_canvas(path, options.width, options.height);
  Plot(series, options).draw(*canvas);
  write_file(path, canvas->finish());
}

}  // namespace bezel
