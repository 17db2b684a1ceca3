// bezel roots: all roots of Bernstein polynomials in [0, 1], or Newton's method for one.

#include "bezel/bernstein/roots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/newton.hpp"
#include "cli/output.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

struct RootsOptions {
  PolynomialOptions input;
  std::string form;
  std::optional<double> start, tolerance;
  std::optional<int> max_iterations;
  bool hex = false;
};

bool resolved(const bernstein::Root& root) {
  return root.min_multiplicity == root.max_multiplicity;
}
/// Whether it is proven that there is one root in the box, of the multiplicity given.
bool certified(const bernstein::Root& root) {
  return !root.multiple || (resolved(root) && root.lo == root.hi);
}

Json root_json(const bernstein::Root& root, bool hex) {
  const Json multiplicity = resolved(root) ? Json(root.min_multiplicity)
                                           : Json{root.min_multiplicity, root.max_multiplicity};
  Json out{{"s", number_json(root.s, hex)},
           {"box", numbers_json({root.lo, root.hi}, hex)},
           {"multiplicity", multiplicity}};
  if (resolved(root)) {
    out["condition"] = number_json(root.condition, hex);
    out["certified"] = certified(root);
  }
  return out;
}

Json roots_json(const std::vector<bernstein::Root>& roots, bool hex) {
  Json out{{"roots", Json::array()}, {"unresolved", Json::array()}};
  for (const bernstein::Root& root : roots)
    out[resolved(root) ? "roots" : "unresolved"].push_back(root_json(root, hex));
  return out;
}

std::string roots_table(const std::vector<bernstein::Root>& roots, bool hex) {
  if (roots.empty()) return "no roots in [0, 1]\n";
  std::vector<std::vector<std::string>> rows;
  for (const bernstein::Root& root : roots) {
    rows.push_back(
        {exact_text(root.s, hex),
         fmt::format("[{}, {}]", exact_text(root.lo, hex), exact_text(root.hi, hex)),
         resolved(root) ? std::to_string(root.min_multiplicity)
                        : fmt::format("{} to {}", root.min_multiplicity, root.max_multiplicity),
         std::isinf(root.condition) ? std::string("inf") : fmt::format("{:.3g}", root.condition),
         !resolved(root)   ? "unresolved"
         : certified(root) ? "yes"
                           : "box"});
  }
  return aligned({"s", "box", "multiplicity", "condition", "certified"}, rows);
}

const std::vector<std::pair<std::string, bernstein::NewtonForm>>& forms() {
  static const std::vector<std::pair<std::string, bernstein::NewtonForm>> all = {
      {"basic", bernstein::NewtonForm::basic},
      {"accurate", bernstein::NewtonForm::accurate},
      {"full", bernstein::NewtonForm::full},
      {"triple", bernstein::NewtonForm::triple}};
  return all;
}

std::string stop_name(bernstein::NewtonStop stop) {
  switch (stop) {
    case bernstein::NewtonStop::small_step:
      return "small_step";
    case bernstein::NewtonStop::zero_residual:
      return "zero_residual";
    case bernstein::NewtonStop::max_iterations:
      return "max_iterations";
    case bernstein::NewtonStop::zero_derivative:
      return "zero_derivative";
    case bernstein::NewtonStop::not_finite:
      return "not_finite";
  }
  return {};
}

bernstein::NewtonRoot newton(const std::vector<double>& b, const RootsOptions& options) {
  bernstein::NewtonForm form{};
  for (const auto& [name, value] : forms())
    if (name == options.form) form = value;
  bernstein::NewtonOptions how;
  if (options.tolerance) how.param_tol = *options.tolerance;
  if (options.max_iterations) how.max_iterations = *options.max_iterations;
  return bernstein::newton_root(b, *options.start, form, how);
}

Json newton_json(const bernstein::NewtonRoot& root, const RootsOptions& options) {
  return {{"newton",
           {{"form", options.form},
            {"s", number_json(root.s, options.hex)},
            {"iterations", root.iterations},
            {"stop", stop_name(root.stop)},
            {"condition", number_json(root.condition, options.hex)},
            {"history", numbers_json(root.history, options.hex)}}}};
}

std::string newton_table(const bernstein::NewtonRoot& root, bool hex) {
  return aligned({"s", "iterations", "stop", "condition"},
                 {{exact_text(root.s, hex), std::to_string(root.iterations), stop_name(root.stop),
                   fmt::format("{:.3g}", root.condition)}});
}

int run(const RootsOptions& options, const Context& context) {
  if (!options.form.empty() && !options.start) throw UsageError("--newton needs --start");
  for (const auto& [name, given] : {std::pair{"--start", options.start.has_value()},
                                    {"--tolerance", options.tolerance.has_value()},
                                    {"--max-iterations", options.max_iterations.has_value()}})
    if (given && options.form.empty()) throw UsageError(fmt::format("{} needs --newton", name));
  if (options.start && !std::isfinite(*options.start))
    throw UsageError("--start: expected a finite number");
  const Polynomials input = read_input(options.input, nullptr, context);
  std::string text;
  Json results = Json::array();
  for (std::size_t i = 0; i < input.items.size(); ++i) {
    const std::vector<double>& b = input.items[i].b;
    try {
      if (!options.form.empty()) {
        const bernstein::NewtonRoot root = newton(b, options);
        results.push_back(newton_json(root, options));
        text += heading(input, i) + newton_table(root, options.hex);
      } else {
        const std::vector<bernstein::Root> found = bernstein::roots(b);
        results.push_back(roots_json(found, options.hex));
        text += heading(input, i) + roots_table(found, options.hex);
      }
    } catch (const InputError& error) {
      const std::string element = input.list ? fmt::format("object {}", i) : std::string();
      throw InputError(InputPlace{input.name, 0, element, -1}, error.message());
    }
  }
  print(context.json ? results_text("bezel/roots/1", input.list, results) : text);
  return ok;
}

}  // namespace

void add_roots(CLI::App& app, Context& context) {
  auto options = std::make_shared<RootsOptions>();
  CLI::App* command =
      add_command(app, context, "roots", "Find the roots of Bernstein polynomials in [0, 1]",
                  "bezel roots --b 3,-5,7,-9", options, run);
  add_polynomial_options(*command, options->input);
  std::vector<std::string> words;
  for (const auto& form : forms()) words.push_back(form.first);
  command
      ->add_option("--newton", options->form,
                   "Newton's method from --start instead, with plain values (basic), p (accurate) "
                   "or p and p' (full) in twice, or both in three times the precision (triple)")
      ->check(CLI::IsMember(words))
      ->type_name("FORM");
  command->add_option("--start", options->start, "First iterate")->type_name("S");
  command->add_option("--tolerance", options->tolerance, "Steps below it end the iteration; 1e-15")
      ->check(CLI::NonNegativeNumber)
      ->type_name("T");
  command->add_option("--max-iterations", options->max_iterations, "At most so many steps; 100")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command->add_flag("--hex", options->hex, "Print hex floats");
}

}  // namespace bezel::cli
