#pragma once
// Internal: systems solved by PETSc, in builds that have it (BEZEL_WITH_PETSC).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace bezel::detail {

/// A symmetric positive definite matrix in PETSc's hands, in one process.
///
/// Conjugate gradients with diagonal scaling; PETSc's own options (the environment variable
/// PETSC_OPTIONS, prefix -bezel_mass_) choose another method: -bezel_mass_pc_type icc, say. PETSc,
/// and MPI under it, are started when first needed and ended when the process ends, unless the
/// caller has started them.
class PetscSystem {
 public:
  /// Is this build one with PETSc?
  static bool available();
  /// @param row_size  upper bounds of the number of entries per row
  /// @throws InputError in a build without PETSc; NumericsError when PETSc fails
  explicit PetscSystem(std::span<const std::int32_t> row_size);
  ~PetscSystem();
  PetscSystem(const PetscSystem&) = delete;
  PetscSystem& operator=(const PetscSystem&) = delete;

  /// Adds a square block (row major) to the rows and columns named; negative ones are left out.
  void add(std::span<const std::int32_t> rows, std::span<const double> block);
  /// Ends the assembly.
  void finish();
  /// Adds to x the solution for the right-hand side, to the residual's norm `smallest`; returns the
  /// number of iterations.
  int solve(std::span<const double> right, double smallest, std::span<double> x);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bezel::detail
