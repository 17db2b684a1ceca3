// Newton's method with compensated values [hermes2018, ch. 6], whose experiments the paper leaves
// open: roots of growing condition number, tangent and almost tangent intersections.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/newton.hpp"
#include "bezel/geometry/newton_intersection.hpp"
#include "bezel/numeric/binomial.hpp"
#include "cli/exact_study.hpp"
#include "cli/horner.hpp"
#include "cli/study.hpp"
#include "cli/study_report.hpp"

namespace bezel::cli {
namespace {

using bernstein::NewtonForm;
using bernstein::NewtonStop;

constexpr double u = 0x1p-53;

/// The zero of an increasing function in [lo, hi], within 2^-bits of hi - lo.
Dyadic bisect(Dyadic lo, Dyadic hi, int bits, const std::function<int(const Dyadic&)>& sign) {
  for (int i = 0; i < bits; ++i) {
    const Dyadic middle = (lo + hi).scaled(-1);
    (sign(middle) > 0 ? hi : lo) = middle;
  }
  return (lo + hi).scaled(-1);
}

Dyadic power(const Dyadic& x, int n) {
  Dyadic out(1.0);
  for (int i = 0; i < n; ++i) out *= x;
  return out;
}

std::string stop_name(NewtonStop stop) {
  return stop == NewtonStop::small_step        ? "step"
         : stop == NewtonStop::zero_residual   ? "zero"
         : stop == NewtonStop::max_iterations  ? "most"
         : stop == NewtonStop::zero_derivative ? "p' = 0"
                                               : "not finite";
}

Cell iterations_cell(int iterations, NewtonStop stop) {
  const std::string name = stop_name(stop);
  return {fmt::format("{}, {}", iterations, name),
          Json{{"iterations", iterations}, {"stop", name}}};
}

/// What one form reached for one problem.
struct Reached {
  double error;
  int iterations;
  NewtonStop stop;
};

/// All of a comparison: problems of growing condition number, solved in several forms.
struct Family {
  std::vector<std::string> names;  // of the forms, and of their keys
  std::vector<std::string> keys;
  std::vector<double> parameter, condition;
  std::vector<std::vector<Reached>> reached;  // [form][problem]
};

/// Errors against condition numbers, with guides at u and at kappa u^m for m = 1 to `powers`.
std::vector<Series> error_series(const Family& family, int powers) {
  const auto [low, high] = std::minmax_element(family.condition.begin(), family.condition.end());
  std::vector<Series> series;
  for (std::size_t f = 0; f < family.names.size(); ++f) {
    Series points{family.names[f], family.condition, {}, false, true};
    for (const Reached& r : family.reached[f]) points.y.push_back(std::clamp(r.error, 1e-17, 1.0));
    series.push_back(std::move(points));
  }
  Series level{"u", {*low, *high}, {u, u}, true};
  level.colour = "#999999";
  series.push_back(std::move(level));
  for (int m = 1; m <= powers; ++m) {
    const double slope = std::pow(u, m);  // from where it reaches u to where it reaches 1
    const double from = std::max(*low, u / slope), to = std::min(*high, 1.0 / slope);
    if (from >= to) continue;
    Series line{m == 1 ? std::string("kappa u^m") : std::string(),
                {from, to},
                {from * slope, to * slope},
                true};
    line.colour = "#555555";
    series.push_back(std::move(line));
  }
  return series;
}

PlotOptions error_plot(const std::string& title) {
  return {.title = title,
          .x_label = "condition number kappa",
          .y_label = "relative error (drawn within 1e-17 and 1)",
          .log_x = true,
          .log_y = true};
}

/// Rows: parameter, kappa, for each form iterations and error; expected kappa u and u + kappa u^2.
StudyTable error_table(const Family& family, const StudyColumn& parameter, std::size_t every) {
  StudyTable table;
  table.columns = {parameter, {"kappa", "kappa"}};
  for (std::size_t f = 0; f < family.names.size(); ++f) {
    table.columns.push_back({family.names[f] + ": error", family.keys[f] + "_error"});
    table.columns.push_back({"steps, stop", family.keys[f] + "_stop"});
  }
  table.columns.push_back({"kappa u", "kappa_u", true});
  table.columns.push_back({"u + kappa u^2", "u_plus_kappa_u2", true});
  const std::size_t n = family.condition.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double kappa = family.condition[i];
    StudyRow row{{count_cell(static_cast<int>(family.parameter[i])), number_cell(kappa)},
                 i % every == 0 || i + 1 == n};
    for (const auto& form : family.reached) {
      row.cells.push_back(number_cell(form[i].error));
      row.cells.push_back(iterations_cell(form[i].iterations, form[i].stop));
    }
    row.cells.push_back(number_cell(kappa * u));
    row.cells.push_back(number_cell(u + kappa * u * u));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What is to be expected of a form: an error of about u + kappa u^m while kappa is below a limit.
struct Rule {
  std::string text;
  int m;
  double limit;
  std::string limit_text;
};

StudyTable rules_table(const Family& family, const std::vector<Rule>& rules) {
  StudyTable table;
  table.columns = {{"form", "form"},
                   {"error like", "rule", true},
                   {"while kappa is below", "limit", true},
                   {"problems there", "problems"},
                   {"largest error there", "largest_error"},
                   {"largest error / (u + kappa u^m)", "largest_ratio"},
                   {"error <= 4 u up to kappa", "full_up_to"}};
  for (std::size_t f = 0; f < rules.size(); ++f) {
    const Rule& rule = rules[f];
    std::size_t count = 0;
    double worst = 0.0, ratio = 0.0, full = 0.0;
    bool still = true;
    for (std::size_t i = 0; i < family.condition.size(); ++i) {
      const double kappa = family.condition[i], error = family.reached[f][i].error;
      still = still && error <= 4 * u;
      if (still) full = kappa;
      if (kappa >= rule.limit) continue;
      ++count;
      worst = std::max(worst, error);
      ratio = std::max(ratio, error / (u + kappa * std::pow(u, double(rule.m))));
    }
    table.rows.push_back({{text_cell(family.names[f]),
                           text_cell(rule.text),
                           {rule.limit_text, rule.limit},
                           count_cell(count),
                           number_cell(worst),
                           number_cell(ratio),
                           full > 0.0 ? number_cell(full) : number_cell(NAN)}});
  }
  return table;
}

// --- Figure 6.1

Family horner_family() {
  Family family;
  family.names = {"basic", "accurate", "full"};
  family.keys = {"basic", "accurate", "full"};
  family.reached.resize(3);
  for (int n = 2; n <= max_exact_binomial; ++n) {
    // (s-1)^n - 2^-31: binomials below 2^53, all coefficients exact.
    std::vector<double> a;
    for (int i = 0; i <= n; ++i) a.push_back(((n - i) % 2 == 0 ? 1.0 : -1.0) * binomial(n, i));
    a[0] -= 0x1p-31;
    const Dyadic beta = bisect(Dyadic(0.0), Dyadic(1.0), 160, [&](const Dyadic& x) {
      return (power(x, n) - Dyadic(0x1p-31)).sign();
    });
    const Dyadic alpha = Dyadic(1.0) + beta;
    Dyadic absolute;  // sum |a_i| alpha^i
    for (int i = n; i >= 0; --i)
      absolute = absolute * alpha + Dyadic(std::fabs(a[static_cast<std::size_t>(i)]));
    const double slope = n * power(beta, n - 1).to_double();
    family.parameter.push_back(n);
    family.condition.push_back(absolute.to_double() / (alpha.to_double() * slope));
    for (std::size_t f = 0; f < 3; ++f) {
      const HornerNewton found = newton_horner(a, 2.0, static_cast<int>(f), 1e-15, 100);
      family.reached[f].push_back({relative_error(found.s, alpha), found.iterations, found.stop});
    }
  }
  return family;
}

void figure_6_1(StudyReport& report) {
  const Family family = horner_family();
  StudyTable table = error_table(family, {"n", "n"}, 6);
  table.file = "figure_6_1";
  table.title = "Figure 6.1: the root 1 + 2^(-31/n) of (s-1)^n - 2^-31 in the monomial basis";
  table.remark =
      "Newton's method with Horner's scheme from s = 2: plain values (basic), p (accurate) or p "
      "and "
      "p' (full) compensated. n ends where binomials stop being doubles. Steps end when one is "
      "below 1e-15 (step) or after 100 (most).";
  report.add(std::move(table));
  report.add_plot("figure_6_1.svg", error_series(family, 2),
                  error_plot("Figure 6.1: roots of (s-1)^n - 2^-31 with Horner's scheme"));
  StudyTable rules = rules_table(family, {{"kappa u", 1, 1 / u, "1/u"},
                                          {"u", 2, 1 / u, "1/u"},
                                          {"u + kappa u^2", 2, 1 / (u * u), "1/u^2"}});
  rules.file = "figure_6_1_rules";
  rules.title = "Figure 6.1: rules of thumb";
  rules.remark =
      "Expected: basic follows kappa u (m = 1); accurate stays at u until kappa = 1/u; full "
      "follows "
      "u + kappa u^2 (m = 2).";
  report.add(std::move(rules));
}

// --- Roots in the Bernstein basis

Family bernstein_family() {
  Family family;
  family.names = {"basic", "accurate", "full", "K = 3"};
  family.keys = {"basic", "accurate", "full", "triple"};
  family.reached.resize(4);
  const std::array<NewtonForm, 4> forms = {NewtonForm::basic, NewtonForm::accurate,
                                           NewtonForm::full, NewtonForm::triple};
  for (int n = 1; n < bernstein::max_interval_degree; n += 2) {
    std::vector<double> b;
    for (int j = 0; j <= n; ++j)
      b.push_back((j % 2 == 0 ? 1.0 : -1.0) * (std::ldexp(1.0, 2 * j) + std::ldexp(1.0, 30 + j)));
    const bernstein::ExactPolynomial p(b);
    const Dyadic alpha = bisect(Dyadic(0.1875), Dyadic(0.375), 160,
                                [&](const Dyadic& s) { return -p.sign(s); });  // p decreases
    for (double& x : b) x = std::fabs(x);
    const Dyadic absolute = bernstein::ExactPolynomial(b)(alpha);
    for (std::size_t j = 1; j < b.size(); j += 2) b[j] = -b[j];
    family.parameter.push_back(n);
    family.condition.push_back(absolute.to_double() /
                               magnitude(alpha * p.derivative()(alpha)).to_double());
    for (std::size_t f = 0; f < forms.size(); ++f) {
      const bernstein::NewtonRoot found = bernstein::newton_root(b, 0.5, forms[f]);
      family.reached[f].push_back({relative_error(found.s, alpha), found.iterations, found.stop});
    }
  }
  return family;
}

void bernstein_roots(StudyReport& report) {
  const Family family = bernstein_family();
  StudyTable table = error_table(family, {"n", "n"}, 3);
  table.file = "roots";
  table.title = "Section 6.3: the root of (1-5s)^n + 2^30 (1-3s)^n in the Bernstein basis, n odd";
  table.remark =
      "Newton's method from s = 1/2, steps below 1e-15 or 100 of them. Errors against the exact "
      "root "
      "(bisection in exact arithmetic), kappa = p~ / (alpha |p'|) at it.";
  report.add(std::move(table));
  report.add_plot("newton_roots.svg", error_series(family, 3),
                  error_plot("Section 6.3: roots of (1-5s)^n + 2^30 (1-3s)^n"));
  StudyTable rules = rules_table(family, {{"kappa u", 1, 1 / u, "1/u"},
                                          {"u", 2, 1 / u, "1/u"},
                                          {"u + kappa u^2", 2, 1 / (u * u), "1/u^2"},
                                          {"u", 3, 1 / (u * u), "1/u^2"}});
  rules.file = "roots_rules";
  rules.title = "Section 6.3: rules of thumb for roots";
  rules.remark =
      "Expected: basic follows kappa u; accurate stays at u until kappa = 1/u, then it collapses; "
      "full follows kappa u^2 up to 1/u^2; K = 3 stays at u up to 1/u^2.";
  report.add(std::move(rules));
}

// --- Intersections

struct Pair {
  std::vector<Vec2> a, b;
};

/// Degree 2: a = (2 (4s^2-1) - r, (2s-1)^2 + 1 + q), b = (4 (4t^2-1), 4 (2t-1)^2 + 1 + q), tangent
/// at (1/2, 1/2) for r = 0.
Pair parabolas(double r, double q) {
  return {{{-2 - r, 2 + q}, {-2 - r, 0 + q}, {6 - r, 2 + q}},
          {{-4, 5 + q}, {-4, -3 + q}, {12, 5 + q}}};
}

const std::array<std::pair<const char*, ResidualForm>, 3> residuals = {
    {{"plain", ResidualForm::plain},
     {"compensated", ResidualForm::compensated},
     {"rounded", ResidualForm::rounded_values}}};

void tangent(StudyReport& report) {
  const Pair pair = parabolas(0.0, 0.0);
  StudyTable table;
  table.file = "tangent";
  table.title = "Section 6.3: the tangent intersection at (1/2, 1/2)";
  table.remark =
      "Distance of each iterate of Newton's method, started at (1 - 2^-40, 3/4 + 2^-20). With m = "
      "2s "
      "- 1 and k = 2t - 1 the curves meet where m = 2k or m = -2k, three times at this point. "
      "Close to "
      "it, with w = m - 2k = g k^2, a step maps g to g (2 - g) / (g - 1)^2 and k to k (g - 1) / (g "
      "- "
      "2): the start is close to g = 0, where the distance halves, but only g = (1 - sqrt 5) / 2 "
      "lasts, with the factor 0.618. Expected: down to the cube root of the residual's error, "
      "u^(1/3) "
      "= 5e-6 for plain and rounded values, u^(2/3) = 2e-11 for compensated ones, times constants. "
      "Every fourth step; the CSV file has all.";
  table.columns = {{"step", "step"}};
  std::vector<std::vector<double>> distance;
  std::vector<Series> series;
  std::size_t steps = 0;
  for (const auto& [name, form] : residuals) {
    const NewtonIntersection found =
        newton_intersection(pair.a, pair.b, 1 - 0x1p-40, 0.75 + 0x1p-20, form);
    table.columns.push_back({name, name});
    distance.emplace_back();
    Series line{name, {}, {}, false, true};
    for (const IntersectionIterate& at : found.history) {
      distance.back().push_back(std::hypot(at.s - 0.5, at.t - 0.5));
      add_point(line, static_cast<double>(line.x.size()), distance.back().back(), 1e-17);
    }
    steps = std::max(steps, found.history.size());
    series.push_back(std::move(line));
  }
  table.columns.push_back({"factor per step, compensated", "factor"});
  table.columns.push_back({"first", "factor_first", true});
  table.columns.push_back({"last", "factor_last", true});
  const double golden = (std::sqrt(5.0) - 1) / 2;
  const std::vector<double>& best = distance[1];
  Series halving{"1/2 per step", {}, {}, true}, lasting{"0.618 per step", {}, {}, true};
  halving.colour = "#999999";
  lasting.colour = "#555555";
  for (std::size_t i = 0; i < steps; ++i) {
    const auto step = static_cast<double>(i);
    if (i <= 34) {
      halving.x.push_back(step);
      halving.y.push_back(best[0] * std::pow(0.5, step));
    }
    if (i >= 16 && best.size() > 16) {
      lasting.x.push_back(step);
      lasting.y.push_back(best[16] * std::pow(golden, step - 16));
    }
    StudyRow row{{count_cell(i)}, i % 4 == 0 || i + 1 == steps};
    for (const auto& d : distance) row.cells.push_back(number_cell(i < d.size() ? d[i] : NAN));
    const double factor = i > 0 && i < best.size() ? best[i] / best[i - 1] : NAN;
    row.cells.push_back(std::isfinite(factor) ? Cell{fmt::format("{:.3f}", factor), factor}
                                              : number_cell(NAN));
    row.cells.push_back({"0.5", 0.5});
    row.cells.push_back({fmt::format("{:.3f}", golden), golden});
    table.rows.push_back(std::move(row));
  }
  series.push_back(std::move(halving));
  series.push_back(std::move(lasting));
  report.add(std::move(table));
  const PlotOptions options{.title = "Section 6.3: Newton's method at a tangent intersection",
                            .x_label = "step",
                            .y_label = "distance from the intersection",
                            .log_y = true};
  report.add_plot("tangent.svg", std::move(series), options);
}

void almost_tangent(StudyReport& report) {
  Family family;
  family.reached.resize(residuals.size());
  for (const auto& [name, form] : residuals) {
    family.names.emplace_back(name);
    family.keys.emplace_back(name);
  }
  const Dyadic half_root = bisect(Dyadic(0.5), Dyadic(1.0), 200, [](const Dyadic& x) {
    return (x * x - Dyadic(0.5)).sign();
  });  // sqrt(1/2)
  std::size_t exact = 0, even = 0;
  for (int n = 2; n <= 50; ++n) {
    const Pair pair = parabolas(std::ldexp(1.0, -n), std::ldexp(1.0, n));
    const Dyadic root = (n % 2 == 0 ? Dyadic(1.0) : half_root).scaled(-(n / 2));  // sqrt r
    const Dyadic alpha = (Dyadic(1.0) + root).scaled(-1), beta = (Dyadic(2.0) + root).scaled(-2);
    family.parameter.push_back(n);
    family.condition.push_back(
        intersection_condition(pair.a, pair.b, alpha.to_double(), beta.to_double()));
    const double size = std::hypot(alpha.to_double(), beta.to_double());
    for (std::size_t f = 0; f < residuals.size(); ++f) {
      const NewtonIntersection found =
          newton_intersection(pair.a, pair.b, 1.0, 1.0, residuals[f].second);
      const double error =
          std::hypot((Dyadic(found.s) - alpha).to_double(), (Dyadic(found.t) - beta).to_double()) /
          size;
      family.reached[f].push_back({error, found.iterations, found.stop});
      if (residuals[f].second == ResidualForm::compensated && n % 2 == 0) {
        ++even;
        if (error == 0.0) ++exact;
      }
    }
  }
  StudyTable table = error_table(family, {"n", "n"}, 6);
  table.file = "almost_tangent";
  table.title = "Section 6.3: almost tangent intersections, moved by r = 2^-n and 1/r, n = 2 to 50";
  table.remark = fmt::format(
      "Errors against the exact intersection ((1 + sqrt r)/2, (2 + sqrt r)/4), whose coordinates "
      "are "
      "doubles for even n: expected exact with compensated residuals, found exact {} of {} times. "
      "Steps end when one is below 1e-15 (step), the residual is 0 (zero) or after 50 (most).",
      exact, even);
  report.add(std::move(table));
  report.add_plot("almost_tangent.svg", error_series(family, 2),
                  error_plot("Section 6.3: almost tangent intersections"));
  StudyTable rules = rules_table(family, {{"kappa u", 1, 1 / u, "1/u"},
                                          {"u + kappa u^2", 2, 1 / (u * u), "1/u^2"},
                                          {"kappa u", 1, 1 / u, "1/u"}});
  rules.file = "almost_tangent_rules";
  rules.title = "Section 6.3: rules of thumb for intersections";
  rules.remark =
      "Expected: plain residuals follow kappa u, and so do compensated values rounded before the "
      "subtraction; compensated residuals follow u + kappa u^2.";
  report.add(std::move(rules));
}

// --- Section 6.4

void false_start(StudyReport& report) {
  StudyTable table;
  table.file = "false_start";
  table.title = "Section 6.4: a false start, [(1-s) - 2^t s]^n";
  table.remark =
      "At 2^-20 above the n-fold root 1 / (1 + 2^t). Coefficients (-2^t)^j make all "
      "entries of de Casteljau's algorithm multiples of each other by powers of two, so that only "
      "the rounding of 1 - s counts, n times: errors of about n u cond^(1/n) instead of n u cond. "
      "Never a stress test.";
  table.columns = {{"t", "t"},
                   {"n", "n"},
                   {"cond(p, s)", "condition"},
                   {"de Casteljau: error", "error"},
                   {"n u cond^(1/n)", "n_u_root_condition", true},
                   {"bound 3 n u cond", "bound", true}};
  for (const int t : {1, 2, 3}) {
    for (const int n : {3, 5, 10, 20, 40}) {
      std::vector<double> b;
      for (int j = 0; j <= n; ++j) b.push_back((j % 2 == 0 ? 1.0 : -1.0) * std::ldexp(1.0, t * j));
      const double s = 1.0 / (1.0 + std::ldexp(1.0, t)) + 0x1p-20;
      const ExactValues exact(b);
      const Dyadic p = exact.value(s);
      const double condition = exact.condition(s);
      const double computed = bernstein::evaluate_compensated<double>(b, s, 1);
      table.rows.push_back({{count_cell(t), count_cell(n), number_cell(condition),
                             number_cell(relative_error(computed, p)),
                             number_cell(n * u * std::pow(condition, 1.0 / n)),
                             number_cell(3 * n * u * condition)}});
    }
  }
  report.add(std::move(table));
}

}  // namespace

int run_study_newton(const std::string& out_dir, bool json) {
  StudyReport report("newton");
  figure_6_1(report);
  bernstein_roots(report);
  tangent(report);
  almost_tangent(report);
  false_start(report);
  report.write(out_dir, json);
  return 0;
}

}  // namespace bezel::cli
