#include "bezel/view/draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/view/canvas.hpp"
#include "bezel/view/marker.hpp"
#include "bezel/view/scalar.hpp"
#include "bezel/view/ticks.hpp"

namespace bezel {
namespace {

using view::Anchor;
using view::Canvas;
using view::Colour;
using view::ColourMap;
using view::FieldPaint;
using view::fit;
using view::ink;
using view::Path;
using view::Stroke;
using view::TextStyle;
using view::Ticks;
using view::Viewport;

constexpr int smallest_size = 64, largest_size = 16384;  // pixels
// Lines of the first, second ... mesh without a colour of its own.
constexpr std::array<const char*, 4> line_colours{"#333333", "#d62728", "#1f77b4", "#2ca02c"};

const TriangleMesh& mesh_of(const Layer& layer) {
  return layer.mesh ? *layer.mesh : layer.field->mesh();
}

void check_layer(const Layer& layer, const std::string& place) {
  if (!layer.mesh && !layer.field)
    throw InputError(place + ": neither a mesh nor a field, expected one");
  if (mesh_of(layer).element_count() == 0)
    throw InputError(place + ": the mesh has no elements, expected at least 1");
  if (layer.field) {
    if (layer.field->mesh().element_count() == 0)
      throw InputError(place + ": the field's mesh has no elements, expected at least 1");
    const int count = layer.field->components();
    if (layer.component < -1 || layer.component >= count)
      throw InputError(place + ": component " + std::to_string(layer.component) + " of field \"" +
                       layer.field->name() + "\", expected -1 to " + std::to_string(count - 1));
  }
  if (!layer.line_colour.empty()) view::parse_colour(layer.line_colour);
  if (!(layer.line_width >= 0.0 && layer.line_width <= 1000.0))
    throw InputError(place + ": line width " + std::to_string(layer.line_width) +
                     ", expected 0 to 1000 pixels");
}

void check(const std::vector<Panel>& panels, const DrawOptions& options) {
  if (panels.empty()) throw InputError("nothing to draw: 0 panels, expected at least 1");
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const std::string place = "panel " + std::to_string(p + 1);
    if (panels[p].layers.empty()) throw InputError(place + ": 0 layers, expected at least 1");
    for (std::size_t l = 0; l < panels[p].layers.size(); ++l)
      check_layer(panels[p].layers[l], place + ": layer " + std::to_string(l + 1));
  }
  const auto check_size = [](const char* name, int value) {
    if (value < smallest_size || value > largest_size)
      throw InputError(std::string(name) + " " + std::to_string(value) + ", expected " +
                       std::to_string(smallest_size) + " to " + std::to_string(largest_size) +
                       " pixels");
  };
  check_size("width", options.width);
  if (options.height != 0) check_size("height", options.height);
  if (options.columns < 0)
    throw InputError("columns " + std::to_string(options.columns) + ", expected at least 0");
  if ((options.lo && !std::isfinite(*options.lo)) || (options.hi && !std::isfinite(*options.hi)))
    throw InputError("colour range is not finite");
  if (options.lo && options.hi && !(*options.lo < *options.hi))
    throw InputError("colour range " + std::to_string(*options.lo) + " to " +
                     std::to_string(*options.hi) + ", expected a lower end below the upper end");
}

/// The colour range of all panels, never empty: a constant field gets the middle colour.
bernstein::Range colour_range(const std::vector<Panel>& panels, const DrawOptions& options) {
  bernstein::Range range{INFINITY, -INFINITY};
  for (const Panel& panel : panels)
    for (const Layer& layer : panel.layers) {
      if (!layer.field || (options.lo && options.hi)) continue;
      const bernstein::Range r = view::scalar_range(*layer.field, layer.component);
      range.lo = std::min(range.lo, r.lo);
      range.hi = std::max(range.hi, r.hi);
    }
  if (options.lo) range.lo = *options.lo;
  if (options.hi) range.hi = *options.hi;
  const double size = std::max(std::abs(range.lo), std::abs(range.hi));
  // Below this the ticks could not be told apart, and rounding would be shown as colour.
  if (!(range.hi - range.lo > 1e-12 * size)) {
    const double half = size > 0.0 ? 0.5 * size : 0.5;
    if (options.lo) {
      range.hi = range.lo + 2.0 * half;
    } else if (options.hi) {
      range.lo = range.hi - 2.0 * half;
    } else {
      const double middle = 0.5 * (range.lo + range.hi);
      range = {middle - half, middle + half};
    }
  }
  return range;
}

/// Sizes in pixels, which grow with the picture's width per column.
struct Layout {
  double unit, margin, gap, title_height, bar_width, bar_gap, label_size, title_size;
  double bar_space = 0.0;  // all that the colour bar takes to the right of the panels
  int columns, rows;
  double panel_width, panel_height;
  int height;
};

Box2 panel_box(const Panel& panel) {
  Box2 box;
  for (const Layer& layer : panel.layers) {
    box.include(mesh_of(layer).box());
    if (layer.field) box.include(layer.field->mesh().box());
  }
  return box;
}

/// What each panel shows: its meshes, of one scale if wanted.
std::vector<Box2> shown_boxes(const std::vector<Panel>& panels, const DrawOptions& options) {
  std::vector<Box2> boxes;
  Vec2 largest;
  for (const Panel& panel : panels) {
    boxes.push_back(panel_box(panel));
    const Vec2 size = boxes.back().hi - boxes.back().lo;
    for (int axis = 0; axis < 2; ++axis) largest[axis] = std::max(largest[axis], size[axis]);
  }
  if (!options.same_scale) return boxes;
  for (Box2& box : boxes) {
    const Vec2 centre = box.centre();
    box.include(centre - 0.5 * largest);
    box.include(centre + 0.5 * largest);
  }
  return boxes;
}

Layout lay_out(const std::vector<Panel>& panels, std::span<const Box2> boxes,
               const DrawOptions& options, double label_width) {
  Layout s{};
  const int count = static_cast<int>(panels.size());
  s.columns = options.columns == 0 ? count : std::min(options.columns, count);
  s.rows = (count + s.columns - 1) / s.columns;
  s.unit = std::clamp(options.width / 1000.0, 0.45, 4.0);
  s.margin = 18.0 * s.unit;
  s.gap = 22.0 * s.unit;
  s.label_size = 15.0 * s.unit;
  s.title_size = 19.0 * s.unit;
  const bool titles =
      std::any_of(panels.begin(), panels.end(), [](const Panel& p) { return !p.title.empty(); });
  s.title_height = titles ? 34.0 * s.unit : 0.0;
  s.bar_width = 20.0 * s.unit;
  s.bar_gap = 26.0 * s.unit;
  if (label_width > 0.0) s.bar_space = s.bar_gap + s.bar_width + 8.0 * s.unit + label_width;
  s.panel_width = std::max(
      8.0, (options.width - 2.0 * s.margin - s.bar_space - (s.columns - 1) * s.gap) / s.columns);
  if (options.height > 0) {
    s.height = options.height;
  } else {
    double aspect = 0.0;
    for (const Box2& box : boxes)
      aspect = std::max(aspect, (box.hi.y() - box.lo.y()) / (box.hi.x() - box.lo.x()));
    // Room for the colour bar's labels even beside a very flat mesh.
    const double panel = std::clamp(s.panel_width * aspect, 90.0 * s.unit, 2.0 * s.panel_width);
    const double height = 2.0 * s.margin + s.rows * (s.title_height + panel) + (s.rows - 1) * s.gap;
    s.height = std::clamp(static_cast<int>(std::ceil(height)), smallest_size, largest_size);
  }
  s.panel_height = std::max(
      8.0, (s.height - 2.0 * s.margin - s.rows * s.title_height - (s.rows - 1) * s.gap) / s.rows);
  return s;
}

/// Finer lines on finer meshes: a twelfth of the mean edge, at most one pixel (per unit).
double default_line_width(const TriangleMesh& mesh, const Viewport& viewport, double unit) {
  const Box2 box = mesh.box();
  const Vec2 size = box.hi - box.lo;
  const double edge = viewport.scale * std::sqrt(2.0 * size.x() * size.y() /
                                                 static_cast<double>(mesh.element_count()));
  return std::clamp(edge / 12.0, 0.25, 1.0) * unit;
}

void draw_mesh_lines(Canvas& canvas, const Layer& layer, std::size_t number,
                     const Viewport& viewport, double unit) {
  const TriangleMesh& mesh = mesh_of(layer);
  Stroke stroke;
  stroke.width =
      layer.line_width > 0.0 ? layer.line_width : default_line_width(mesh, viewport, unit);
  if (!layer.line_colour.empty()) {
    stroke.colour = view::parse_colour(layer.line_colour);
  } else if (layer.field) {
    stroke.colour = Colour{0.0, 0.0, 0.0, 0.55};
  } else {
    stroke.colour = view::parse_colour(line_colours[number % line_colours.size()]);
  }
  Path path;
  std::vector<Vec2> control(static_cast<std::size_t>(mesh.degree()) + 1);
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    mesh.gather_edge(EdgeId(e), control);
    for (Vec2& p : control) p = viewport(p);
    path.move(control.front());
    path.curve(control);
  }
  canvas.stroke(path, stroke);
}

void draw_panel(Canvas& canvas, const Panel& panel, const Box2& shown, const Box2& pixels,
                const bernstein::Range& range, const ColourMap& map, double unit) {
  const Viewport viewport = fit(shown, pixels);
  for (std::size_t l = 0; l < panel.layers.size(); ++l) {
    const Layer& layer = panel.layers[l];
    if (layer.field) {
      FieldPaint paint;
      paint.field = &*layer.field;
      paint.component = layer.component;
      paint.lo = range.lo;
      paint.hi = range.hi;
      paint.map = &map;
      paint.viewport = viewport;
      canvas.field(paint);
    }
    if (layer.mesh_lines) draw_mesh_lines(canvas, layer, l, viewport, unit);
  }
}

/// The name all fields share, or none.
std::string common_name(const std::vector<Panel>& panels) {
  std::string name;
  for (const Panel& panel : panels)
    for (const Layer& layer : panel.layers) {
      if (!layer.field) continue;
      const std::string own = view::scalar_name(*layer.field, layer.component);
      if (!name.empty() && name != own) return "";
      name = own;
    }
  return name;
}

void draw_colour_bar(Canvas& canvas, const Box2& box, const bernstein::Range& range,
                     const Ticks& ticks, const std::string& name, const ColourMap& map,
                     const Layout& s) {
  canvas.gradient(box, map);
  Path frame;
  frame.rectangle(box);
  Path marks;
  const TextStyle style{s.label_size, ink};
  for (std::size_t k = 0; k < ticks.major.size(); ++k) {
    const double t = (ticks.major[k] - range.lo) / (range.hi - range.lo);
    const double y = box.hi.y() - t * (box.hi.y() - box.lo.y());
    marks.move(Vec2{{box.hi.x(), y}});
    marks.line(Vec2{{box.hi.x() + 4.0 * s.unit, y}});
    canvas.text(Vec2{{box.hi.x() + 8.0 * s.unit, y + 0.35 * s.label_size}}, ticks.labels[k], style);
  }
  canvas.stroke(frame, {ink, 0.8 * s.unit});
  canvas.stroke(marks, {ink, 0.8 * s.unit});
  canvas.text(Vec2{{box.lo.x(), box.lo.y() - 9.0 * s.unit}}, name, style);
}

}  // namespace

void draw(const std::string& path, const std::vector<Panel>& panels, const DrawOptions& options) {
  view::check_extension(path);
  const ColourMap map(options.colour_map);
  check(panels, options);

  const bool any_field = std::any_of(panels.begin(), panels.end(), [](const Panel& panel) {
    return std::any_of(panel.layers.begin(), panel.layers.end(),
                       [](const Layer& l) { return l.field.has_value(); });
  });
  const bool bar = options.colour_bar && any_field;
  const bernstein::Range range =
      any_field ? colour_range(panels, options) : bernstein::Range{0.0, 1.0};

  // The labels' width decides the panels' width, which decides the height and so the number of
  // labels.
  const std::vector<Box2> shown = shown_boxes(panels, options);
  Layout s = lay_out(panels, shown, options, 0.0);
  Ticks ticks;
  const std::string name = bar ? common_name(panels) : "";
  if (bar) {
    for (int pass = 0; pass < 2; ++pass) {
      const double length = s.height - 2.0 * s.margin - s.title_height;
      ticks = view::linear_ticks(range.lo, range.hi,
                                 std::clamp(static_cast<int>(length / (55.0 * s.unit)), 2, 8));
      double width = view::text_width(name, {s.label_size, ink}) - s.bar_width - 8.0 * s.unit;
      for (const std::string& label : ticks.labels)
        width = std::max(width, view::text_width(label, {s.label_size, ink}));
      s = lay_out(panels, shown, options, std::min(std::max(width, 1.0), 0.25 * options.width));
    }
  }

  const std::unique_ptr<Canvas> canvas = view::make_canvas(path, options.width, s.height);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const double column = static_cast<double>(p % static_cast<std::size_t>(s.columns));
    const std::size_t row_number = p / static_cast<std::size_t>(s.columns);
    const double row = static_cast<double>(row_number);
    Box2 box;
    box.include(
        Vec2{{s.margin + column * (s.panel_width + s.gap),
              s.margin + s.title_height + row * (s.title_height + s.panel_height + s.gap)}});
    box.include(box.lo + Vec2{{s.panel_width, s.panel_height}});
    draw_panel(*canvas, panels[p], shown[p], box, range, map, s.unit);
    if (!panels[p].title.empty()) {
      TextStyle style{s.title_size, ink, Anchor::middle};
      // A long title shrinks to its panel, to half its size at most.
      const double width = view::text_width(panels[p].title, style);
      style.size *= std::clamp(s.panel_width / std::max(width, 1.0), 0.5, 1.0);
      canvas->text(Vec2{{box.centre().x(), box.lo.y() - 12.0 * s.unit}}, panels[p].title, style);
    }
  }
  if (bar) {
    const double name_height =
        name.empty() ? 0.0 : std::max(0.0, s.label_size + 6.0 * s.unit - s.title_height);
    Box2 box;
    box.include(Vec2{{options.width - s.margin - s.bar_space + s.bar_gap,
                      s.margin + s.title_height + name_height}});
    box.include(Vec2{{box.lo.x() + s.bar_width, s.height - s.margin}});
    draw_colour_bar(*canvas, box, range, ticks, name, map, s);
  }
  write_file(path, canvas->finish());
}

}  // namespace bezel
