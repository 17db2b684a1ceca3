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

volatile std::sig_atomic_t stop_asked = 0;  // the signal, or 0

void ask_to_stop(int signal) {
  stop_asked = signal;
}

}  // namespace

struct ProgressBar::State {
  std::string what;
  bool visible = false;  // may be shown at all
  bool shown = false;
  Clock::time_point start = Clock::now(), last = start;
  struct sigaction previous_interrupt {
  }, previous_terminate{};

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
  ::sigaction(SIGINT, &action, &state_->previous_interrupt);
  ::sigaction(SIGTERM, &action, &state_->previous_terminate);
}

ProgressBar::~ProgressBar() {
  ::sigaction(SIGINT, &state_->previous_interrupt, nullptr);
  ::sigaction(SIGTERM, &state_->previous_terminate, nullptr);
  wipe();
}

void ProgressBar::wipe() {
  if (state_->shown) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }
  state_->visible = state_->shown = false;
}

int ProgressBar::stop_signal() {
  return stop_asked;
}

Progress ProgressBar::callback() {
  return [state = state_.get()](double fraction) { return state->update(fraction); };
}

}  // namespace bezel::cli
