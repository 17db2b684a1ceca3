#include "bezel/base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace bezel {
namespace {

TEST(Parallel, ThreadCount) {
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_GE(thread_count(), 1);
  EXPECT_EQ(thread_count(-5), thread_count(0));
}

TEST(Parallel, EveryIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    for (const std::size_t n : {0u, 1u, 2u, 1000u, 100000u}) {
      std::vector<int> count(n, 0);
      parallel_for(
          n, [&](std::size_t i) { ++count[i]; }, threads);
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(count[i], 1) << i << " of " << n;
    }
  }
}

TEST(Parallel, TheSmallestFailureWinsForAnyThreadCount) {
  for (const int threads : {1, 2, 4}) {
    for (int round = 0; round < 20; ++round) {
      std::string what;
      try {
        parallel_for(
            5000,
            [](std::size_t i) {
              if (i % 1000 == 777) throw std::runtime_error(std::to_string(i));
            },
            threads);
      } catch (const std::runtime_error& error) {
        what = error.what();
      }
      EXPECT_EQ(what, "777");
    }
  }
}

TEST(Parallel, Nests) {
  std::atomic<int> count{0};
  parallel_for(
      8,
      [&](std::size_t) {
        parallel_for(
            8, [&](std::size_t) { ++count; }, 2);
      },
      2);
  EXPECT_EQ(count.load(), 64);
}

}  // namespace
}  // namespace bezel
