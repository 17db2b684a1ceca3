#pragma once
// Progress of long work, told to the caller; the library itself prints nothing.

#include <functional>

namespace bezel {

/// Called now and then with the fraction done in [0, 1], from one thread at a time. Returning false asks the work
/// to stop: it throws Interrupted at the next safe place, with nothing half-written.
using Progress = std::function<bool(double fraction)>;

}  // namespace bezel
