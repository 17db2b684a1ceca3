// bezel eval: values of Bernstein polynomials with an error bound.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "cli/output.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

struct EvalOptions {
  PolynomialOptions input;
  std::string parameters, precision = "certified";
  bool condition = false, derivative = false, hex = false;
};

struct Derivative {
  double value, bound;
};

/// p'(s) and the bound of evaluate_derivative_compensated: (3 u + O(u^2)) |p'| + m u^K d q~, with
/// q~ of the differences and, for K = 1, one more u for rounding those.
Derivative derivative(const std::vector<double>& b, double s, int K) {
  const double value = bernstein::evaluate_derivative_compensated<double>(b, s, K);
  const std::size_t d = b.size() - 1;
  if (d == 0) return {value, 0.0};
  std::vector<double> differences(d);
  for (std::size_t j = 0; j < d; ++j) differences[j] = b[j + 1] - b[j];
  const double factor = bernstein::error_multiplier(static_cast<int>(d) - 1, K);
  const double absolute = static_cast<double>(d) * bernstein::absolute_value_sum(differences, s);
  const double rest = (std::ldexp(factor, -53 * K) + (K == 1 ? 0x1p-53 : 0.0)) * absolute;
  // |p'| <= (|value| + rest) / (1 - 3 u); 2^-40 covers terms of higher order and this rounding.
  return {value, (3 * 0x1p-53 * (std::fabs(value) + rest) + rest) * (1.0 + 0x1p-40)};
}

struct Values {
  std::vector<double> value, bound, condition, derivative, derivative_bound;
  std::vector<int> level;  // 0: exact
};

Values evaluate(const Polynomial& p, const EvalOptions& options) {
  Values out;
  const std::size_t n = p.s.size();
  out.value.resize(n);
  out.bound.resize(n);
  if (options.precision == "certified") {
    std::vector<bernstein::Certificate> certificate(n);
    bernstein::evaluate_certified(p.b, p.s, out.value, out.bound, certificate);
    for (const bernstein::Certificate c : certificate)
      out.level.push_back(c == bernstein::Certificate::exact ? 0 : static_cast<int>(c));
  } else {
    const int K = options.precision[0] - '0';
    bernstein::evaluate_compensated(p.b, p.s, out.value, K);
    for (std::size_t q = 0; q < n; ++q)
      out.bound[q] = bernstein::compensated_error_bound(p.b, p.s[q], K);
    out.level.assign(n, K);
    for (std::size_t q = 0; options.derivative && q < n; ++q) {
      const Derivative prime = derivative(p.b, p.s[q], K);
      out.derivative.push_back(prime.value);
      out.derivative_bound.push_back(prime.bound);
    }
  }
  for (std::size_t q = 0; options.condition && q < n; ++q)
    out.condition.push_back(bernstein::condition_number(p.b, p.s[q]));
  return out;
}

Json level_json(const std::vector<int>& levels) {
  Json out = Json::array();
  for (const int level : levels) out.push_back(level == 0 ? Json("exact") : Json(level));
  return out;
}

Json to_json(const Values& values, const EvalOptions& options) {
  Json out{{"values", numbers_json(values.value, options.hex)},
           {"bounds", numbers_json(values.bound, options.hex)},
           {"levels", level_json(values.level)}};
  if (options.condition) out["conditions"] = numbers_json(values.condition, options.hex);
  if (options.derivative) {
    out["derivatives"] = numbers_json(values.derivative, options.hex);
    out["derivative_bounds"] = numbers_json(values.derivative_bound, options.hex);
  }
  return out;
}

std::string to_table(const Polynomial& p, const Values& values, const EvalOptions& options) {
  const bool certified = options.precision == "certified";
  std::vector<std::string> header = {"s", "value", certified ? "certified bound" : "a-priori bound",
                                     "precision"};
  if (options.condition) header.emplace_back("condition");
  if (options.derivative) header.insert(header.end(), {"derivative", "its a-priori bound"});
  std::vector<std::vector<std::string>> rows;
  for (std::size_t q = 0; q < p.s.size(); ++q) {
    const auto text = [&](double x) { return exact_text(x, options.hex); };
    rows.push_back({text(p.s[q]), text(values.value[q]), text(values.bound[q]),
                    values.level[q] == 0 ? "exact" : std::to_string(values.level[q])});
    if (options.condition) rows.back().push_back(text(values.condition[q]));
    if (options.derivative) {
      rows.back().push_back(text(values.derivative[q]));
      rows.back().push_back(text(values.derivative_bound[q]));
    }
  }
  return aligned(header, rows);
}

int run(const EvalOptions& options, const Context& context) {
  if (options.derivative && options.precision == "certified")
    throw UsageError("--derivative: needs --precision 1 to 4");
  const Polynomials input = read_input(options.input, &options.parameters, context);
  std::string text;
  Json results = Json::array();
  for (std::size_t i = 0; i < input.items.size(); ++i) {
    const Values values = evaluate(input.items[i], options);
    if (context.json) {
      results.push_back(to_json(values, options));
    } else {
      text += heading(input, i) + to_table(input.items[i], values, options);
    }
  }
  if (context.json) text = results_text("bezel/eval/1", input.list, results);
  print(text);
  return ok;
}

}  // namespace

void add_eval(CLI::App& app, Context& context) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* command =
      add_command(app, context, "eval", "Evaluate Bernstein polynomials, with an error bound",
                  "bezel eval --b 1,-0.75,0.5,-0.25,0 --s 0.5,0x1.00000000003e9p-1", options, run);
  add_polynomial_options(*command, options->input);
  command->add_option("--s", options->parameters, "Parameters, separated by commas")
      ->type_name("S,...");
  command
      ->add_option("--precision", options->precision,
                   "Working precision times 1, 2, 3 or 4 with an a-priori bound, or certified: "
                   "faithful with a proven bound")
      ->check(CLI::IsMember({"1", "2", "3", "4", "certified"}))
      ->type_name("K")
      ->capture_default_str();
  command->add_flag("--condition", options->condition, "Also the condition number at each s");
  command->add_flag("--derivative", options->derivative,
                    "Also the derivative (precision 1 to 4) and its bound");
  command->add_flag("--hex", options->hex, "Print hex floats");
}

}  // namespace bezel::cli
