// Runs vector kernels on every instruction set.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <string>

namespace radiosity::test {

/// Calls check(kernels) once for every instruction set compiled in that this machine has, with what
/// `choose`, the library's own function, gives on it. Returns how many there were.
template <class Choose, class Check>
int onEveryTarget(const Choose& choose, const Check& check) {
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
  EXPECT_GT(count, 0) << "no instruction set was tried";
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return count;
}

}  // namespace radiosity::test
