#include "bezel/transfer/petsc_system.hpp"

#include <string>

#include "bezel/base/error.hpp"

#ifdef BEZEL_WITH_PETSC
#include <petscksp.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <vector>

namespace bezel::detail {
namespace {

constexpr int max_steps = 5000;

void check(PetscErrorCode code, const char* what) {
  if (code == 0) return;
  throw NumericsError(std::string("PETSc failed to ") + what + " (error " + std::to_string(code) +
                      ")");
}

/// Starts PETSc for the process unless it runs already.
class Session {
 public:
  Session() {
    PetscBool running = PETSC_FALSE;
    check(PetscInitialized(&running), "start");
    if (running) return;
    // PETSc would catch signals that are the program's business.
    int count = 2;
    std::string name = "bezel";
    std::string quiet = "-no_signal_handler";
    std::array<char*, 3> words{name.data(), quiet.data(), nullptr};
    char** arguments = words.data();
    check(PetscInitialize(&count, &arguments, nullptr, nullptr), "start");
    own_ = true;
  }
  ~Session() {
    if (own_) PetscFinalize();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  bool own_ = false;
};

void start() {
  static const Session session;
}

/// Errors come back as codes instead of being printed.
class QuietErrors {
 public:
  QuietErrors() { PetscPushErrorHandler(PetscReturnErrorHandler, nullptr); }
  ~QuietErrors() { PetscPopErrorHandler(); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
};

/// PETSc is not safe for threads that call it at once.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct PetscSystem::Impl {
  PetscInt n = 0;
  Mat matrix = nullptr;
  KSP solver = nullptr;
  Vec right = nullptr, x = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    KSPDestroy(&solver);
    VecDestroy(&x);
    VecDestroy(&right);
    MatDestroy(&matrix);
  }
};

bool PetscSystem::available() {
  return true;
}

PetscSystem::PetscSystem(std::span<const std::int32_t> row_size) : impl_(new Impl) {
  const std::lock_guard lock(one_at_a_time());
  start();
  const QuietErrors quiet;
  impl_->n = static_cast<PetscInt>(row_size.size());
  const std::vector<PetscInt> sizes(row_size.begin(), row_size.end());
  check(MatCreateSeqAIJ(PETSC_COMM_SELF, impl_->n, impl_->n, 0, sizes.data(), &impl_->matrix),
        "make a matrix");
  check(VecCreateSeq(PETSC_COMM_SELF, impl_->n, &impl_->right), "make a vector");
  check(VecDuplicate(impl_->right, &impl_->x), "make a vector");
  check(KSPCreate(PETSC_COMM_SELF, &impl_->solver), "make a solver");
}

PetscSystem::~PetscSystem() {
  const std::lock_guard lock(one_at_a_time());
  impl_.reset();
}

void PetscSystem::add(std::span<const std::int32_t> rows, std::span<const double> block) {
  const std::lock_guard lock(one_at_a_time());
  const QuietErrors quiet;
  const std::vector<PetscInt> places(rows.begin(), rows.end());
  const auto n = static_cast<PetscInt>(places.size());
  check(MatSetValues(impl_->matrix, n, places.data(), n, places.data(), block.data(), ADD_VALUES),
        "add to the mass matrix");
}

void PetscSystem::finish() {
  const std::lock_guard lock(one_at_a_time());
  const QuietErrors quiet;
  check(MatAssemblyBegin(impl_->matrix, MAT_FINAL_ASSEMBLY), "assemble the mass matrix");
  check(MatAssemblyEnd(impl_->matrix, MAT_FINAL_ASSEMBLY), "assemble the mass matrix");
  KSP solver = impl_->solver;
  PC scaling = nullptr;
  check(KSPSetOperators(solver, impl_->matrix, impl_->matrix), "take the mass matrix");
  check(KSPSetType(solver, KSPCG), "choose conjugate gradients");
  check(KSPGetPC(solver, &scaling), "choose a preconditioner");
  check(PCSetType(scaling, PCJACOBI), "choose a preconditioner");
  check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED), "choose the norm");
  check(KSPSetOptionsPrefix(solver, "bezel_mass_"), "read its options");
  check(KSPSetFromOptions(solver), "read its options");
}

int PetscSystem::solve(std::span<const double> right, double smallest, std::span<double> x) {
  const std::lock_guard lock(one_at_a_time());
  const QuietErrors quiet;
  PetscScalar* values = nullptr;
  check(VecGetArray(impl_->right, &values), "take the right-hand side");
  std::copy(right.begin(), right.end(), values);
  check(VecRestoreArray(impl_->right, &values), "take the right-hand side");
  check(KSPSetTolerances(impl_->solver, 1e-16, smallest, PETSC_DEFAULT, max_steps),
        "take the tolerances");
  check(KSPSolve(impl_->solver, impl_->right, impl_->x), "solve the mass system");
  PetscInt steps = 0;
  check(KSPGetIterationNumber(impl_->solver, &steps), "count its iterations");
  const PetscScalar* found = nullptr;
  check(VecGetArrayRead(impl_->x, &found), "give the solution");
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += found[i];
  check(VecRestoreArrayRead(impl_->x, &found), "give the solution");
  return static_cast<int>(steps);
}

}  // namespace bezel::detail

#else

namespace bezel::detail {

struct PetscSystem::Impl {};

bool PetscSystem::available() {
  return false;
}
PetscSystem::PetscSystem(std::span<const std::int32_t>) {
  throw InputError("this build of bezel has no PETSc (BEZEL_WITH_PETSC)");
}
PetscSystem::~PetscSystem() = default;
void PetscSystem::add(std::span<const std::int32_t>, std::span<const double>) {}
void PetscSystem::finish() {}
int PetscSystem::solve(std::span<const double>, double, std::span<double>) {
  return 0;
}

}  // namespace bezel::detail

#endif
