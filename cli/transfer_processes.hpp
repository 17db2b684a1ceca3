#pragma once
// A transfer by several processes, as mpirun starts them.

#include <memory>
#include <string>

#include "bezel/transfer/distributed.hpp"
#include "cli/output.hpp"

namespace bezel::cli {

/// Null when there is one process only.
/// @throws UsageError when there are several and this build has no MPI
std::unique_ptr<Processes> join_processes();

/// What each did: counts, bytes, seconds, and the largest processor time over the mean.
Json processes_json(const Processes& processes);
/// The same as a table.
std::string processes_table(const Processes& processes);

}  // namespace bezel::cli
