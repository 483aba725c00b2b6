// The count itself: a test that could not see an allocation would prove nothing.
#include <gtest/gtest.h>

#include <memory>

#include "server/mesh/mesh.h"
#include "tests/contract/allocations.h"

namespace phrenic {
namespace {

TEST(Allocations, AreSeen) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the sanitizer has a malloc of its own";
#endif
  const std::int64_t before = Allocations();
  const auto points = std::make_unique<Points>(Points::Random(3, 100));
  EXPECT_EQ(Allocations(), before + 2) << points->sum();  // by operator new, and by Eigen
}

}  // namespace
}  // namespace phrenic
