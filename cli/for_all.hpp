#pragma once
// Work on many items at a time, told to a progress bar.

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "bezel/base/parallel.hpp"
#include "bezel/base/progress.hpp"

namespace bezel::cli {

/// work(i) for i in [0, n), in parallel, `block` at a time. @throws Interrupted
template <class Work>
void for_all(std::size_t n, std::size_t block, int threads, const Progress& progress, Work work) {
  const std::size_t blocks = (n + block - 1) / block;
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(
      blocks,
      [&](std::size_t k) {
        for (std::size_t i = k * block; i < std::min(n, (k + 1) * block); ++i) work(i);
        if (progress) {
          const std::lock_guard lock(mutex);
          tell(progress, static_cast<double>(++done) / static_cast<double>(blocks));
        }
      },
      threads);
}

}  // namespace bezel::cli
