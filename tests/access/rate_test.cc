#include "server/access/rate.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"

namespace phrenic::access {
namespace {

const absl::Time kStart = absl::UnixEpoch();

int Taken(RateLimit& limit, const std::string& caller, absl::Time now, int tries) {
  int taken = 0;
  for (int i = 0; i < tries; ++i) taken += limit.Take(caller, now).ok() ? 1 : 0;
  return taken;
}

TEST(RateLimit, AllowsABurstAndThenTheRate) {
  RateLimit limit(10);
  EXPECT_EQ(Taken(limit, "anna", kStart, 100), 20);
  EXPECT_EQ(Taken(limit, "anna", kStart + absl::Seconds(1), 100), 10);
  EXPECT_EQ(Taken(limit, "anna", kStart + absl::Hours(1), 100), 20) << "the bucket holds more than a burst";
  EXPECT_TRUE(absl::IsResourceExhausted(limit.Take("anna", kStart + absl::Hours(1))));
}

TEST(RateLimit, IsPerCaller) {
  RateLimit limit(10);
  EXPECT_EQ(Taken(limit, "anna", kStart, 1000), 20);
  EXPECT_EQ(Taken(limit, "bert", kStart, 1000), 20);
}

TEST(RateLimit, EvictsTheLeastRecentCaller) {
  RateLimit limit(10);
  EXPECT_EQ(Taken(limit, "anna", kStart, 1000), 20);
  for (int i = 0; i < 9'000; ++i) EXPECT_TRUE(limit.Take(absl::StrCat("caller ", i), kStart).ok());
  EXPECT_FALSE(limit.Take("anna", kStart).ok()) << "eviction refilled the bucket";
}

TEST(RateLimit, OfZeroIsUnlimited) {
  RateLimit limit(0);
  EXPECT_EQ(Taken(limit, "anna", kStart, 10'000), 10'000);
}

}  // namespace
}  // namespace phrenic::access
