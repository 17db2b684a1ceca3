#pragma once
// Still pictures of meshes and fields: SVG and PNG.

#include <optional>
#include <string>
#include <vector>

#include "bezel/field/field.hpp"

namespace bezel {

/// One layer of a picture: a mesh, or a field on it.
struct Layer {
  std::shared_ptr<const TriangleMesh> mesh;
  std::optional<Field> field;  ///< colours; without it only the mesh lines are drawn
  int component = 0;           ///< of the field; -1: Euclidean norm of a vector field
  bool mesh_lines = true;
  std::string line_colour;  ///< "#rrggbb"; empty: a default
  double line_width = 0.0;  ///< pixels; 0: default
};

/// Layers drawn on top of each other in one panel.
struct Panel {
  std::vector<Layer> layers;
  std::string title;
};

struct DrawOptions {
  int width = 1200, height = 0;            ///< pixels; height 0: from the aspect ratio
  std::string colour_map = "viridis";      ///< viridis, cividis, coolwarm, grey
  std::optional<double> lo = {}, hi = {};  ///< colour range; default: the fields' range, shared
                                           ///< by all panels
  bool colour_bar = true;
  int columns = 0;          ///< panels per row; 0: all in one row
  bool same_scale = false;  ///< a length is equally long in all panels; else each fills its place
};

/// Draws panels side by side to a .svg or .png file (by extension), atomically. Curved elements are
/// drawn as curves; colours are computed per pixel (PNG, by inverting the element map) or on
/// subdivided cells fine enough to look smooth (SVG).
/// @throws InputError for an unknown extension, colour map, or empty input
void draw(const std::string& path, const std::vector<Panel>& panels,
          const DrawOptions& options = {});

/// A line plot with optional logarithmic axes, for the studies.
struct Series {
  std::string name;
  std::vector<double> x, y;
  bool dashed = false;
  bool scatter = false;     ///< markers only, small ones when there are many
  std::string colour = {};  ///< "#rrggbb"; empty: the next of a palette
};
struct PlotOptions {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  int width = 800, height = 560;
};
/// Draws series to a .svg or .png file (by extension), atomically.
/// @throws InputError for an unknown extension or colour, sizes that differ, values that are not
/// finite or, on a logarithmic axis, not above 0
void plot(const std::string& path, const std::vector<Series>& series,
          const PlotOptions& options = {});

}  // namespace bezel
