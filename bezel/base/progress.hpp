#pragma once
// Progress of long work, told to the caller; the library itself prints nothing.

#include <functional>

#include "bezel/base/error.hpp"

namespace bezel {

/// Called now and then with the fraction done in [0, 1], from one thread at a time. Returning false
/// asks the work to stop: it throws Interrupted at the next safe place, with nothing half-written.
using Progress = std::function<bool(double fraction)>;

/// The work stopped because its Progress asked for it.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

/// Tells the fraction done, when there is anyone to tell.
///
/// @throws Interrupted when the caller asks to stop
inline void tell(const Progress& progress, double fraction) {
  if (progress && !progress(fraction)) throw Interrupted();
}

}  // namespace bezel
