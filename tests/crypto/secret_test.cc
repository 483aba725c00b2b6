#include "server/crypto/secret.h"

#include <gtest/gtest.h>

#include <set>

namespace phrenic {
namespace {

TEST(Token, HasAHundredAndTwentyEightBitsAndIsNeverRepeated) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) tokens.insert(NewToken());
  EXPECT_EQ(tokens.size(), 1000u);
  for (const std::string& token : tokens) EXPECT_EQ(token.size(), 32u);
}

TEST(Token, EqualsOnlyItself) {
  const std::string token = NewToken();
  EXPECT_TRUE(SameToken(token, std::string(token)));
  EXPECT_FALSE(SameToken(token, token.substr(1)));
  EXPECT_FALSE(SameToken("", "")) << "an empty token matches nobody";
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = other[i] == '0' ? '1' : '0';
    EXPECT_FALSE(SameToken(token, other));
  }
}

}  // namespace
}  // namespace phrenic
