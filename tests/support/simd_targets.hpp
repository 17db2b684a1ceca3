#pragma once
// Runs a check on every SIMD target that was compiled and that this machine supports.

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>

namespace support {

/// Whether a target multiplies and adds with one rounding.
inline bool is_fused(std::int64_t target) {
  return (target & (HWY_SSSE3 | HWY_SSE4 | HWY_SCALAR | HWY_EMU128)) == 0;
}

/// @param fused  only on targets that multiply and add with one rounding, when there are any
template <class Check>
void on_every_target(const Check& check, bool fused = false) {
  int ran = 0;
  const auto targets = hwy::SupportedAndGeneratedTargets();
  fused = fused && std::any_of(targets.begin(), targets.end(), is_fused);
  for (const std::int64_t target : targets) {
    if (fused && !is_fused(target)) continue;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check();
    ++ran;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(ran, 1);
  testing::Test::RecordProperty("targets", ran);
}

}  // namespace support
