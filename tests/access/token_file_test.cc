#include "server/access/token_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"

namespace phrenic::access {
namespace {

using testing::HasSubstr;

class TokenFile : public testing::Test {
 protected:
  TokenFile() : file_(absl::StrCat(testing::TempDir(), "/phrenic-tokens-", getpid())) {
    std::filesystem::remove(file_);
  }
  ~TokenFile() override { std::filesystem::remove(file_); }
  const std::string file_;
};

TEST_F(TokenFile, ContainsHashesAndNoToken) {
  const auto token = AddToken(file_, {"anna", v1::ACCESS_ROLE_VIEWER});
  ASSERT_TRUE(token.ok()) << token.status();
  EXPECT_EQ(token->size(), 32u) << "128 bits";
  std::ifstream in(file_);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  EXPECT_EQ(text.find(*token), std::string::npos);
  const auto tokens = ReadTokens(file_);
  ASSERT_TRUE(tokens.ok());
  ASSERT_TRUE(tokens->contains(Sha256Hex(*token)));
  EXPECT_EQ(tokens->at(Sha256Hex(*token)).name, "anna");
  EXPECT_EQ(tokens->at(Sha256Hex(*token)).role, v1::ACCESS_ROLE_VIEWER);
  struct stat found {};
  ASSERT_EQ(stat(file_.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600u);
}

TEST_F(TokenFile, LosesOnlyTheRemovedAccount) {
  ASSERT_TRUE(AddToken(file_, {"anna", v1::ACCESS_ROLE_OWNER}).ok());
  ASSERT_TRUE(AddToken(file_, {"bert@example.org", v1::ACCESS_ROLE_ADMIN}).ok());
  EXPECT_TRUE(absl::IsAlreadyExists(AddToken(file_, {"anna", v1::ACCESS_ROLE_ADMIN}).status()));
  ASSERT_TRUE(RemoveToken(file_, "anna").ok());
  EXPECT_TRUE(absl::IsNotFound(RemoveToken(file_, "anna")));
  const auto tokens = ReadTokens(file_);
  ASSERT_EQ(tokens->size(), 1u);
  EXPECT_EQ(tokens->begin()->second.name, "bert@example.org");
}

TEST_F(TokenFile, IsRefusedWithLineAndReason) {
  const std::string hash(64, 'a');
  const struct {
    std::string text, words;
  } cases[] = {{"\nnonsense\n", "f:2: a line must be SHA256 ROLE NAME"},
               {hash + " king anna\n", "f:1: there is no role \"king\""},
               {hash + " viewer a/b\n", "f:1: a name must have"},
               {hash + " viewer anna\n" + hash + " viewer bert\n", "f:2: the token is listed twice"}};
  for (const auto& one : cases) {
    const auto parsed = ParseTokens("f", one.text);
    EXPECT_TRUE(absl::IsInvalidArgument(parsed.status())) << one.text;
    EXPECT_THAT(std::string(parsed.status().message()), HasSubstr(one.words));
  }
  EXPECT_TRUE(ParseTokens("f", "# nobody\n\n").ok());
  EXPECT_TRUE(absl::IsNotFound(ReadTokens(testing::TempDir()).status())) << "a folder";
  EXPECT_TRUE(absl::IsInvalidArgument(AddToken(file_, {"two words", v1::ACCESS_ROLE_VIEWER}).status()));
}

}  // namespace
}  // namespace phrenic::access
