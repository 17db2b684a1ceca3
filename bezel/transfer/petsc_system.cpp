#include "bezel/transfer/petsc_system.hpp"

#include <algorithm>
#include <string>

#include "bezel/base/error.hpp"

#ifdef BEZEL_WITH_PETSC
#include <petscksp.h>

#include <array>
#include <memory>
#include <mutex>
#endif

namespace bezel::detail {
namespace {

/// All rows, the numbers of the dofs.
RowRange rows_of(const Space& space) {
  RowRange rows;
  rows.all = static_cast<std::int32_t>(space.dof_count());
  rows.inside.assign(space.dof_count(), 0);
  rows.outside.assign(space.dof_count(), 0);
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e) {
    const auto dofs = space.dofs(ElementId(e));
    for (const std::int32_t d : dofs)
      rows.inside[static_cast<std::size_t>(d)] += static_cast<std::int32_t>(dofs.size());
  }
  return rows;
}

}  // namespace

PetscSystem::PetscSystem(const Space& space) : rows_(rows_of(space), true) {}

#ifdef BEZEL_WITH_PETSC
namespace {

constexpr int max_steps = 5000;

void check(PetscErrorCode code, const char* what) {
  if (code == 0) return;
  throw NumericsError(std::string("PETSc failed to ") + what + " (error " + std::to_string(code) +
                      ")");
}

/// PETSc started here.
class Session {
 public:
  explicit Session(bool alone) {
    int mpi = 0;
    MPI_Initialized(&mpi);
    // Where other processes may be, they do not know that this one starts PETSc for itself.
    if (alone && mpi != 0) PETSC_COMM_WORLD = MPI_COMM_SELF;
    // PETSc would catch signals that are the program's business.
    int count = 2;
    std::string name = "bezel";
    std::string quiet = "-no_signal_handler";
    std::array<char*, 3> words{name.data(), quiet.data(), nullptr};
    char** arguments = words.data();
    check(PetscInitialize(&count, &arguments, nullptr, nullptr), "start");
  }
  ~Session() { PetscFinalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

std::unique_ptr<Session>& session() {
  static std::unique_ptr<Session> own;
  return own;
}

void start(bool alone) {
  PetscBool running = PETSC_FALSE;
  check(PetscInitialized(&running), "start");
  if (!running) session() = std::make_unique<Session>(alone);
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

std::vector<PetscInt> at_most(const std::vector<std::int32_t>& sizes, std::int32_t largest) {
  std::vector<PetscInt> out;
  for (const std::int32_t size : sizes) out.push_back(std::min(size, largest));
  return out;
}

}  // namespace

struct PetscRows::Impl {
  PetscInt first = 0, end = 0;
  Mat matrix = nullptr;
  KSP solver = nullptr;
  ::Vec right = nullptr, x = nullptr;

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

bool PetscRows::available() {
  return true;
}

void end_petsc() {
  const std::lock_guard lock(one_at_a_time());
  session().reset();
}

PetscRows::PetscRows(const RowRange& rows, bool alone) : impl_(new Impl) {
  const std::lock_guard lock(one_at_a_time());
  start(alone);
  const QuietErrors quiet;
  const MPI_Comm processes = alone ? MPI_COMM_SELF : MPI_COMM_WORLD;
  Impl& m = *impl_;
  m.first = rows.first;
  m.end = rows.first + rows.size();
  const auto inside = at_most(rows.inside, rows.size());
  const auto outside = at_most(rows.outside, rows.all - rows.size());
  check(MatCreateAIJ(processes, rows.size(), rows.size(), rows.all, rows.all, 0, inside.data(), 0,
                     outside.data(), &m.matrix),
        "make a matrix");
  check(MatCreateVecs(m.matrix, &m.x, &m.right), "make vectors");
  check(KSPCreate(processes, &m.solver), "make a solver");
}

PetscRows::~PetscRows() {
  const std::lock_guard lock(one_at_a_time());
  impl_.reset();
}

void PetscRows::add(std::span<const std::int32_t> rows, std::span<const double> block) {
  const std::lock_guard lock(one_at_a_time());
  const QuietErrors quiet;
  const std::vector<PetscInt> columns(rows.begin(), rows.end());
  std::vector<PetscInt> own = columns;
  for (PetscInt& row : own)
    if (row < impl_->first || row >= impl_->end) row = -1;
  const auto n = static_cast<PetscInt>(own.size());
  check(MatSetValues(impl_->matrix, n, own.data(), n, columns.data(), block.data(), ADD_VALUES),
        "add to the mass matrix");
}

void PetscRows::finish() {
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

int PetscRows::solve(std::span<const double> right, double smallest, std::span<double> x) {
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

#else

struct PetscRows::Impl {};

bool PetscRows::available() {
  return false;
}
PetscRows::PetscRows(const RowRange&, bool) {
  throw InputError("this build of bezel has no PETSc (BEZEL_WITH_PETSC)");
}
PetscRows::~PetscRows() = default;
void PetscRows::add(std::span<const std::int32_t>, std::span<const double>) {}
void PetscRows::finish() {}
int PetscRows::solve(std::span<const double>, double, std::span<double>) {
  return 0;
}
void end_petsc() {}

#endif

}  // namespace bezel::detail
