#pragma once
// How the seeded fuzz tests try many inputs.

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <exception>

namespace fuzz {

/// How many inputs are tried, and which part of them must be refused, and not refused, at least:
/// other inputs would test little.
struct Trial {
  std::size_t most;
  std::chrono::seconds time;  ///< after which no more inputs are tried
  double refused, taken;
};

/// @param make  the next input
/// @param run   whether an input was taken, false when it was refused; throws where a check fails
/// @param show  the input as a message, when run throws
template <class Make, class Run, class Show>
void try_many(const Trial& trial, Make&& make, Run&& run, Show&& show) {
  std::size_t tried = 0, refused = 0;
  const auto start = std::chrono::steady_clock::now();
  while (tried < trial.most && std::chrono::steady_clock::now() - start < trial.time) {
    const auto input = make();
    try {
      refused += run(input) ? 0U : 1U;
    } catch (const std::exception& error) {
      FAIL() << "input " << tried << ": " << error.what() << "\n" << show(input);
    }
    ++tried;
  }
  testing::Test::RecordProperty("tried", static_cast<int>(tried));
  EXPECT_GT(static_cast<double>(refused), trial.refused * static_cast<double>(tried));
  EXPECT_GT(static_cast<double>(tried - refused), trial.taken * static_cast<double>(tried));
}

}  // namespace fuzz
