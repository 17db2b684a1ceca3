#include "bezel/solve/function_value.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bezel/base/error.hpp"

namespace bezel::solve_detail {

std::string place(const Vec2& at) {
  return fmt::format("x = {}, y = {}", at.x(), at.y());
}

double finite(double value, const Vec2& at, const char* what) {
  if (std::isfinite(value)) return value;
  // The sign of a NaN depends on the machine's library; messages do not.
  throw InputError(fmt::format("{} is {} at {}, expected a finite value", what,
                               std::isnan(value) ? std::fabs(value) : value, place(at)));
}

}  // namespace bezel::solve_detail
