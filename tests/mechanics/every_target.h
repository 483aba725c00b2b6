// What is written with Google Highway, checked on every instruction set that this machine has, the portable path among
// them.
#ifndef PHRENIC_TESTS_MECHANICS_EVERY_TARGET_H_
#define PHRENIC_TESTS_MECHANICS_EVERY_TARGET_H_

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace phrenic {

// Each instruction set in turn: this machine's best is chosen again at the end.
template <typename Check>
void OnEveryTarget(const Check& check) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MECHANICS_EVERY_TARGET_H_
