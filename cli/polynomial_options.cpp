#include "cli/polynomial_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "cli/json_text.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {

void add_polynomial_options(CLI::App& command, PolynomialOptions& options) {
  command.add_option("FILE", options.file, "JSON file; '-': the standard input");
  command
      .add_option("--b", options.coefficients,
                  "Coefficients instead of a file, separated by commas")
      ->type_name("B,...");
}

Polynomials read_input(const PolynomialOptions& options, const std::string* parameters,
                       const Context& context) {
  if (options.file.empty() == options.coefficients.empty())
    throw UsageError(options.file.empty() ? "FILE or --b is required"
                                          : "FILE and --b exclude each other");
  Polynomials input;
  std::string name = options.file;
  if (options.file.empty()) {
    name = "--b";
    if (parameters && parameters->empty()) throw UsageError("--b needs --s");
    Polynomial p;
    p.b = parse_number_list("--b", options.coefficients, input.rounded);
    if (parameters) p.s = parse_number_list("--s", *parameters, input.rounded);
    const std::size_t most = bernstein::max_interval_degree + 1;
    if (p.b.size() > most)
      throw InputError(
          fmt::format("--b: found {} coefficients, expected 1 to {}", p.b.size(), most));
    input.items.push_back(std::move(p));
    input.name = name;
  } else {
    if (parameters && !parameters->empty()) throw UsageError("--s needs --b");
    const InputText read = read_input_text(options.file);
    name = read.name;
    input = read_polynomials(name, read.text, parameters != nullptr);
  }
  if (input.rounded > 0)
    note(context, fmt::format("{}: {} rounded to the nearest double", name,
                              counted(input.rounded, "rational number")));
  return input;
}

Json number_json(double value, bool hex) {
  if (!std::isfinite(value)) return {};
  return hex ? Json(exact_text(value, true)) : Json(value);
}

Json numbers_json(const std::vector<double>& values, bool hex) {
  Json out = Json::array();
  for (const double value : values) out.push_back(number_json(value, hex));
  return out;
}

std::string heading(const Polynomials& input, std::size_t i) {
  if (!input.list) return {};
  return fmt::format("{}polynomial {}\n", i > 0 ? "\n" : "", i);
}

std::string results_text(const std::string& schema, bool list, const Json& results) {
  Json object{{"schema", schema}};
  if (list) {
    object["results"] = results;
  } else {
    object.update(results[0]);
  }
  return to_text(object);
}

}  // namespace bezel::cli
