#include "cli/progress_bar.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

namespace bezel::cli {
namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int) {
  stop_asked = 1;
}

}  // namespace

struct ProgressBar::State {
  std::string what;
  bool visible = false;  // may be shown at all
  bool shown = false;
  Clock::time_point start = Clock::now(), last = start;
  struct sigaction previous {};

  bool update(double fraction) {
    const auto now = Clock::now();
    if (visible && now - start > std::chrono::seconds(1) &&
        now - last > std::chrono::milliseconds(100)) {
      constexpr int cells = 40;
      const int full = std::clamp(static_cast<int>(fraction * cells), 0, cells);
      fmt::print(stderr, "\r{} [{}{}] {:3.0f} %", what,
                 std::string(static_cast<std::size_t>(full), '#'),
                 std::string(static_cast<std::size_t>(cells - full), '.'), 100 * fraction);
      std::fflush(stderr);
      last = now;
      shown = true;
    }
    return stop_asked == 0;
  }
};

ProgressBar::ProgressBar(const Context& context, std::string what)
    : state_(std::make_unique<State>()) {
  state_->what = std::move(what);
  state_->visible = !context.quiet && ::isatty(STDERR_FILENO) == 1;
  stop_asked = 0;
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program at once
  ::sigaction(SIGINT, &action, &state_->previous);
}

ProgressBar::~ProgressBar() {
  ::sigaction(SIGINT, &state_->previous, nullptr);
  if (state_->shown) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }
}

Progress ProgressBar::callback() {
  return [state = state_.get()](double fraction) { return state->update(fraction); };
}

}  // namespace bezel::cli
