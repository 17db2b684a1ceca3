// The command line tool: understands the arguments, runs one command, and turns what went wrong
// into a message and an exit code.

#include <fmt/core.h>

#include <cctype>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "bezel/base/error.hpp"
#include "bezel/base/progress.hpp"
#include "bezel/transfer/distributed.hpp"
#include "cli/command.hpp"
#include "cli/output.hpp"
#include "cli/progress_bar.hpp"

namespace bezel::cli {
namespace {

int fail(ExitCode code, const std::string& message) {
  fmt::print(stderr, "error: {}\n", message);
  return code;
}

// The innermost command given, for "see 'bezel mesh --help'".
std::string command_path(const CLI::App& app) {
  std::string path = app.get_name();
  for (const CLI::App* sub : app.get_subcommands()) path += " " + sub->get_name();
  return path;
}

std::string lower_first(std::string text) {
  // Names in capitals (FILE) stay.
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1]))) {
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  }
  return text;
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = lower_first(error.what());
  if (const auto at = message.find(": Value "); at != std::string::npos) message[at + 2] = 'v';
  const bool no_command = app.get_subcommands().empty();
  std::string extra;  // the first word that was not understood
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    extra = message.substr(message.rfind(": ") + 2);
    extra = extra.substr(0, extra.find(' '));
  } else if (no_command) {
    const std::vector<std::string> words = app.remaining();
    if (!words.empty()) {
      extra = words[0];
    } else if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
      message = "a command is missing";
    }
  }
  if (!extra.empty()) {
    const bool option = extra.size() > 1 && extra[0] == '-';
    message = option ? "unknown option" : no_command ? "unknown command" : "unexpected argument";
    message += " '" + extra + "'";
  }
  return message + "; see '" + command_path(app) + " --help'";
}

int run(int argc, char** argv) {
  Context context;
  CLI::App app("High-order fields on curved meshes: transfer, inspect and draw them.", "bezel");
  app.require_subcommand(1);
  app.set_version_flag("--version", "bezel " BEZEL_VERSION, "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.get_formatter()->column_width(34);
  app.footer(
      "Example:\n  bezel transfer donor.msh target.msh -f u -o moved.vtu\n\n"
      "'bezel COMMAND --help' shows the options and an example of each command.");
  app.add_flag("--json", context.json, "Print the result as one JSON object");
  app.add_option("--threads", context.threads,
                 "Number of threads; 0: all (the results do not depend on it)")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  app.add_option("--seed", context.seed, "Seed of everything random")
      ->type_name("S")
      ->capture_default_str();
  app.add_flag("-q,--quiet", context.quiet, "No messages but errors");
  app.add_flag("-v,--verbose", context.verbose, "More messages");

  add_info(app, context);
  add_check(app, context);
  add_convert(app, context);
  add_mesh(app, context);
  add_sample(app, context);
  add_transfer(app, context);
  add_error(app, context);
  add_view(app, context);
  add_eval(app, context);
  add_roots(app, context);
  add_intersect(app, context);
  add_curve(app, context);
  add_study(app, context);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      return app.exit(error);
    }
    return fail(usage, usage_message(app, error));
  }
  const std::string command = app.get_subcommands().front()->get_name();
  if (const int size = launch().size; size > 1 && command != "transfer") {
    return fail(usage, fmt::format("{} runs as one process, found {}: start it without mpirun",
                                   command, size));
  }
  try {
    return context.run();
  } catch (const UsageError& error) {
    return fail(usage, std::string(error.what()) + "; see '" + command_path(app) + " --help'");
  }
}

/// run(), whose exceptions become messages and exit codes.
int guarded_run(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    return fail(bad_input, error.what());
  } catch (const NumericsError& error) {
    return fail(gave_up, error.what());
  } catch (const Interrupted& error) {
    return fail(ProgressBar::stop_signal() == SIGTERM ? terminated : interrupted, error.what());
  } catch (const std::bad_alloc&) {
    return fail(gave_up, "out of memory");
  } catch (const std::exception& error) {
    return fail(bug, error.what());
  }
}

}  // namespace
}  // namespace bezel::cli

int main(int argc, char** argv) {
  if (bezel::launch().rank == 0) return bezel::cli::guarded_run(argc, argv);
  // Of several processes that mpirun started the first one speaks.
  for (std::FILE* stream : {stdout, stderr}) {
    if (std::freopen("/dev/null", "w", stream) == nullptr) return bezel::cli::bug;
  }
  const int code = bezel::cli::guarded_run(argc, argv);
  // All were called in the same wrong way. The first process says so; mpirun would end it before
  // that when another one has failed already.
  return code == bezel::cli::usage ? bezel::cli::ok : code;
}
