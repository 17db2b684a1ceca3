#include "cli/study_curves_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bezel/fit/curve_domain.hpp"
#include "bezel/fit/curve_mesh.hpp"
#include "bezel/fit/curve_shapes.hpp"
#include "bezel/geometry/triangle.hpp"

namespace bezel::cli {
namespace {

constexpr double pi = std::numbers::pi;

/// Area between the far circle and the aerofoil: pi r^2 - 2 (int of half the thickness).
double exact_area() {
  const double foil = 1.2 * (0.2969 / 1.5 - 0.1260 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1036 / 5);
  return 2.25 * pi - foil;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    sum += area(mesh.degree(), mesh.gather(ElementId(e)));
  return sum;
}

struct Nodes {
  const char* name;
  const char* key;
  bool equal_parameter;
  CurveMethod method;
};
constexpr std::array<Nodes, 3> nodes = {
    {{"equal parameter", "equal_parameter", true, CurveMethod::standard},
     {"arc length", "arc_length", false, CurveMethod::arc_length},
     {"best", "best", false, CurveMethod::best}}};

}  // namespace

void add_aerofoil_meshes(StudyReport& report, bool quick) {
  const std::vector<SmoothCurve<2>> curves = {
      ellipse_arc(Vec2{{0.5, 0.0}}, 1.5, 1.5, 0.0, 2.0 * pi), naca4("0012", AerofoilPart::upper),
      naca4("0012", AerofoilPart::lower)};
  StudyTable table;
  table.file = "aerofoil";
  table.title = "Meshes around NACA 0012: distance of curved edges to the boundary";
  table.remark =
      "Triangles between the aerofoil and a circle of radius 1.5, every element proven valid. L2 "
      "norm of the distance over all boundary edges: nodes at equal steps of the curve's "
      "parameter, as mesh generators place them (Gmsh's nodes); by arc length; the best. "
      "Relaxation: in how many steps inner points had to move, 0 when blending was enough.";
  table.columns = {{"boundary edges", "edges"}, {"elements", "elements"}, {"degree", "degree"}};
  for (const Nodes& n : nodes) table.columns.push_back({n.name, n.key});
  table.columns.insert(table.columns.end(), {{"equal parameter / best", "ratio"},
                                             {"best: largest", "best_max"},
                                             {"best: error of the area", "best_area"},
                                             {"relaxation", "relaxation"},
                                             {"invalid", "invalid"}});
  std::vector<Series> series;
  for (int level = 0; level < (quick ? 2 : 3); ++level) {
    const double scale = std::ldexp(1.0, -level);
    const TriangleMesh straight = mesh_curve_domain(curves, {0.4 * scale, 0.8 * scale, 1});
    Series equal{{}, {}, {}, true}, best;
    for (int g = 1; g <= 4; ++g) {
      std::array<double, nodes.size()> distance{};
      double largest = 0.0, area_error = 0.0;
      std::size_t invalid = 0, edges = 0;
      int relaxation = 0;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        CurveMeshOptions options;
        options.degree = g;
        options.method = nodes[k].method;
        options.equal_parameter = nodes[k].equal_parameter;
        const CurvedMesh found = curve_mesh(straight, curves, options);
        distance[k] = found.distance_l2;
        invalid += found.invalid.size();
        relaxation = std::max(relaxation, found.relaxation_steps);
        edges = found.edges.size();
        largest = found.distance_max;
        area_error = std::fabs(area_of(found.mesh) - exact_area());
      }
      equal.name = fmt::format("equal parameter, {} edges", edges);
      best.name = fmt::format("best, {} edges", edges);
      add_point(equal, g, distance[0], 1e-17);
      add_point(best, g, distance[2], 1e-17);
      table.rows.push_back(
          {{count_cell(edges), count_cell(straight.element_count()), count_cell(g),
            number_cell(distance[0]), number_cell(distance[1]), number_cell(distance[2]),
            number_cell(distance[0] / distance[2]), number_cell(largest), number_cell(area_error),
            count_cell(relaxation), count_cell(invalid)}});
    }
    series.push_back(std::move(equal));
    series.push_back(std::move(best));
  }
  report.add(std::move(table));
  const PlotOptions options{
      .title = "Meshes around NACA 0012: distance of curved edges to the boundary",
      .x_label = "degree",
      .y_label = "L2 norm of the distance",
      .log_y = true};
  report.add_plot("aerofoil.svg", std::move(series), options);
}

}  // namespace bezel::cli
