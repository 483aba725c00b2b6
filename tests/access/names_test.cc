// Accounts of the token file and of the identity provider have names of their own kinds, and no name or id can write a
// line of the audit log.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/access/accounts.h"
#include "server/access/audit.h"
#include "tests/access/provider.h"

namespace phrenic::access {
namespace {

using nlohmann::json;

class Names : public testing::Test {
 protected:
  Names() {
    options_.tokens_file = absl::StrCat(testing::TempDir(), "/phrenic-names-tokens-", getpid());
    options_.jwt.keys = absl::StrCat(testing::TempDir(), "/phrenic-names-keys-", getpid());
    options_.jwt.issuer = "https://id.example.org";
    options_.jwt.audience = "phrenic";
    std::ofstream(options_.jwt.keys) << json{{"keys", {provider_.PublicKey()}}};
    token_ = *AddToken(options_.tokens_file, {"anna", v1::ACCESS_ROLE_VIEWER});
  }
  ~Names() override {
    unlink(options_.tokens_file.c_str());
    unlink(options_.jwt.keys.c_str());
  }

  Provider provider_;
  AccountOptions options_;
  std::string token_;
};

TEST_F(Names, TheSameWordIsTwoAccounts) {
  const auto accounts = Accounts::Open(options_);
  ASSERT_TRUE(accounts.ok()) << accounts.status();
  const std::string signed_token = provider_.Sign({{"iss", "https://id.example.org"},
                                                   {"aud", "phrenic"},
                                                   {"sub", "anna"},
                                                   {"phrenic_role", "owner"},
                                                   {"exp", absl::ToUnixSeconds(absl::Now()) + 100}});
  const auto of_file = (*accounts)->Check(token_), of_provider = (*accounts)->Check(signed_token);
  ASSERT_TRUE(of_file.ok()) << of_file.status();
  ASSERT_TRUE(of_provider.ok()) << of_provider.status();
  EXPECT_EQ(of_file->name, "anna");
  EXPECT_EQ(of_provider->name, "jwt:https://id.example.org#anna");
  EXPECT_FALSE(AddToken(options_.tokens_file, {of_provider->name, v1::ACCESS_ROLE_VIEWER}).ok());
}

TEST_F(Names, AnEarlierVersionsNameBelongsToTheKindThatHasIt) {
  const auto accounts = *Accounts::Open(options_);
  EXPECT_EQ(accounts->Qualified("anna"), "anna");
  EXPECT_EQ(accounts->Qualified("ben"), "jwt:https://id.example.org#ben");
  EXPECT_EQ(accounts->Qualified(""), "");
  options_.jwt = {};
  EXPECT_EQ((*Accounts::Open(options_))->Qualified("ben"), "ben") << "there is no provider";
}

TEST(Audit, ALineIsOneLineOfAsciiOfBoundedLength) {
  const std::string file = absl::StrCat(testing::TempDir(), "/phrenic-audit-line-", getpid());
  std::filesystem::remove(file);
  {
    const auto audit = *AuditLog::Open(file);
    Caller caller{.account = {"jwt:i#a\nb\u2028c\x1b[2J"}, .links = {}, .peer = std::string(100'000, 'p')};
    audit->Note(caller, "SessionService.GetSession", "x\r\n{\"caller\":\"root\"}" + std::string(1'000'000, 's'),
                absl::NotFoundError("none"));
  }
  std::ifstream in(file);
  std::string line, more;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_FALSE(std::getline(in, more)) << more;
  EXPECT_LT(line.size(), 2000U);
  for (const char c : line) EXPECT_TRUE(c >= ' ' && c < '\x7f') << static_cast<int>(c);
  EXPECT_EQ(json::parse(line)["session"].get<std::string>().substr(0, 3), "x\r\n");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace phrenic::access
