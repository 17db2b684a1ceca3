#include "bezel/transfer/distributed.hpp"

#include <cstdlib>
#include <cstring>
#include <string>

#include "bezel/base/error.hpp"

#ifdef BEZEL_WITH_MPI
// The C interface is all that is used.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <exception>

#include "bezel/transfer/distributed_system.hpp"
#include "bezel/transfer/message.hpp"
#include "bezel/transfer/mpi_message.hpp"
#include "bezel/transfer/operator_by.hpp"
#include "bezel/transfer/share.hpp"
#endif

namespace bezel {
namespace {

int number_in_environment(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) return -1;
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  return end != text && *end == '\0' && value >= 0 && value < (1L << 30) ? static_cast<int>(value)
                                                                         : -1;
}

}  // namespace

Launch launch() {
  constexpr const char* names[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                      {"PMI_RANK", "PMI_SIZE"}};
  for (const auto& [rank, size] : names) {
    const Launch found{number_in_environment(rank), number_in_environment(size)};
    if (found.rank >= 0 && found.size > found.rank) return found;
  }
  return {};
}

#ifdef BEZEL_WITH_MPI

namespace {

using detail::Bytes;
using detail::Order;
using detail::Outcome;
using detail::receive;
using detail::send;

/// The answer to an order to work.
Bytes answer(detail::MessageReader& in, int threads) {
  try {
    detail::MessageWriter results;
    const ShareReport work = detail::work_on(in, threads, results);
    detail::MessageWriter out;
    out.value(Outcome::done);
    out.value(work);
    out.list(results.take());
    return out.take();
  } catch (...) {
    return detail::failure();
  }
}

}  // namespace

bool has_mpi() {
  return true;
}

struct Processes::Impl {
  bool started = false;
  int rank = 0, size = 1;
  bool served = false;
  std::vector<ShareReport> shares;
  double alone = 0;
  std::int32_t systems = 0;  // made so far
  detail::ServedRows served_rows;

  std::vector<detail::ChunkResult> sweep(const detail::OverlayMesh& donor,
                                         const detail::OverlayMesh& target,
                                         const detail::FrontSearch& search,
                                         std::span<detail::Group> groups,
                                         const TransferOptions& options, const Progress& progress,
                                         const detail::VisitBlocks& visit);
  detail::Crew crew() {
    return {sweeper(), [this](const Space& space) -> std::unique_ptr<detail::MassSystem> {
              if (size == 1) return std::make_unique<detail::PetscSystem>(space);
              return std::make_unique<detail::DistributedSystem>(systems++, space, shares);
            }};
  }
  detail::Sweeper sweeper() {
    return [this](const detail::OverlayMesh& donor, const detail::OverlayMesh& target,
                  const detail::FrontSearch& search, std::span<detail::Group> groups,
                  const TransferOptions& options, const Progress& progress,
                  const detail::VisitBlocks& visit) {
      return sweep(donor, target, search, groups, options, progress, visit);
    };
  }
  /// Calls work(), and notes what it took besides the share of rank 0.
  template <class Work>
  auto measured(const Work& work) {
    const detail::Stopwatch watch;
    const double own = shares[0].cpu_seconds;
    auto result = work();
    alone += watch.cpu_seconds() - (shares[0].cpu_seconds - own);
    return result;
  }
};

Processes::Processes() : impl_(std::make_unique<Impl>()) {
  int running = 0;
  MPI_Initialized(&running);
  if (running == 0) {
    // Only the thread that made the object calls MPI.
    int level = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
    impl_->started = true;
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &impl_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &impl_->size);
  impl_->shares.resize(static_cast<std::size_t>(impl_->size));
}

Processes::~Processes() {
  if (impl_->rank == 0) {
    constexpr std::byte end{static_cast<std::uint8_t>(Order::end)};
    for (int r = 1; r < impl_->size; ++r) send(r, {&end, 1});
  } else if (!impl_->served) {
    // Rank 0 would wait for this process for ever.
    MPI_Abort(MPI_COMM_WORLD, 70);
  }
  impl_->served_rows = {};
  if (!impl_->started) return;
  detail::end_petsc();
  MPI_Finalize();
}

int Processes::rank() const {
  return impl_->rank;
}
int Processes::size() const {
  return impl_->size;
}
const std::vector<ShareReport>& Processes::shares() const {
  return impl_->shares;
}

double Processes::alone_cpu_seconds() const {
  return impl_->alone;
}

void Processes::serve(int threads) {
  if (impl_->rank == 0) throw InputError("transfer: rank 0 serves no other process");
  while (true) {
    const Bytes bytes = receive(0);
    detail::MessageReader in(bytes);
    const auto order = in.value<Order>();
    if (order == Order::end) break;
    if (order == Order::work) {
      send(0, answer(in, threads));
    } else {
      impl_->served_rows.obey(order, in);
    }
  }
  impl_->served = true;
}

std::vector<detail::ChunkResult> Processes::Impl::sweep(
    const detail::OverlayMesh& donor, const detail::OverlayMesh& target,
    const detail::FrontSearch& search, std::span<detail::Group> groups,
    const TransferOptions& options, const Progress& progress, const detail::VisitBlocks& visit) {
  const auto count = static_cast<std::size_t>(size);
  const std::vector<detail::Share> split =
      detail::split_work(donor, target, search, count, options.threads);
  detail::ShareWriter writer(donor, target, search, groups, options, static_cast<bool>(visit));
  for (std::size_t r = 1; r < count; ++r) {
    if (split[r].own.empty()) continue;
    detail::MessageWriter out;
    out.value(Order::work);
    writer.write(split[r], out);
    const Bytes bytes = out.take();
    shares[r].bytes_in += static_cast<std::int64_t>(bytes.size());
    send(static_cast<int>(r), bytes);
  }
  std::vector<detail::ChunkResult> chunks(split.back().first_chunk + split.back().chunk_count);
  // The others' answers are taken even when something went wrong: they would wait with them.
  std::exception_ptr error;
  TransferOptions own_options = options;
  if (own_options.threads == 0) own_options.threads = 1;
  try {
    const detail::Share& own = split[0];
    const detail::Stopwatch watch;
    std::vector<detail::ChunkResult> here = detail::sweep_elements(
        donor, target, search, groups, own.own, own_options, progress, visit);
    ShareReport& report = shares[0];
    report.targets += static_cast<std::int64_t>(own.own.size());
    report.donors += static_cast<std::int64_t>(own.donors.size());
    for (const detail::ChunkResult& chunk : here) report.pairs += chunk.counts.pairs;
    report.seconds += watch.seconds();
    report.cpu_seconds += watch.cpu_seconds();
    std::move(here.begin(), here.end(), chunks.begin());
  } catch (...) {
    error = std::current_exception();
  }
  for (std::size_t r = 1; r < count; ++r) {
    if (split[r].own.empty()) continue;
    try {
      const Bytes bytes = receive(static_cast<int>(r));
      detail::MessageReader in(bytes);
      const auto outcome = in.value<Outcome>();
      if (error) continue;
      if (outcome != Outcome::done) detail::rethrow(outcome, in.text());
      const auto report = in.value<ShareReport>();
      const Bytes results = in.list<std::byte>();
      detail::MessageReader reader(results);
      detail::read_results(split[r], reader, groups, chunks, visit);
      ShareReport& sum = shares[r];
      sum.targets += report.targets;
      sum.donors += report.donors;
      sum.pairs += report.pairs;
      sum.bytes_out += static_cast<std::int64_t>(bytes.size());
      sum.seconds += report.seconds;
      sum.cpu_seconds += report.cpu_seconds;
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
  return chunks;
}

TransferResult Processes::transfer(std::span<const Field> donors,
                                   std::shared_ptr<const TriangleMesh> target,
                                   const TransferOptions& options, const Progress& progress) {
  if (impl_->rank != 0) throw InputError("transfer: rank 0 moves the fields, the others serve it");
  return impl_->measured(
      [&] { return detail::transfer_by(impl_->crew(), donors, target, options, progress); });
}

TransferOperator Processes::transfer_operator(std::shared_ptr<const Space> donor,
                                              std::shared_ptr<const TriangleMesh> target,
                                              const TransferOptions& options,
                                              const Progress& progress) {
  if (impl_->rank != 0) throw InputError("transfer: rank 0 makes operators, the others serve it");
  return impl_->measured([&] {
    return detail::OperatorBy::make(impl_->sweeper(), std::move(donor), std::move(target), options,
                                    progress);
  });
}

#else

bool has_mpi() {
  return false;
}

struct Processes::Impl {
  std::vector<ShareReport> shares;
};

Processes::Processes() {
  throw InputError("this build of bezel has no MPI (BEZEL_WITH_MPI), expected one process");
}
Processes::~Processes() = default;
int Processes::rank() const {
  return 0;
}
int Processes::size() const {
  return 1;
}
void Processes::serve(int) {}
TransferResult Processes::transfer(std::span<const Field>, std::shared_ptr<const TriangleMesh>,
                                   const TransferOptions&, const Progress&) {
  return {};
}
TransferOperator Processes::transfer_operator(std::shared_ptr<const Space> donor,
                                              std::shared_ptr<const TriangleMesh> target,
                                              const TransferOptions& options,
                                              const Progress& progress) {
  return {std::move(donor), std::move(target), options, progress};
}
const std::vector<ShareReport>& Processes::shares() const {
  return impl_->shares;
}
double Processes::alone_cpu_seconds() const {
  return 0;
}

#endif

}  // namespace bezel
