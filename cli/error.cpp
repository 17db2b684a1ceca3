// bezel error: how far a field is from a formula.

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "cli/arguments.hpp"
#include "cli/output.hpp"

namespace bezel::cli {
namespace {

struct ErrorOptions {
  std::string file, field, exact;
};

int run(const ErrorOptions& options, const Context& context) {
  const std::vector<Formula> exact = parse_components("--exact", options.exact);
  const Dataset data = read_noting(context, options.file);
  ErrorNorms norms{};
  std::string name;
  try {
    const Field& field = data.field(options.field);
    name = field.name();
    if (static_cast<std::size_t>(field.components()) != exact.size()) {
      throw InputError("field '" + name + "' has " +
                       counted(static_cast<std::size_t>(field.components()), "component") +
                       ", found " + counted(exact.size(), "formula") + " in --exact");
    }
    norms = error_norms(field, exact, 8, context.threads);
  } catch (const InputError& error) {
    throw error.in_file(options.file);
  }
  if (context.json) {
    print_json(Json{{"schema", "bezel/error/1"},
                    {"file", options.file},
                    {"field", name},
                    {"exact", options.exact},
                    {"l2", norms.l2},
                    {"l2_relative", norms.l2_relative},
                    {"max", norms.max},
                    {"h1_semi", norms.h1_semi},
                    {"integral", norms.integral}});
  } else {
    print(
        fmt::format("l2           {:.6e}\nl2_relative  {:.6e}\nmax          {:.6e}\nh1_semi      "
                    "{:.6e}\nintegral     {:.6e}\n",
                    norms.l2, norms.l2_relative, norms.max, norms.h1_semi, norms.integral));
  }
  return ok;
}

}  // namespace

void add_error(CLI::App& app, Context& context) {
  auto options = std::make_shared<ErrorOptions>();
  CLI::App* command =
      add_command(app, context, "error", "Measure how far a field is from a formula",
                  "bezel error moved.vtu -f u --exact 'exp(x^2)+2*y'", options, run);
  command->add_option("FILE", options->file, "File with the field")->required();
  command->add_option("-f,--field", options->field, "The field (default: the only one)")
      ->type_name("NAME");
  command->add_option("--exact", options->exact, "Formula of x and y; components separated by ';'")
      ->required()
      ->type_name("EXPR");
}

}  // namespace bezel::cli
