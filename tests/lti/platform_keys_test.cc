#include "server/lti/platform_keys.h"

#include <gmock/gmock.h>

#include "tests/access/provider.h"
#include "tests/lti/example.h"

namespace phrenic::lti {
namespace {

TEST(PlatformKeys, OfAnEarlierFetchAreUsedForADayWhileNoneSucceeds) {
  access::Provider provider;
  const std::string token = provider.Sign({{"sub", "7"}});
  const std::string set = nlohmann::json{{"keys", {provider.PublicKey()}}}.dump();
  bool away = false;
  int fetches = 0;
  PlatformKeys keys("https://school.example/keys", [&](const std::string&) -> absl::StatusOr<std::string> {
    ++fetches;
    return away ? absl::StatusOr<std::string>(absl::UnavailableError("away")) : set;
  });
  EXPECT_TRUE(keys.Verified(token, kExampleNow).ok());
  away = true;
  EXPECT_TRUE(keys.Verified(token, kExampleNow + absl::Hours(2)).ok());
  EXPECT_EQ(fetches, 2);
  EXPECT_TRUE(keys.Verified(token, kExampleNow + absl::Hours(2) + absl::Seconds(9)).ok());
  EXPECT_EQ(fetches, 2);
  EXPECT_TRUE(keys.Verified(token, kExampleNow + absl::Hours(2) + absl::Seconds(11)).ok());
  EXPECT_EQ(fetches, 3);  // tried again soon, not an hour later
  EXPECT_TRUE(absl::IsUnavailable(keys.Verified(token, kExampleNow + absl::Hours(24)).status()));
  away = false;
  EXPECT_TRUE(keys.Verified(token, kExampleNow + absl::Hours(25)).ok());
}

}  // namespace
}  // namespace phrenic::lti
