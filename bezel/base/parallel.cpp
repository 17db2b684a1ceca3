#include "bezel/base/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>

namespace bezel {
namespace {

// Remembers the exception of the smallest index. Every index below the remembered one still runs,
// so at the end it is the smallest index that throws at all: the same for any number of threads.
class FirstFailure {
 public:
  bool below(std::size_t i) const { return i < index_.load(std::memory_order_relaxed); }
  void record(std::size_t i, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (i < index_.load(std::memory_order_relaxed)) {
      index_.store(i, std::memory_order_relaxed);
      error_ = std::move(error);
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<std::size_t> index_{static_cast<std::size_t>(-1)};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

int thread_count(int requested) {
  return requested > 0 ? requested : std::max(1, tbb::info::default_concurrency());
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, int threads) {
  const int count = thread_count(threads);
  if (count == 1 || n <= 1) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  FirstFailure failure;
  const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end() && failure.below(i); ++i) {
      try {
        body(i);
      } catch (...) {
        failure.record(i, std::current_exception());
      }
    }
  };
  // More threads than the machine offers must be allowed for (else oneTBB complains on the standard
  // error).
  std::optional<tbb::global_control> allow;
  if (count > thread_count()) {
    allow.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  }
  tbb::task_arena arena(count);
  arena.execute([&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n), run); });
  failure.rethrow();
}

}  // namespace bezel
