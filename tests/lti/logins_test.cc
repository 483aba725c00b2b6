#include "server/lti/logins.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

#include "server/crypto/hmac.h"

namespace phrenic::lti {
namespace {

const absl::Time kStart = absl::FromUnixSeconds(1'800'000'000);
constexpr absl::Duration kLifetime = absl::Minutes(10);

TEST(Logins, AStateTellsItsPlatformUntilItExpires) {
  const Logins logins(kLifetime);
  const std::string state = logins.Begin(3, kStart);
  const auto login = logins.Read(state, kStart + absl::Minutes(9));
  ASSERT_TRUE(login.has_value());
  EXPECT_EQ(login->platform, 3u);
  EXPECT_EQ(login->nonce.size(), 64u);
  EXPECT_EQ(state.find(login->nonce), std::string::npos);
  EXPECT_FALSE(logins.Read(state, kStart + kLifetime).has_value());
}

TEST(Logins, NoChangedStateIsAccepted) {
  const Logins logins(kLifetime);
  const std::string state = logins.Begin(3, kStart);
  for (std::size_t i = 0; i < state.size(); ++i) {
    std::string changed = state;
    changed[i] = changed[i] == '0' ? '1' : '0';
    EXPECT_FALSE(logins.Read(changed, kStart).has_value()) << i;
    EXPECT_FALSE(logins.Read(state.substr(0, i), kStart).has_value()) << i;
  }
  for (const char* bad : {"", "-", "---", "a-b-c-d"}) EXPECT_FALSE(logins.Read(bad, kStart).has_value());
  EXPECT_FALSE(logins.Read(state + std::string(1000, 'a'), kStart).has_value());
  EXPECT_FALSE(Logins(kLifetime).Read(state, kStart).has_value()) << "of another process";
}

TEST(Logins, AStateIsUsedOnceAlsoByTwoThreads) {
  Logins logins(kLifetime);
  for (int i = 0; i < 50; ++i) {
    const std::string state = logins.Begin(0, kStart);
    std::vector<absl::Status> used(2);
    std::thread other([&] { used[1] = logins.Use(state, kStart); });
    used[0] = logins.Use(state, kStart);
    other.join();
    EXPECT_NE(used[0].ok(), used[1].ok());
  }
}

TEST(Logins, ManyLoginsPushOutNone) {
  const Logins logins(kLifetime);
  const std::string first = logins.Begin(1, kStart);
  std::set<std::string> others;
  for (int i = 0; i < 20'000; ++i) others.insert(logins.Begin(0, kStart));
  EXPECT_EQ(others.size(), 20'000u);
  EXPECT_TRUE(logins.Read(first, kStart).has_value());
}

TEST(Logins, UsedOnesAreForgottenWhenTheyHaveExpiredAndNotBefore) {
  Logins logins(kLifetime);
  const std::string first = logins.Begin(0, kStart);
  EXPECT_TRUE(logins.Use(first, kStart).ok());
  for (std::size_t i = 1; i < kMostUsedLogins; ++i) {
    ASSERT_TRUE(logins.Use(std::to_string(i), kStart).ok());
  }
  const absl::Status full = logins.Use("another", kStart + absl::Minutes(1));
  EXPECT_TRUE(absl::IsUnavailable(full)) << full;
  EXPECT_TRUE(absl::IsUnavailable(logins.Use(first, kStart + absl::Minutes(1))));
  EXPECT_TRUE(logins.Use("another", kStart + kLifetime).ok());
}

// Test case 2 of RFC 4231.
TEST(Hmac, IsThatOfTheStandard) {
  EXPECT_EQ(HmacSha256Hex("Jefe", "what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
  EXPECT_NE(HmacSha256Hex("Jefe", "a"), HmacSha256Hex("jefe", "a"));
}

}  // namespace
}  // namespace phrenic::lti
