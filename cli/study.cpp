// bezel study: repeats published experiments.

#include "cli/study.hpp"

#include "cli/command.hpp"

namespace bezel::cli {
namespace {

struct StudyOptions {
  std::string name, out;
  bool quick = false;
};

int run(const StudyOptions& options, const Context& context) {
  if (options.name == "compensated") return run_study_compensated(options.out, context.json);
  if (options.name == "newton") return run_study_newton(options.out, context.json);
  if (options.name == "curves") return run_study_curves(options.out, options.quick, context.json);
  return run_study_transfer(options.out, options.quick, context.json);
}

}  // namespace

void add_study(CLI::App& app, Context& context) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* command =
      add_command(app, context, "study", "Repeat a published experiment and compare",
                  "bezel study transfer --quick -o study", options, run);
  command
      ->add_option("NAME", options->name,
                   "transfer: errors and orders of transfers from a square to a disc; compensated: "
                   "polynomials evaluated near multiple roots; newton: ill-conditioned roots and "
                   "intersections by Newton's method; curves: interpolation of curves in the plane")
      ->required()
      ->check(CLI::IsMember({"transfer", "compensated", "newton", "curves"}))
      ->type_name("");
  command->add_option("-o,--output", options->out, "Folder for tables and plots")
      ->required()
      ->type_name("DIR");
  command->add_flag("--quick", options->quick,
                    "Fewer levels, within a minute (the others take a second)");
}

}  // namespace bezel::cli
