#pragma once
// Transfer by several processes (MPI).

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bezel/transfer/operator.hpp"

namespace bezel {

/// Whether this build has MPI (BEZEL_WITH_MPI).
bool has_mpi();

/// What a program was started as.
struct Launch {
  int rank = 0, size = 1;
};
/// From the environment that mpirun and its like (Open MPI, MPICH, Slurm's srun with PMI) leave;
/// starts nothing, and works in builds without MPI.
Launch launch();

/// What one process did for transfers.
struct ShareReport {
  std::int64_t targets = 0;    ///< target elements it worked on
  std::int64_t donors = 0;     ///< donor elements it was sent (rank 0: that it would have been)
  std::int64_t pairs = 0;      ///< of elements that overlap
  std::int64_t bytes_in = 0;   ///< sent to it by rank 0
  std::int64_t bytes_out = 0;  ///< sent by it to rank 0
  double seconds = 0;          ///< wall time of its work
  double cpu_seconds = 0;      ///< processor time of its work, all threads
};

/// All processes of a program, to move fields together.
///
/// Rank 0 has the meshes and fields; the others serve it:
///
///     Processes all;
///     if (all.rank() > 0) {
///       all.serve();
///     } else {
///       TransferResult moved = all.transfer(fields, target);
///     }
///
/// The target elements are split among the processes along a space-filling curve; each process is
/// sent the donor elements near its own and sends back coefficients and the pairs it found. What
/// concerns a whole mesh (continuous fields, bounds, sums) is done by rank 0.
class Processes {
 public:
  /// Starts MPI unless it runs already; then it is also ended with this object.
  /// @throws InputError in a build without MPI
  Processes();
  /// On rank 0: ends serve() on the others.
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  int rank() const;
  int size() const;

  /// On all ranks but 0: works for rank 0 until its object ends. An error of the work is thrown on
  /// rank 0, not here.
  /// @param threads  of this process; 0: all
  void serve(int threads = 1);

  /// On rank 0: bezel::transfer() with the work on the target elements shared by all processes.
  /// Fields and report have the same bits (but for the seconds, whose parts are summed over the
  /// processes). With options.threads = 0 rank 0 works on its share with one thread, as the others
  /// do by default, and on what it does alone with all that it may use.
  /// MassMethod::petsc solves with its rows spread over all processes: the result is that of one
  /// process up to rounding, and the same bits only for the same number of processes.
  /// @throws as bezel::transfer(), also for what went wrong elsewhere (what a single process would
  ///         have met first); InputError on another rank
  /// @limits rank 0 holds both meshes, all fields and all pairs. What it does alone grows with the
  ///         meshes: docs/methods/transfer-parallel.md
  TransferResult transfer(std::span<const Field> donors, std::shared_ptr<const TriangleMesh> target,
                          const TransferOptions& options = {}, const Progress& progress = {});

  /// On rank 0: a TransferOperator, with the work on the target elements shared in the same way.
  /// The operator is rank 0's; applying it takes no other process.
  /// @throws as the constructor of TransferOperator; InputError on another rank
  TransferOperator transfer_operator(std::shared_ptr<const Space> donor,
                                     std::shared_ptr<const TriangleMesh> target,
                                     const TransferOptions& options = {},
                                     const Progress& progress = {});

  /// On rank 0: what each rank did so far.
  const std::vector<ShareReport>& shares() const;
  /// On rank 0: processor time of transfers and operators so far, besides its shares: what it did
  /// alone.
  double alone_cpu_seconds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bezel
