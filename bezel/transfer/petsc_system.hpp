#pragma once
// Internal: systems solved by PETSc, in builds that have it (BEZEL_WITH_PETSC).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/transfer/mass_system.hpp"

namespace bezel::detail {

/// The rows of a matrix that one process has: a range of all, the first process's first.
struct RowRange {
  std::int32_t first = 0, all = 0;
  /// Per row upper bounds of its entries, in the columns of the process's own rows and in others.
  std::vector<std::int32_t> inside, outside;

  std::int32_t size() const { return static_cast<std::int32_t>(inside.size()); }
};

/// A process's rows of a symmetric positive definite matrix in PETSc's hands: all of them, or, with
/// MPI, its part of a matrix on all processes, each of which does the same calls in the same order.
///
/// Conjugate gradients with diagonal scaling; PETSc's own options (the environment variable
/// PETSC_OPTIONS of the first process, prefix -bezel_mass_) choose another method:
/// -bezel_mass_pc_type icc, say. PETSc, and MPI under it, are started when first needed, unless the
/// caller has started them, and ended when the process ends or by end_petsc().
class PetscRows {
 public:
  /// Is this build one with PETSc?
  static bool available();
  /// @param alone  the matrix is this process's
  /// @throws InputError in a build without PETSc; NumericsError when PETSc fails
  PetscRows(const RowRange& rows, bool alone);
  ~PetscRows();
  PetscRows(const PetscRows&) = delete;
  PetscRows& operator=(const PetscRows&) = delete;

  /// MassSystem::add(); rows of other processes are left out.
  void add(std::span<const std::int32_t> rows, std::span<const double> block);
  void finish();
  /// MassSystem::solve(), for the process's own rows.
  int solve(std::span<const double> right, double smallest, std::span<double> x);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Ends PETSc where PetscRows started it: before MPI ends.
void end_petsc();

/// A matrix in one process.
class PetscSystem final : public MassSystem {
 public:
  explicit PetscSystem(const Space& space);

  void add(std::span<const std::int32_t> rows, std::span<const double> block) override {
    rows_.add(rows, block);
  }
  void finish() override { rows_.finish(); }
  int solve(std::span<const double> right, double smallest, std::span<double> x) override {
    return rows_.solve(right, smallest, x);
  }

 private:
  PetscRows rows_;
};

}  // namespace bezel::detail
