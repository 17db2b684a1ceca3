#pragma once
// Parallel loops over index ranges; oneTBB stays behind this header.

#include <cstddef>
#include <functional>

namespace bezel {

/// Number of threads a loop uses: `requested`, or when it is 0 the machine's.
int thread_count(int requested = 0);

/// Calls body(i) once for each i in [0, n), on up to `threads` threads (0: all). The order is unspecified, so the
/// body must not depend on it; the first exception thrown (of the smallest i that threw, among those run) is
/// rethrown after all running bodies end. body must be safe to call concurrently.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, int threads = 0);

}  // namespace bezel
