#pragma once
// A transfer split among processes, all of them this one.

#include <gtest/gtest.h>

#include "bezel/transfer/share.hpp"

namespace bezel::test {

/// Works on the shares one after the other, each from its message alone.
inline detail::Sweeper in_shares(std::size_t count) {
  using namespace detail;
  return [count](const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
                 std::span<Group> groups, const TransferOptions& options, const Progress&,
                 const VisitBlocks& visit) {
    const std::vector<Share> shares = split_work(donor, target, search, count, 1);
    std::vector<ChunkResult> chunks(shares.back().first_chunk + shares.back().chunk_count);
    ShareWriter writer(donor, target, search, groups, options, static_cast<bool>(visit));
    for (const Share& share : shares) {
      if (share.own.empty()) continue;
      MessageWriter order;
      writer.write(share, order);
      const auto bytes = order.take();
      MessageReader in(bytes);
      MessageWriter answer;
      const ShareReport work = work_on(in, 1, answer);
      EXPECT_TRUE(in.at_end());
      EXPECT_EQ(work.targets, static_cast<std::int64_t>(share.own.size()));
      EXPECT_EQ(work.donors, static_cast<std::int64_t>(share.donors.size()));
      const auto results = answer.take();
      MessageReader out(results);
      read_results(share, out, groups, chunks, visit);
      EXPECT_TRUE(out.at_end());
    }
    return chunks;
  };
}

}  // namespace bezel::test
