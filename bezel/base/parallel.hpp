#pragma once
// Parallel loops over index ranges; oneTBB stays behind this header.

#include <cstddef>
#include <functional>

namespace bezel {

/// Number of threads a loop uses: `requested` when it is positive, else what the machine (or the
/// process's affinity mask) offers; at least 1.
int thread_count(int requested = 0);

/// Calls body(i) once for each i in [0, n), on up to `threads` threads (0: all).
///
/// The order is unspecified, so results must not depend on it. When bodies throw, the exception of
/// the smallest i that throws is rethrown after all running bodies end, whatever the number of
/// threads; indices above it may have been skipped. May be nested.
///
/// @param body  safe to call concurrently
/// @cost        one indirect call per index (about 2 ns); give it blocks of work, not single
/// operations
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, int threads = 0);

}  // namespace bezel
