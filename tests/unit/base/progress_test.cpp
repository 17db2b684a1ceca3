#include "bezel/base/progress.hpp"

#include <gtest/gtest.h>

namespace bezel {
namespace {

TEST(Progress, TellsAndInterrupts) {
  double last = -1;
  tell(Progress{}, 0.5);
  tell([&](double fraction) { return (last = fraction) < 0.9; }, 0.5);
  EXPECT_EQ(last, 0.5);
  EXPECT_THROW(tell([](double) { return false; }, 0.5), Interrupted);
  EXPECT_THROW(tell([](double) { return false; }, 0.5), Error);
}

}  // namespace
}  // namespace bezel
