#pragma once
// How a subcommand is added to the command line.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/context.hpp"

namespace bezel::cli {

/// Adds a subcommand whose options live in `Options`; run(options, context) does the work after
/// parsing.
template <class Options>
CLI::App* add_command(CLI::App& app, Context& context, const std::string& name,
                      const std::string& what, const std::string& example,
                      const std::shared_ptr<Options>& options,
                      int (*run)(const Options&, const Context&)) {
  CLI::App* command = app.add_subcommand(name, what);
  command->fallthrough();  // the global options may follow the command
  command->footer("Example:\n  " + example);
  command->callback([&context, options, run] {
    context.run = [&context, options, run] { return run(*options, context); };
  });
  return command;
}

void add_info(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_convert(CLI::App& app, Context& context);
void add_mesh(CLI::App& app, Context& context);
void add_sample(CLI::App& app, Context& context);
void add_transfer(CLI::App& app, Context& context);
void add_error(CLI::App& app, Context& context);
void add_view(CLI::App& app, Context& context);
void add_eval(CLI::App& app, Context& context);
void add_roots(CLI::App& app, Context& context);
void add_intersect(CLI::App& app, Context& context);
void add_curve(CLI::App& app, Context& context);
void add_study(CLI::App& app, Context& context);

}  // namespace bezel::cli
