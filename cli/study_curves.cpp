// Interpolation of curves in the plane [bjontegaard2009, sec. 2.6]: figures 6 to 17, with the
// numbers of an independent prototype beside ours, since the paper has plots and no tables.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "bezel/bernstein/interval.hpp"
#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/fit/curve_shapes.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "cli/curve_reference.hpp"
#include "cli/study.hpp"
#include "cli/study_curves_mesh.hpp"
#include "cli/study_report.hpp"

namespace bezel::cli {
namespace {

constexpr int first_degree = 2;
constexpr double shown_floor = 1e-17;

struct Case {
  const char* title;
  const char* x;
  const char* y;
  std::vector<double> breaks;
  int goal_degree;
  double goal;
};
const std::array<Case, 5>& cases() {
  static const std::array<Case, 5> all = {
      {{"Case 1: two thirds of pi of a circle", "sin(pi*t/3)", "cos(pi*t/3)", {}, 7, 2.5e-13},
       {"Case 2: y = 1/(1 + 16 x^2)", "t", "1/(1 + 16*t^2)", {}, 15, 2e-14},
       {"Case 3: y = sqrt((x + 2)^(1/3) - 1)", "t + 0.1", "sqrt(cbrt(t + 2.1) - 1)", {}, 6, 1e-15},
       {"Case 4: y = 1 - |x|^3", "t", "1 - abs(t)^3", {0.0}, 16, 1e-13},
       {"Case 5: y = exp(-x) cos(2 pi x) / 2",
        "t + 1",
        "0.5*exp(-(t + 1))*cos(2*pi*(t + 1))",
        {},
        13,
        2e-14}}};
  return all;
}

SmoothCurve<2> curve_of(const Case& c) {
  const std::vector<Formula> xy = {Formula(c.x, {"t"}), Formula(c.y, {"t"})};
  return formula_curve<2>(xy, -1.0, 1.0, c.breaks);
}

constexpr std::array<std::pair<CurveMethod, const char*>, 7> methods = {
    {{CurveMethod::standard, "standard"},
     {CurveMethod::chord, "chord"},
     {CurveMethod::arc_length, "arc length"},
     {CurveMethod::l2, "L2"},
     {CurveMethod::equal_tangent, "equal tangent"},
     {CurveMethod::best, "best"},
     {CurveMethod::orthogonal_distance, "least distance"}}};
constexpr std::size_t equal_tangent = 4, best = 5, with_reference = 6;

using Found = std::array<std::vector<CurveInterpolant<2>>, methods.size()>;

std::string key_of(std::size_t m) {
  std::string key = methods[m].second;
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

/// A measure of an interpolant; none when the method does not apply.
Cell measured(const CurveInterpolant<2>& p, double error) {
  return number_cell(p.nodal.empty() ? NAN : error);
}

bool in_markdown(int degree) {
  return degree <= 10 || degree == 12 || degree % 5 == 0;
}

void error_table(StudyReport& report, std::size_t k, const Found& found) {
  StudyTable table;
  table.file = fmt::format("case_{}", k + 1);
  table.title = fmt::format("{}: error (4)", cases()[k].title);
  table.remark =
      "The L2 norm of y - y_N over x, by 3N+1 Gauss-Lobatto points. Expected: an independent "
      "prototype's; its \"best\" is a search like ours.";
  table.columns = {{"N", "degree"}};
  for (std::size_t m = 0; m < methods.size(); ++m)
    table.columns.push_back({methods[m].second, key_of(m)});
  for (std::size_t m = 0; m < with_reference; ++m)
    table.columns.push_back({methods[m].second, key_of(m) + "_expected", true});
  const CurveReference& reference = curve_reference(k);
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    const int n = first_degree + static_cast<int>(i);
    StudyRow row{{count_cell(n)}, in_markdown(n)};
    for (const auto& list : found) row.cells.push_back(measured(list[i], list[i].errors.l2));
    for (std::size_t m = 0; m < with_reference; ++m)
      row.cells.push_back(number_cell(reference.l2[m][i]));
    table.rows.push_back(std::move(row));
  }
  report.add(std::move(table));
}

void distance_table(StudyReport& report, std::size_t k, const Found& found) {
  StudyTable table;
  table.file = fmt::format("case_{}_distance", k + 1);
  table.title = fmt::format("{}: distance to the curve", cases()[k].title);
  table.remark =
      "L2 norm and maximum of the distance at 200 points, whatever the parameters: what error (4) "
      "cannot see. Expected: the smallest of all interpolants of the prototype; the ratio is to "
      "that, or to 2e-14 when that is larger.";
  table.columns = {{"N", "degree"},
                   {"arc length", "arc_length"},
                   {"equal tangent", "equal_tangent"},
                   {"best", "best"},
                   {"best: largest", "best_max"},
                   {"best: error of the length", "best_length"},
                   {"best: kind", "kind"},
                   {"best / expected", "ratio"},
                   {"smallest", "smallest_expected", true}};
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    const int n = first_degree + static_cast<int>(i);
    const CurveInterpolant<2>& b = found[best][i];
    const double expected = curve_reference(k).distance[i];
    table.rows.push_back(
        {{count_cell(n), measured(found[2][i], found[2][i].errors.distance_l2),
          measured(found[equal_tangent][i], found[equal_tangent][i].errors.distance_l2),
          number_cell(b.errors.distance_l2), number_cell(b.errors.distance_max),
          number_cell(b.errors.arc_length), text_cell(std::string(name(b.nodes.kind))),
          number_cell(b.errors.distance_l2 / std::max(expected, 2e-14)), number_cell(expected)},
         in_markdown(n)});
  }
  report.add(std::move(table));
}

PlotOptions plot_options(const std::string& title, const std::string& x, const std::string& y,
                         bool logarithmic) {
  return {.title = title, .x_label = x, .y_label = y, .log_y = logarithmic};
}

void error_plot(StudyReport& report, std::size_t k, const Found& found, int figure,
                bool of_length) {
  std::vector<Series> series;
  for (std::size_t m = 0; m <= best; ++m) {
    Series line{methods[m].second, {}, {}};
    for (std::size_t i = 0; i < found[m].size(); ++i) {
      if (found[m][i].nodal.empty()) continue;
      const CurveErrors& e = found[m][i].errors;
      add_point(line, first_degree + static_cast<double>(i), of_length ? e.arc_length : e.l2,
                shown_floor);
    }
    if (!line.x.empty()) series.push_back(std::move(line));
  }
  if (!of_length) {
    Series theirs{"equal tangent, prototype", {}, {}, true};
    theirs.colour = "#777777";
    for (std::size_t i = 0; i < found[0].size(); ++i)
      add_point(theirs, first_degree + static_cast<double>(i),
                curve_reference(k).l2[equal_tangent][i], shown_floor);
    series.push_back(std::move(theirs));
  }
  report.add_plot(fmt::format("figure_{}{}.svg", figure, of_length ? "_length" : ""),
                  std::move(series),
                  plot_options(fmt::format("Figure {}: {}", figure, cases()[k].title), "degree N",
                               of_length ? "error of the arc length" : "error (4)", true));
}

/// The curve, or an interpolant, as a line of many points.
Series exact_line(const SmoothCurve<2>& curve, const std::string& name) {
  Series line{name, {}, {}};
  for (int i = 0; i <= 400; ++i) {
    const Vec2 p = curve(-1.0 + i / 200.0).x;
    line.x.push_back(p.x());
    line.y.push_back(p.y());
  }
  line.colour = "#999999";
  return line;
}
Series interpolant_line(const CurveInterpolant<2>& p, const std::string& name) {
  Series line{name, {}, {}};
  for (int i = 0; i <= 400; ++i) {
    const Vec2 q = bernstein::evaluate<Vec2>(p.control, i / 400.0);
    line.x.push_back(q.x());
    line.y.push_back(q.y());
  }
  return line;
}
Series nodes(const CurveInterpolant<2>& p, const std::string& name, double shift) {
  Series points{name, {}, {}, false, true};
  for (const Vec2& q : p.nodal) {
    points.x.push_back(q.x());
    points.y.push_back(q.y() + shift);
  }
  return points;
}

class Figures {
 public:
  Figures(StudyReport& report, std::size_t k, const SmoothCurve<2>& curve,
          const CurveInterpolator& interpolator)
      : report_(report), k_(k), curve_(curve), interpolator_(interpolator) {}

  void add() const {
    if (k_ == 0) placement();
    if (k_ == 1)
      for (const int n : {4, 10}) runge(n);
    if (k_ == 2) indistinguishable();
    if (k_ == 3) {
      outline(12);
      clustering();
      coordinates();
    }
    if (k_ == 4) outline(16);
  }

 private:
  CurveInterpolant<2> at(int n, CurveMethod method) const {
    return interpolator_.interpolate(curve_, n, method);
  }
  void plot(const std::string& file, std::vector<Series> series, const std::string& title,
            const char* x = "x", const char* y = "y") const {
    report_.add_plot(file, std::move(series), plot_options(title, x, y, false));
  }

  void placement() const {
    std::vector<Series> series;
    double shift = 0.0;
    for (const std::size_t m : {0U, 2U, 3U, 4U}) {
      Series line = exact_line(curve_, "");
      for (double& y : line.y) y += shift;
      series.push_back(std::move(line));
      series.push_back(nodes(at(7, methods[m].first), methods[m].second, shift));
      shift -= 0.2;
    }
    plot("figure_6.svg", std::move(series),
         "Figure 6: nodes on the circle, N = 7 (curves shifted downwards)");
  }
  void runge(int n) const {
    std::vector<Series> series = {
        exact_line(curve_, "curve"), interpolant_line(at(n, CurveMethod::standard), "standard"),
        interpolant_line(at(n, CurveMethod::equal_tangent), "equal tangent")};
    plot(fmt::format("figure_8_n{}.svg", n), std::move(series),
         fmt::format("Figure 8: y = 1/(1 + 16 x^2), N = {}", n));
  }
  void indistinguishable() const {
    std::vector<Series> series = {exact_line(curve_, "curve")};
    for (const std::size_t m : {0U, 1U, 2U})
      series.push_back(interpolant_line(at(6, methods[m].first), methods[m].second));
    plot("figure_10.svg", std::move(series), "Figure 10: y = sqrt((x + 2)^(1/3) - 1), N = 6");
  }
  void outline(int figure) const {
    std::vector<Series> series = {exact_line(curve_, "curve"),
                                  nodes(at(10, CurveMethod::best), "nodes, best, N = 10", 0.0)};
    plot(fmt::format("figure_{}.svg", figure), std::move(series),
         fmt::format("Figure {}: {}", figure, cases()[k_].title));
  }
  void clustering() const {
    std::vector<Series> series = {exact_line(curve_, "")};
    double level = 1.15;
    for (const std::size_t m : {0U, 4U, 5U}) {
      series.push_back(nodes(at(15, methods[m].first), methods[m].second, 0.0));
      std::fill(series.back().y.begin(), series.back().y.end(), level);
      level += 0.15;
    }
    plot("figure_13.svg", std::move(series),
         "Figure 13: nodes on y = 1 - |x|^3, N = 15, their x in rows above");
  }
  void coordinates() const {
    std::vector<Series> series;
    for (const auto& [method, name] : {std::pair{CurveMethod::standard, "standard"},
                                       {CurveMethod::equal_tangent, "equal tangent"}}) {
      const CurveInterpolant<2> p = at(15, method);
      for (const int c : {0, 1}) {
        Series line{fmt::format("{}_N, {}", c == 0 ? "x" : "y", name), {}, {}};
        for (int i = 0; i <= 200; ++i) {
          line.x.push_back(-1.0 + 0.01 * i);
          line.y.push_back(bernstein::evaluate<Vec2>(p.control, i / 200.0)[c]);
        }
        series.push_back(std::move(line));
      }
    }
    plot("figure_14.svg", std::move(series), "Figure 14: x_N and y_N of case 4, N = 15", "xi",
         "x_N, y_N");
  }

  StudyReport& report_;
  std::size_t k_;
  const SmoothCurve<2>& curve_;
  const CurveInterpolator& interpolator_;
};

/// The same curves as compiled functions: times are those of the search, not of formulas.
SmoothCurve<2> compiled(std::size_t k) {
  using Height = Vec3 (*)(double x);  // y, y', y''
  const auto graph = [&](double shift, Height height) {
    return SmoothCurve<2>(
        [shift, height](double t) {
          const Vec3 y = height(t + shift);
          return CurveJet<2>{Vec2{{t + shift, y[0]}}, Vec2{{1.0, y[1]}}, Vec2{{0.0, y[2]}}};
        },
        cases()[k].breaks);
  };
  constexpr double pi = std::numbers::pi;
  switch (k) {
    case 0:
      return ellipse_arc(Vec2{}, 1.0, 1.0, 5.0 * pi / 6.0, pi / 6.0);
    case 1:
      return graph(0.0, [](double x) {
        const double y = 1.0 / (1.0 + 16.0 * x * x);
        return Vec3{{y, -32.0 * x * y * y, 32.0 * y * y * (64.0 * x * x * y - 1.0)}};
      });
    case 2:
      return graph(0.1, [](double x) {
        const double u = x + 2.0, c = std::cbrt(u), y = std::sqrt(c - 1.0);
        const double c1 = c / (3.0 * u), c2 = -2.0 * c1 / (3.0 * u);
        return Vec3{{y, c1 / (2.0 * y), (c2 - c1 * c1 / (2.0 * (c - 1.0))) / (2.0 * y)}};
      });
    case 3:
      return graph(0.0, [](double x) {
        const double a = std::fabs(x);
        return Vec3{{1.0 - a * a * a, -3.0 * x * a, -6.0 * a}};
      });
    default:
      return graph(1.0, [](double x) {
        const double e = 0.5 * std::exp(-x), w = 2.0 * pi;
        const double c = e * std::cos(w * x), s = e * std::sin(w * x);
        return Vec3{{c, -c - w * s, c + 2.0 * w * s - w * w * c}};
      });
  }
}

/// Microseconds of one placement of nodes, the least of several runs.
double microseconds(const CurveInterpolator& interpolator, const SmoothCurve<2>& curve, int n,
                    CurveMethod method) {
  using Clock = std::chrono::steady_clock;
  double least = INFINITY;
  const auto start = Clock::now();
  for (int run = 0; run < 20; ++run) {
    const auto before = Clock::now();
    (void)interpolator.place(curve, n, method);
    const std::chrono::duration<double, std::micro> took = Clock::now() - before;
    least = std::min(least, took.count());
    if (Clock::now() - start > std::chrono::milliseconds(50)) break;
  }
  return least;
}

void work_table(StudyReport& report, const CurveInterpolator& interpolator) {
  StudyTable table;
  table.file = "work";
  table.title = "Newton iterations and time per curve";
  table.remark =
      "All degrees from 2 to N on the way. Expected iterations: the prototype's (a language "
      "interpreter: its times would say nothing). Expected times: what was aimed at.";
  table.columns = {{"case", "case"},
                   {"N", "degree"},
                   {"Newton iterations, equal tangent", "iterations"},
                   {"microseconds, equal tangent", "microseconds"},
                   {"microseconds, best", "best_microseconds"},
                   {"Newton iterations, equal tangent", "iterations_expected", true},
                   {"microseconds, equal tangent", "microseconds_expected", true},
                   {"microseconds, best", "best_microseconds_expected", true}};
  for (std::size_t k = 0; k < cases().size(); ++k) {
    const SmoothCurve<2> curve = compiled(k);
    for (const int n : {5, 10, 15, 20, 30}) {
      if (n > interpolator.max_degree()) continue;
      std::size_t theirs = 0;
      for (int i = first_degree; i <= n; ++i)
        theirs += static_cast<std::size_t>(
            curve_reference(k).iterations[static_cast<std::size_t>(i - first_degree)]);
      const CurveNodes found = interpolator.place(curve, n, CurveMethod::equal_tangent);
      const double goal = k > 2 ? NAN : n == 10 ? 20.0 : n == 15 ? 60.0 : NAN;
      table.rows.push_back(
          {{count_cell(k + 1), count_cell(n), count_cell(found.newton_iterations),
            number_cell(microseconds(interpolator, curve, n, CurveMethod::equal_tangent)),
            number_cell(microseconds(interpolator, curve, n, CurveMethod::best)),
            count_cell(theirs), number_cell(goal), number_cell(k > 2 ? 1e4 : 1e3)}});
    }
  }
  report.add(std::move(table));
}

}  // namespace

int run_study_curves(const std::string& out_dir, bool quick, bool json) {
  const int last_degree = quick ? 16 : max_curve_degree;
  const CurveInterpolator interpolator(last_degree);
  StudyReport report("curves");
  std::vector<SmoothCurve<2>> curves;
  StudyTable goals;
  goals.file = "goals";
  goals.title = "Error (4) of the best interpolant where it is asked for";
  goals.columns = {
      {"case", "case"}, {"N", "degree"}, {"error (4)", "l2"}, {"at most", "goal", true}};
  for (std::size_t k = 0; k < cases().size(); ++k) {
    curves.push_back(curve_of(cases()[k]));
    Found found;
    for (std::size_t m = 0; m < methods.size(); ++m)
      for (int n = first_degree; n <= last_degree; ++n)
        found[m].push_back(interpolator.interpolate(curves[k], n, methods[m].first));
    const auto goal = static_cast<std::size_t>(cases()[k].goal_degree);
    goals.rows.push_back(
        {{count_cell(k + 1), count_cell(goal),
          number_cell(found[best][goal - first_degree].errors.l2), number_cell(cases()[k].goal)}});
    error_table(report, k, found);
    constexpr std::array<int, 5> figure = {7, 9, 11, 15, 17};
    error_plot(report, k, found, figure[k], false);
    if (k < 2) error_plot(report, k, found, figure[k], true);
    Figures(report, k, curves[k], interpolator).add();
    distance_table(report, k, found);
  }
  report.add(std::move(goals));
  work_table(report, interpolator);
  add_aerofoil_meshes(report, quick);
  report.write(out_dir, json);
  return 0;
}

}  // namespace bezel::cli
