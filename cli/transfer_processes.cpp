#include "cli/transfer_processes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace bezel::cli {
namespace {

/// Largest processor time of a process over the mean: 1 when all do the same.
double imbalance(const std::vector<ShareReport>& shares) {
  double largest = 0.0;
  double sum = 0.0;
  for (const ShareReport& share : shares) {
    largest = std::max(largest, share.cpu_seconds);
    sum += share.cpu_seconds;
  }
  return sum > 0.0 ? largest * static_cast<double>(shares.size()) / sum : 1.0;
}

}  // namespace

std::unique_ptr<Processes> join_processes() {
  const int size = launch().size;
  if (size == 1) return nullptr;
  if (!has_mpi()) {
    throw UsageError(
        fmt::format("found {} processes, expected 1: this build of bezel has no MPI", size));
  }
  return std::make_unique<Processes>();
}

Json processes_json(const Processes& processes) {
  Json shares = Json::array();
  for (const ShareReport& share : processes.shares()) {
    shares.push_back({{"targets", share.targets},
                      {"donors", share.donors},
                      {"pairs", share.pairs},
                      {"bytes_in", share.bytes_in},
                      {"bytes_out", share.bytes_out},
                      {"seconds", share.seconds},
                      {"cpu_seconds", share.cpu_seconds}});
  }
  return {{"count", processes.size()},
          {"imbalance", imbalance(processes.shares())},
          {"alone_cpu_seconds", processes.alone_cpu_seconds()},
          {"shares", shares}};
}

std::string processes_table(const Processes& processes) {
  std::string text = fmt::format("{:>7}  {:>9}  {:>9}  {:>10}  {:>10}  {:>10}  {:>9}\n", "process",
                                 "targets", "donors", "pairs", "MB in", "MB out", "CPU s");
  constexpr double mega = 1e6;
  for (std::size_t r = 0; r < processes.shares().size(); ++r) {
    const ShareReport& share = processes.shares()[r];
    text += fmt::format("{:>7}  {:>9}  {:>9}  {:>10}  {:>10.3f}  {:>10.3f}  {:>9.3f}\n", r,
                        share.targets, share.donors, share.pairs,
                        static_cast<double>(share.bytes_in) / mega,
                        static_cast<double>(share.bytes_out) / mega, share.cpu_seconds);
  }
  return text + fmt::format(
                    "largest processor time {:.2f} of the mean; {:.3g} s more of process 0 alone\n",
                    imbalance(processes.shares()), processes.alone_cpu_seconds());
}

}  // namespace bezel::cli
