#pragma once
// What every subcommand knows: the global options and the exit codes.

#include <cstdint>
#include <functional>
#include <stdexcept>

namespace bezel::cli {

/// Exit codes, the same for every command (docs/cli.md).
enum ExitCode : int {
  ok = 0,
  check_failed = 1,   ///< a check said no
  usage = 2,          ///< wrong options or arguments
  bad_input = 3,      ///< a file, formula or value is wrong
  gave_up = 4,        ///< the numerics gave up, or memory ran out
  bug = 70,           ///< a mistake of ours
  interrupted = 130,  ///< by the user (128 + SIGINT, as shells say it)
  terminated = 143    ///< asked to (128 + SIGTERM)
};

/// The global options, and the command to run once all arguments are understood.
struct Context {
  bool json = false;
  bool quiet = false;
  int verbose = 0;
  int threads = 0;
  std::uint64_t seed = 1;
  std::function<int()> run;
};

/// Wrong usage found by a command itself.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bezel::cli
