// Deformed quadrilaterals [bjontegaard2009, sec. 3]: how well the sides are placed decides the
// errors of the area and of a spectral solution.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "bezel/base/parallel.hpp"
#include "bezel/solve/spectral.hpp"
#include "cli/domain_cases.hpp"
#include "cli/domain_reference.hpp"
#include "cli/study.hpp"
#include "cli/study_report.hpp"

namespace bezel::cli {
namespace {

/// In the order of domain_reference, which has the first six.
constexpr std::array methods{CurveMethod::standard,      CurveMethod::chord,
                             CurveMethod::arc_length,    CurveMethod::l2,
                             CurveMethod::equal_tangent, CurveMethod::orthogonal_distance,
                             CurveMethod::best};
constexpr std::size_t equal_tangent = 4;
constexpr std::size_t reference_methods = 6;

struct Reached {
  double area_error = 0.0;
  double energy_error = std::numeric_limits<double>::quiet_NaN();  // of a folded map
  JacobianRange jacobian;
};

/// Results of one domain: [degree][method].
using DomainResults = std::vector<std::array<Reached, methods.size()>>;

Reached measure(const DomainCase& domain, int degree, CurveMethod method,
                const CurveInterpolator& interpolator) {
  static const Formula exact("exp(x)*sin(y)"), d_y("exp(x)*cos(y)");
  const auto gradient = [](double x, double y) { return Vec2{exact(x, y), d_y(x, y)}; };
  const GordonHall map = gordon_hall(domain.curves, degree, method, interpolator);
  Reached out;
  out.area_error = std::fabs(map.area() - domain.area);
  out.jacobian = map.jacobian_range();
  if (out.jacobian.min > 0.0) {
    SpectralOptions options;
    options.threads = 1;
    out.energy_error = solve_poisson(map, {exact}, options).errors(exact, gradient).energy;
  }
  return out;
}

std::array<DomainResults, 3> measure_all(const std::array<DomainCase, 3>& domains,
                                         const std::vector<int>& degrees,
                                         const CurveInterpolator& interpolator, int threads) {
  std::array<DomainResults, 3> results;
  for (DomainResults& domain : results) domain.resize(degrees.size());
  const std::size_t per_domain = degrees.size() * methods.size();
  parallel_for(
      3 * per_domain,
      [&](std::size_t k) {
        const std::size_t domain = k / per_domain, degree = k % per_domain / methods.size(),
                          method = k % methods.size();
        results[domain][degree][method] =
            measure(domains[domain], degrees[degree], methods[method], interpolator);
      },
      threads);
  return results;
}

std::string words(CurveMethod method) {
  std::string text(name(method));
  std::replace(text.begin(), text.end(), '-', ' ');
  return text;
}

StudyTable error_table(int number, const DomainCase& domain, const std::vector<int>& degrees,
                       const DomainResults& results) {
  StudyTable table;
  table.file = fmt::format("domain_{}", number);
  table.title = fmt::format("Domain {}: {}", number, domain.sides);
  table.remark =
      "Errors of the area and of u = exp(x) sin(y), in the energy norm; expected: those of an "
      "independent prototype (only for degrees and methods it has). Jacobian determinants are "
      "those on the grid of degree 3N.";
  table.columns = {{"N", "degree"},
                   {"sides placed by", "method"},
                   {"area error", "area_error"},
                   {"area error", "area_error_expected", true},
                   {"energy error", "energy_error"},
                   {"energy error", "energy_error_expected", true},
                   {"smallest determinant", "jacobian_min"},
                   {"largest determinant", "jacobian_max"}};
  for (std::size_t d = 0; d < degrees.size(); ++d)
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Reached& r = results[d][m];
      std::optional<DomainErrors> expected;
      if (m < reference_methods)
        expected = domain_reference(number, degrees[d], static_cast<int>(m));
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      table.rows.push_back(
          {{count_cell(degrees[d]), text_cell(words(methods[m])), number_cell(r.area_error),
            number_cell(expected ? expected->area : none), number_cell(r.energy_error),
            number_cell(expected ? expected->energy : none), number_cell(r.jacobian.min),
            number_cell(r.jacobian.max)},
           degrees[d] % 6 == 0 || degrees[d] == 4});
    }
  return table;
}

/// One line per method, and the prototype's equal tangent.
void add_error_plot(StudyReport& report, int figure, int number, bool energy,
                    const std::vector<int>& degrees, const DomainResults& results) {
  std::vector<Series> series;
  constexpr double lowest = 1e-16;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (methods[m] == CurveMethod::orthogonal_distance) continue;  // best, but for a few degrees
    Series line{words(methods[m]), {}, {}};
    for (std::size_t d = 0; d < degrees.size(); ++d)
      add_point(line, degrees[d], energy ? results[d][m].energy_error : results[d][m].area_error,
                lowest);
    series.push_back(std::move(line));
  }
  Series prototype{"equal tangent, prototype", {}, {}, true};
  prototype.colour = "#555555";
  for (const int degree : degrees) {
    const DomainErrors e = domain_reference(number, degree, static_cast<int>(equal_tangent));
    add_point(prototype, degree, energy ? e.energy : e.area, lowest);
  }
  series.push_back(std::move(prototype));
  const PlotOptions options{
      .title = fmt::format("Domain {}: error of {}", number,
                           energy ? "the solution in the energy norm" : "the area"),
      .x_label = "degree N",
      .y_label = energy ? "energy error" : "area error (drawn from 1e-16)",
      .log_y = true};
  report.add_plot(fmt::format("figure_{}.svg", figure), std::move(series), options);
}

/// The lines of constant xi and eta through the nodes of a map.
CurvePicture grid_picture(const GordonHall& map, const std::string& legend) {
  const auto n = static_cast<std::size_t>(map.degree()) + 1;
  DrawnShape lines{legend, {}, false};
  std::vector<Vec2> line(n);
  for (std::size_t k = 0; k < n; ++k) {
    lines.curves.push_back(map.basis().to_bernstein(map.nodes().subspan(k * n, n)));
    for (std::size_t j = 0; j < n; ++j) line[j] = map.nodes()[j * n + k];
    lines.curves.push_back(map.basis().to_bernstein(std::span<const Vec2>(line)));
  }
  CurvePicture picture;
  picture.shapes.push_back(std::move(lines));
  return picture;
}

void add_grid(StudyReport& report, const std::string& file, const GordonHall& map,
              const std::string& legend, const std::string& title) {
  CurveDrawOptions options;
  options.control_polygons = false;
  report.add_picture(file, title, grid_picture(map, legend), options);
}

/// Figures 18, 21 and 24: a usual grid, and one whose sides are placed by equal tangents.
void add_grids(StudyReport& report, int number, const DomainCase& domain,
               const CurveInterpolator& interpolator) {
  const int figure = 15 + 3 * number, degree = number == 3 ? 20 : 10;
  const GordonHall tangent =
      gordon_hall(domain.curves, degree, CurveMethod::equal_tangent, interpolator);
  GordonHall usual = gordon_hall(domain.curves, degree, CurveMethod::standard, interpolator);
  std::string usual_name = "standard";
  if (number == 3) {
    // As the paper has it: the top, an arc of a circle, by arc length, the other sides by chord.
    const auto side = [&](const PlaneCurve& curve, CurveMethod method) {
      std::vector<Vec2> nodes;
      for (const double t : interpolator.place(curve, degree, method).t)
        nodes.push_back(curve(t).x);
      return nodes;
    };
    usual = GordonHall({side(domain.curves.bottom, CurveMethod::chord),
                        side(domain.curves.right, CurveMethod::chord),
                        side(domain.curves.top, CurveMethod::arc_length),
                        side(domain.curves.left, CurveMethod::chord)});
    usual_name = "arc length and chord";
  }
  const auto title = [&](const std::string& how) {
    return fmt::format("Domain {}: grid of degree {}, {}", number, degree, how);
  };
  add_grid(report, fmt::format("figure_{}_usual.svg", figure), usual,
           fmt::format("{}, N = {}", usual_name, degree), title(usual_name));
  add_grid(report, fmt::format("figure_{}_equal_tangent.svg", figure), tangent,
           fmt::format("equal tangent, N = {}", degree), title("equal tangent"));
}

StudyTable goal_table(const std::vector<int>& degrees,
                      const std::array<DomainResults, 3>& results) {
  StudyTable table;
  table.file = "goals";
  table.title = "What equal tangents should reach";
  table.columns = {{"domain", "domain"}, {"error of", "quantity"},  {"N", "degree"},
                   {"error", "error"},   {"at most", "goal", true}, {"reached", "reached"}};
  const auto add = [&](std::size_t domain, const char* quantity, int degree, double goal,
                       double Reached::*error) {
    const auto at = std::find(degrees.begin(), degrees.end(), degree);
    if (at == degrees.end()) return;
    const double found =
        results[domain][static_cast<std::size_t>(at - degrees.begin())][equal_tangent].*error;
    table.rows.push_back({{count_cell(domain + 1), text_cell(quantity), count_cell(degree),
                           number_cell(found), number_cell(goal), yes_cell(found <= goal)}});
  };
  constexpr std::array energy_goals{5e-5, 4e-7, 4e-5};
  for (std::size_t domain = 0; domain < 3; ++domain)
    add(domain, "area", 18, 1e-14, &Reached::area_error);
  for (std::size_t domain = 0; domain < 3; ++domain)
    add(domain, "energy", 24, energy_goals[domain], &Reached::energy_error);
  return table;
}

}  // namespace

int run_study_domains(const std::string& out_dir, bool quick, int threads, bool json) {
  std::vector<int> degrees{4, 8, 12, 18, 24};
  if (!quick) {
    degrees.clear();
    for (int degree = 4; degree <= 24; degree += 2) degrees.push_back(degree);
  }
  const std::array<DomainCase, 3> domains = domain_cases();
  const CurveInterpolator interpolator(degrees.back());
  const auto results = measure_all(domains, degrees, interpolator, threads);

  StudyReport report("domains");
  for (int number = 1; number <= 3; ++number) {
    const auto at = static_cast<std::size_t>(number) - 1;
    report.add(error_table(number, domains[at], degrees, results[at]));
    add_grids(report, number, domains[at], interpolator);
    add_error_plot(report, 16 + 3 * number, number, false, degrees, results[at]);
    add_error_plot(report, 17 + 3 * number, number, true, degrees, results[at]);
  }
  report.add(goal_table(degrees, results));
  report.write(out_dir, json);
  return ok;
}

}  // namespace bezel::cli
