#include "bezel/transfer/distributed_system.hpp"

#ifdef BEZEL_WITH_MPI
#include <algorithm>
#include <exception>
#include <string>

#include "bezel/transfer/share.hpp"

namespace bezel::detail {
namespace {

/// Blocks are sent when this many bytes of them wait.
constexpr std::size_t enough_bytes = std::size_t{1} << 22;

}  // namespace

DistributedSystem::DistributedSystem(std::int32_t number, const Space& space,
                                     std::vector<ShareReport>& shares)
    : number_(number), shares_(shares), split_(space, shares.size()), peers_(shares.size()) {
  for (std::size_t r = 1; r < shares_.size(); ++r) {
    const RowRange& range = split_.ranges[r];
    MessageWriter out = order(Order::make_rows);
    out.value(range.first);
    out.value(range.all);
    out.list(range.inside);
    out.list(range.outside);
    tell(r, out);
  }
  together([&] { rows_ = std::make_unique<PetscRows>(split_.ranges[0], false); },
           [](std::size_t, MessageReader&) {});
}

DistributedSystem::~DistributedSystem() {
  for (std::size_t r = 1; r < shares_.size(); ++r) {
    MessageWriter out = order(Order::drop_rows);
    send(static_cast<int>(r), out.take());
  }
}

MessageWriter DistributedSystem::order(Order what) const {
  MessageWriter out;
  out.value(what);
  out.value(number_);
  return out;
}

void DistributedSystem::tell(std::size_t process, MessageWriter& message) {
  const Bytes bytes = message.take();
  shares_[process].bytes_in += static_cast<std::int64_t>(bytes.size());
  send(static_cast<int>(process), bytes);
}

template <class Own, class Take>
void DistributedSystem::together(const Own& own, const Take& take) {
  std::exception_ptr error;
  const Stopwatch watch;
  try {
    own();
  } catch (...) {
    error = std::current_exception();
  }
  shares_[0].seconds += watch.seconds();
  shares_[0].cpu_seconds += watch.cpu_seconds();
  for (std::size_t r = 1; r < shares_.size(); ++r) {
    try {
      const Bytes bytes = receive(static_cast<int>(r));
      ShareReport& share = shares_[r];
      share.bytes_out += static_cast<std::int64_t>(bytes.size());
      MessageReader in(bytes);
      const auto outcome = in.value<Outcome>();
      if (outcome != Outcome::done) rethrow(outcome, in.text());
      share.seconds += in.value<double>();
      share.cpu_seconds += in.value<double>();
      take(r, in);
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}

void DistributedSystem::send_blocks(std::size_t process) {
  Peer& peer = peers_[process];
  if (peer.waiting == 0) return;
  MessageWriter out = order(Order::add_blocks);
  out.list(peer.blocks.take());
  peer.waiting = 0;
  tell(process, out);
}

void DistributedSystem::add(std::span<const std::int32_t> dofs, std::span<const double> block) {
  std::vector<std::int32_t> rows;
  std::vector<int> owners;
  for (const std::int32_t d : dofs) {
    rows.push_back(d < 0 ? -1 : split_.row[static_cast<std::size_t>(d)]);
    if (d >= 0) owners.push_back(split_.owner(rows.back()));
  }
  std::ranges::sort(owners);
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
  for (const int owner : owners) {
    if (owner == 0) {
      rows_->add(rows, block);
      continue;
    }
    Peer& peer = peers_[static_cast<std::size_t>(owner)];
    peer.blocks.list(rows);
    peer.blocks.list(block);
    peer.waiting += rows.size() * sizeof(std::int32_t) + block.size_bytes();
    if (peer.waiting >= enough_bytes) send_blocks(static_cast<std::size_t>(owner));
  }
}

void DistributedSystem::finish() {
  for (std::size_t r = 1; r < shares_.size(); ++r) {
    send_blocks(r);
    MessageWriter out = order(Order::finish_rows);
    tell(r, out);
  }
  together([&] { rows_->finish(); }, [](std::size_t, MessageReader&) {});
}

int DistributedSystem::solve(std::span<const double> right, double smallest, std::span<double> x) {
  std::vector<double> sorted(right.size());
  for (std::size_t d = 0; d < right.size(); ++d)
    sorted[static_cast<std::size_t>(split_.row[d])] = right[d];
  const auto part_of = [&](std::size_t process) {
    const RowRange& range = split_.ranges[process];
    return std::span(sorted).subspan(static_cast<std::size_t>(range.first),
                                     static_cast<std::size_t>(range.size()));
  };
  for (std::size_t r = 1; r < shares_.size(); ++r) {
    MessageWriter out = order(Order::solve);
    out.value(smallest);
    out.list(std::span<const double>(part_of(r)));
    tell(r, out);
  }
  int steps = 0;
  std::vector<double> own(part_of(0).size(), 0.0);
  together([&] { steps = rows_->solve(part_of(0), smallest, own); },
           [&](std::size_t r, MessageReader& in) {
             std::ranges::copy(in.list<double>(), part_of(r).begin());
           });
  std::ranges::copy(own, part_of(0).begin());
  for (std::size_t d = 0; d < x.size(); ++d)
    x[d] += sorted[static_cast<std::size_t>(split_.row[d])];
  return steps;
}

void ServedRows::obey(Order order, MessageReader& in) {
  const auto number = in.value<std::int32_t>();
  if (order == Order::drop_rows) {
    systems_.erase(number);
    return;
  }
  System& system = systems_[number];
  if (order == Order::add_blocks) {
    try {
      const std::vector<std::byte> bytes = in.list<std::byte>();
      MessageReader blocks(bytes);
      while (!blocks.at_end()) {
        const auto rows = blocks.list<std::int32_t>();
        system.rows->add(rows, blocks.list<double>());
      }
    } catch (...) {
      system.error = failure();
    }
    return;
  }
  Bytes answer;
  try {
    const Stopwatch watch;
    std::vector<double> x;
    if (order == Order::make_rows) {
      RowRange range;
      range.first = in.value<std::int32_t>();
      range.all = in.value<std::int32_t>();
      range.inside = in.list<std::int32_t>();
      range.outside = in.list<std::int32_t>();
      system.size = range.inside.size();
      system.rows = std::make_unique<PetscRows>(range, false);
    } else if (order == Order::finish_rows) {
      system.rows->finish();
    } else {
      const auto smallest = in.value<double>();
      x.resize(system.size);
      system.rows->solve(in.list<double>(), smallest, x);
    }
    MessageWriter out;
    out.value(Outcome::done);
    out.value(watch.seconds());
    out.value(watch.cpu_seconds());
    out.list(x);
    answer = out.take();
  } catch (...) {
    answer = failure();
  }
  send(0, system.error.empty() ? answer : system.error);
}

}  // namespace bezel::detail

#endif
