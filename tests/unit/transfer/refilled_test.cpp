#include "bezel/transfer/refilled.hpp"

#include <gtest/gtest.h>

namespace bezel::detail {
namespace {

TEST(Refilled, IsEmptiedWithItsStorageKept) {
  struct State {
    int number = 0;
    Refilled<double> list;
  };
  State state;
  state.number = 3;
  state.list.assign(100, 1.0);
  const double* const storage = state.list.data();
  static const State none;
  state = none;
  EXPECT_EQ(state.number, 0);
  EXPECT_TRUE(state.list.empty());
  EXPECT_EQ(state.list.capacity(), 100U);
  state.list.resize(2);
  EXPECT_EQ(state.list.data(), storage);
  State other;
  other.list = {1.0, 2.0};
  state = other;
  EXPECT_EQ(state.list.size(), 2U);
  EXPECT_EQ(state.list[1], 2.0);
}

}  // namespace
}  // namespace bezel::detail
