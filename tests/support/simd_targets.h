// Runs vector kernels on every instruction set.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <string>

namespace radiosity::test {

/// Calls check(kernels) once for every instruction set compiled in that this machine has, Highway's
/// scalar target among them, with the kernels that `choose`, the library's own function, gives on
/// it. Fails if there are fewer than two.
template <class Choose, class Check>
void onEveryTarget(const Choose& choose, const Check& check) {
  int count = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    const auto kernels = choose();
    const std::string name = kernels.target;
    SCOPED_TRACE(name);
    EXPECT_EQ(name, hwy::TargetName(target));
    check(kernels);
    ++count;
  }
  EXPECT_GE(count, 2) << "instruction sets tried";
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// The name of Highway's scalar target here.
inline std::string scalarTarget() {
  return hwy::TargetName(HWY_TARGETS & HWY_EMU128 ? HWY_EMU128 : HWY_SCALAR);
}

}  // namespace radiosity::test
