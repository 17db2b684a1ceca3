#pragma once
// A progress bar on the standard error, and stopping on Ctrl-C or when asked to terminate.

#include <memory>

#include "bezel/base/progress.hpp"
#include "cli/context.hpp"

namespace bezel::cli {

/// Shows a bar when the standard error is a terminal, after one second, unless --quiet; wipes it at
/// the end. While it lives, Ctrl-C (SIGINT) and SIGTERM ask the work to stop (it then throws
/// Interrupted); work that does not ask, such as writing files, is finished first.
class ProgressBar {
 public:
  ProgressBar(const Context& context, std::string what);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();
  Progress callback();
  /// The bar goes, signals still only ask.
  void wipe();
  /// The signal that asked to stop last, or 0.
  static int stop_signal();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bezel::cli
