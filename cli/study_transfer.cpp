// The convergence study of conservative transfer: random meshes of a square and of the unit disc
// inside it, refined four times, three smooth fields, linear to cubic [hermes2018, sec. 4.4].

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "bezel/field/field.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "cli/study.hpp"
#include "cli/study_report.hpp"

namespace bezel::cli {
namespace {

struct Function {
  const char* name;
  const char* text;
};
constexpr std::array<Function, 3> functions = {{{"zeta1", "5*y^3 + x^2 + 2*y + 3"},
                                                {"zeta2", "exp(x^2) + 2*y"},
                                                {"zeta3", "sin(x) + cos(y)"}}};
constexpr std::array<const char*, 3> degree_names = {"linear", "quadratic", "cubic"};
// Of lines of the physical and the reference basis.
constexpr std::array<std::array<const char*, 2>, 3> degree_colours = {
    {{"#0072b2", "#56b4e9"}, {"#b34700", "#f0a050"}, {"#00664b", "#5fc9a5"}}};
constexpr int most_levels = 5;

/// Relative L2 errors read off the plots of [hermes2018, fig. 4.17] (axis calibration +-4 %); 0:
/// not published.
using Published = std::array<double, most_levels>;
constexpr std::array<std::array<Published, 3>, 3> published = {{
    {{{0, 1.41e-2, 3.49e-3, 8.78e-4, 2.19e-4},
      {4.89e-3, 5.91e-4, 7.36e-5, 9.17e-6, 1.15e-6},
      {1.0e-5, 6.7e-8, 3.3e-10, 4.2e-11, 3.2e-10}}},
    {{{0, 1.02e-2, 2.51e-3, 6.28e-4, 1.57e-4},
      {2.99e-3, 4.20e-4, 5.55e-5, 7.06e-6, 8.84e-7},
      {4.36e-4, 2.93e-5, 1.91e-6, 1.21e-7, 7.63e-9}}},
    {{{0, 3.61e-3, 9.05e-4, 2.26e-4, 5.66e-5},
      {7.37e-4, 8.48e-5, 1.02e-5, 1.27e-6, 1.58e-7},
      {3.13e-5, 1.86e-6, 1.17e-7, 7.31e-9, 5.33e-10}}},
}};

struct Level {
  std::size_t donor_elements = 0, target_elements = 0;
  std::array<double, functions.size()> physical{}, reference{};  // errors by the donor's basis
  double mass_defect = 0.0, partition_residual = 0.0;
  TransferReport::Seconds seconds;  // of all transfers of this level
  std::int64_t pairs = 0;
};
/// [degree - 1][level]
using Levels = std::array<std::vector<Level>, degree_names.size()>;

Level measure(const std::shared_ptr<const TriangleMesh>& donor,
              const std::shared_ptr<const TriangleMesh>& target,
              const std::vector<Formula>& formulas) {
  Level out;
  out.donor_elements = donor->element_count();
  out.target_elements = target->element_count();
  for (const Basis basis : {Basis::physical, Basis::reference}) {
    const auto space = Space::discontinuous(donor, donor->degree(), basis);
    std::vector<Field> fields;
    for (std::size_t f = 0; f < functions.size(); ++f)
      fields.push_back(bezel::sample(functions[f].name, space, std::span(&formulas[f], 1)));
    const TransferResult moved = bezel::transfer(fields, target);
    for (std::size_t f = 0; f < functions.size(); ++f) {
      (basis == Basis::physical ? out.physical : out.reference)[f] =
          error_norms(moved.fields[f], std::span(&formulas[f], 1)).l2_relative;
      out.mass_defect = std::max(out.mass_defect, moved.report.fields[f].relative_mass_defect);
    }
    out.partition_residual = std::max(out.partition_residual, moved.report.max_partition_residual);
    out.pairs = moved.report.pairs;
    const TransferReport::Seconds& took = moved.report.seconds;
    out.seconds.total += took.total;
    out.seconds.overlay += took.overlay;
    out.seconds.integrate += took.integrate;
    out.seconds.solve += took.solve;
  }
  return out;
}

Levels measure_all(int count) {
  std::vector<Formula> formulas;
  formulas.reserve(functions.size());
  for (const Function& f : functions) formulas.emplace_back(f.text);
  Levels out;
  for (int g = 1; g <= static_cast<int>(out.size()); ++g) {
    GenerateOptions square;
    square.degree = g;
    square.size = 0.36;
    square.seed = 1;
    GenerateOptions disc = square;
    disc.size = 0.54;
    disc.seed = 4;
    auto donor = std::make_shared<const TriangleMesh>(generate_rectangle(2.125, 2.125, square));
    auto target = std::make_shared<const TriangleMesh>(generate_disc(1.0, disc));
    for (int level = 0; level < count; ++level) {
      if (level > 0) {
        donor = std::make_shared<const TriangleMesh>(refine_uniform(*donor));
        target = std::make_shared<const TriangleMesh>(refine_uniform(*target));
      }
      out[static_cast<std::size_t>(g - 1)].push_back(measure(donor, target, formulas));
    }
  }
  return out;
}

/// The observed order between two levels; none where rounding decides.
Cell order_cell(double coarse, double fine) {
  if (!(coarse > 1e-12 && fine > 1e-13)) return number_cell(NAN);
  const double order = std::log2(coarse / fine);
  return {fmt::format("{:.2f}", order), order};
}

Cell degree_cell(std::size_t k) {
  return {degree_names[k], k + 1};
}

void add_errors(StudyReport& report, std::size_t f, const Levels& levels) {
  const auto [name, formula] = functions[f];
  StudyTable table;
  table.file = fmt::format("transfer_{}", name);
  table.title = fmt::format("{} = {}: relative L2 error on the target", name, formula);
  table.columns = {{"degree", "degree"},
                   {"level", "level"},
                   {"donor elements", "donor_elements"},
                   {"target elements", "target_elements"},
                   {"physical basis", "error_physical"},
                   {"order", "order_physical"},
                   {"reference basis", "error_reference"},
                   {"order", "order_reference"},
                   {"published", "error_published", true},
                   {"order", "order_published", true}};
  std::vector<Series> series;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    Series physical{fmt::format("{}, physical", degree_names[k]), {}, {}};
    Series reference{fmt::format("{}, reference", degree_names[k]), {}, {}};
    Series theirs{k + 1 == levels.size() ? "published" : "", {}, {}, true};
    physical.colour = degree_colours[k][0];
    reference.colour = degree_colours[k][1];
    theirs.colour = "#777777";
    for (std::size_t i = 0; i < levels[k].size(); ++i) {
      // Without a coarser level, one of error 0 stands in: no order.
      const Level& at = levels[k][i];
      const Level before = i > 0 ? levels[k][i - 1] : Level{};
      const double known = published[f][k][i] > 0.0 ? published[f][k][i] : NAN;
      table.rows.push_back(
          {{degree_cell(k), count_cell(i), count_cell(at.donor_elements),
            count_cell(at.target_elements), number_cell(at.physical[f]),
            order_cell(before.physical[f], at.physical[f]), number_cell(at.reference[f]),
            order_cell(before.reference[f], at.reference[f]), number_cell(known),
            order_cell(i > 0 ? published[f][k][i - 1] : 0.0, known)}});
      const double h = std::sqrt(std::numbers::pi / static_cast<double>(at.target_elements));
      add_point(physical, h, at.physical[f], 1e-17);
      add_point(reference, h, at.reference[f], 1e-17);
      add_point(theirs, h, known, 1e-17);
    }
    for (Series* line : {&physical, &reference, &theirs}) series.push_back(std::move(*line));
  }
  report.add(std::move(table));
  report.add_plot(fmt::format("transfer_{}.svg", name), std::move(series),
                  {.title = fmt::format("Transfer of {} = {}", name, formula),
                   .x_label = "h = sqrt(disc area / target elements)",
                   .y_label = "relative L2 error",
                   .log_x = true,
                   .log_y = true});
}

StudyTable cost_table(const Levels& levels) {
  StudyTable table;
  table.file = "transfer_cost";
  table.title = "Conservation and cost";
  table.remark =
      "Of three fields in both bases. Overlay, integrate, solve: their shares of the time; the CSV "
      "file has seconds.";
  table.columns = {{"degree", "degree"},
                   {"level", "level"},
                   {"pairs", "pairs"},
                   {"largest relative mass defect", "relative_mass_defect"},
                   {"largest partition residual", "max_partition_residual"},
                   {"pairs per second", "pairs_per_second"},
                   {"seconds", "seconds"},
                   {"overlay", "overlay"},
                   {"integrate", "integrate"},
                   {"solve", "solve"}};
  for (std::size_t k = 0; k < levels.size(); ++k)
    for (std::size_t i = 0; i < levels[k].size(); ++i) {
      const Level& at = levels[k][i];
      const TransferReport::Seconds& took = at.seconds;
      const auto share = [&](double seconds) {
        const double all = took.overlay + took.integrate + took.solve;
        return Cell{fmt::format("{:.0f} %", 100.0 * seconds / all), seconds};
      };
      table.rows.push_back(
          {{degree_cell(k), count_cell(i), count_cell(at.pairs), number_cell(at.mass_defect),
            number_cell(at.partition_residual),
            number_cell(2.0 * static_cast<double>(at.pairs) / took.total), number_cell(took.total),
            share(took.overlay), share(took.integrate), share(took.solve)}});
    }
  return table;
}

}  // namespace

int run_study_transfer(const std::string& out_dir, bool quick, bool json) {
  const Levels levels = measure_all(quick ? 3 : most_levels);
  StudyReport report("transfer");
  for (std::size_t f = 0; f < functions.size(); ++f) add_errors(report, f, levels);
  report.add(cost_table(levels));
  report.write(out_dir, json);
  return 0;
}

}  // namespace bezel::cli
