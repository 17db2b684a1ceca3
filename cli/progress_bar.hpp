#pragma once
// A progress bar on the standard error, and stopping on Ctrl-C.

#include <memory>

#include "bezel/base/progress.hpp"
#include "cli/context.hpp"

namespace bezel::cli {

/// Shows a bar when the standard error is a terminal, after one second, unless --quiet; wipes it at
/// the end. While it lives, Ctrl-C asks the work to stop (it then throws Interrupted).
class ProgressBar {
 public:
  ProgressBar(const Context& context, std::string what);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();
  Progress callback();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bezel::cli
