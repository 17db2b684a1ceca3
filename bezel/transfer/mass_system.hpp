#pragma once
// Internal: linear systems that ContinuousMass leaves to others.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "bezel/field/space.hpp"

namespace bezel::detail {

/// A symmetric positive definite system, assembled and solved elsewhere.
class MassSystem {
 public:
  MassSystem() = default;
  MassSystem(const MassSystem&) = delete;
  MassSystem& operator=(const MassSystem&) = delete;
  virtual ~MassSystem() = default;

  /// Adds a square block (row major) to the rows and columns named; negative ones are left out.
  virtual void add(std::span<const std::int32_t> rows, std::span<const double> block) = 0;
  /// Ends the assembly.
  virtual void finish() = 0;
  /// Adds to x the solution for the right-hand side, to the residual's norm `smallest`; returns the
  /// number of iterations.
  virtual int solve(std::span<const double> right, double smallest, std::span<double> x) = 0;
};

/// Makes the system for the dofs of a continuous space, whose element blocks are added to it.
using MassSystemMaker = std::function<std::unique_ptr<MassSystem>(const Space& space)>;

}  // namespace bezel::detail
