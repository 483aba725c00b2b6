#include "server/access/jwt.h"

#include <cjose/cjose.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "tests/access/provider.h"

namespace phrenic::access {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const absl::Time kNow = absl::FromUnixSeconds(1'800'000'000);

class Jwt : public testing::Test {
 protected:
  Jwt() {
    options_.keys = absl::StrCat(testing::TempDir(), "/phrenic-keys-", getpid(), ".json");
    options_.issuer = "https://id.example.org";
    options_.audience = "phrenic";
    std::ofstream(options_.keys) << json{{"keys", {provider_.PublicKey()}}};
    keys_ = *JwtKeys::Read(options_);
  }
  ~Jwt() override { unlink(options_.keys.c_str()); }

  static json Claims() {
    return {{"iss", "https://id.example.org"}, {"aud", {"other", "phrenic"}}, {"sub", "anna"},
            {"phrenic_role", "controller"},    {"exp", 1'800'000'600},        {"nbf", 1'799'999'000}};
  }
  // Checks a token of Claims() with one claim changed or removed.
  absl::Status With(const char* claim, const json& value) {
    json claims = Claims();
    claims.erase(claim);
    if (!value.is_null()) claims[claim] = value;
    return keys_->Check(provider_.Sign(claims), kNow).status();
  }

  Provider provider_;
  JwtOptions options_;
  std::shared_ptr<const JwtKeys> keys_;
};

TEST_F(Jwt, OfTheProviderIsAnAccount) {
  const auto account = keys_->Check(provider_.Sign(Claims()), kNow);
  ASSERT_TRUE(account.ok()) << account.status();
  EXPECT_EQ(account->name, "jwt:https://id.example.org#anna");
  EXPECT_EQ(account->role, v1::ACCESS_ROLE_CONTROLLER);
  EXPECT_TRUE(With("phrenic_role", json{"staff", "admin"}).ok());
}

TEST_F(Jwt, WithAWrongClaimIsRefused) {
  for (const auto& [claim, value] : {std::pair<const char*, json>("iss", "https://evil.example.org"),
                                     {"iss", nullptr},
                                     {"aud", "other"},
                                     {"aud", nullptr},
                                     {"exp", 1'799'999'000},
                                     {"exp", nullptr},
                                     {"exp", "soon"},
                                     {"exp", "1800000600"},
                                     {"exp", true},
                                     {"exp", 1e300},
                                     {"exp", -1},
                                     {"nbf", "1799999000"},
                                     {"nbf", json::array({1'799'999'000})},
                                     {"nbf", 1e300},
                                     {"iat", "now"},
                                     {"iat", json::object()},
                                     {"sub", "an\nna"},
                                     {"sub", std::string("an\0na", 5)},
                                     {"sub", "\u001b[31manna"},
                                     {"sub", "an\u0085na"},
                                     {"sub", "an\u2028na"},
                                     {"sub", "an\u202Ena"},
                                     {"sub", "\uFEFFanna"},
                                     {"sub", " anna"},
                                     {"sub", ""},
                                     {"sub", std::string(256, 'a')},
                                     {"nbf", 1'800'000'900},
                                     {"sub", nullptr},
                                     {"sub", 7},
                                     {"phrenic_role", "king"},
                                     {"phrenic_role", nullptr}}) {
    EXPECT_TRUE(absl::IsUnauthenticated(With(claim, value))) << claim << " " << value;
  }
}

TEST_F(Jwt, NamesOfPeopleAreAccepted) {
  for (const char* name :
       {"Zo\u00eb \u0141ukasiewicz", "auth0|5f7c8ec7c33c6c004bbafe82", "\u5c71\u7530", "a@b.org", "x"}) {
    EXPECT_TRUE(With("sub", name).ok()) << name;
  }
  EXPECT_TRUE(With("iat", 1'799'999'999.5).ok());
}

// RFC 7515 section 4.1.11: a token with an extension that the recipient does not understand is not valid.
TEST_F(Jwt, WithACriticalExtensionIsRefused) {
  for (const json& crit : {json::array({"exp"}), json::array({"b64"}), json::array(), json("exp"), json(nullptr)}) {
    const std::string header = json{{"alg", "RS256"}, {"crit", crit}, {"exp", 1}}.dump();
    EXPECT_THAT(std::string(CheckJwtHeader(header).message()), HasSubstr("(crit)")) << header;
  }
  const std::string token = provider_.Sign(Claims(), {{"crit", "exp"}});
  EXPECT_THAT(std::string(keys_->Check(token, kNow).status().message()), HasSubstr("(crit)"));
}

TEST_F(Jwt, WithAnotherKeyOrModifiedIsRefused) {
  Provider other;
  EXPECT_THAT(std::string(keys_->Check(other.Sign(Claims()), kNow).status().message()),
              HasSubstr("is not signed by a key of the identity provider"));
  const std::string token = provider_.Sign(Claims());
  for (std::size_t i = 0; i < token.size(); i += 7) {
    std::string changed = token;
    changed[i] = changed[i] == 'x' ? 'y' : 'x';
    EXPECT_FALSE(keys_->Check(changed, kNow).ok()) << i;
  }
  for (std::size_t cut = 0; cut < token.size(); cut += 13) EXPECT_FALSE(keys_->Check(token.substr(0, cut), kNow).ok());
}

// Two known attacks: "alg": "none", and an HMAC with the public key as the secret (RFC 8725 section 2.1).
TEST_F(Jwt, UnsignedOrSignedWithThePublicKeyIsRefused) {
  std::string payload, header;
  absl::WebSafeBase64Escape(Claims().dump(), &payload);
  absl::WebSafeBase64Escape(R"({"alg":"none"})", &header);
  EXPECT_TRUE(absl::IsUnauthenticated(keys_->Check(absl::StrCat(header, ".", payload, "."), kNow).status()));
  const std::string secret = provider_.PublicKey().dump();
  cjose_err error;
  cjose_jwk_t* shared =
      cjose_jwk_create_oct_spec(reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size(), &error);
  const std::string token = Provider::SignWith(shared, "HS256", Claims());
  cjose_jwk_release(shared);
  EXPECT_THAT(std::string(keys_->Check(token, kNow).status().message()),
              HasSubstr("not signed with an RS, PS or ES algorithm"));
}

// cjose 0.6 ends the process at some texts that are not base64url, such as "a=.$x:b.c.drun.e".
TEST_F(Jwt, TextsThatAreNoBase64AreRefused) {
  for (const char* token : {"A.A.A", "A", "..", "A..", "e30.e30.A", "a=.b.c", "a=.$x:b.c.drun.e", "$.$.$",
                            "e30.e30.e30.e30.e", "\xff.\xff.\xff"}) {
    EXPECT_TRUE(absl::IsUnauthenticated(keys_->Check(token, kNow).status())) << token;
  }
}

TEST_F(Jwt, BadKeysAreAnErrorThatNamesTheFile) {
  std::ofstream(options_.keys) << "{\"keys\": [{\"kty\": \"oct\", \"k\": \"c2VjcmV0\"}]}";
  EXPECT_THAT(std::string(JwtKeys::Read(options_).status().message()), HasSubstr("has no RSA or EC key"));
  std::ofstream(options_.keys) << "nonsense";
  EXPECT_THAT(std::string(JwtKeys::Read(options_).status().message()), HasSubstr("is not a JSON Web Key Set"));
  options_.audience.clear();
  EXPECT_THAT(std::string(JwtKeys::Read(options_).status().message()), HasSubstr("--jwt-audience"));
}

}  // namespace
}  // namespace phrenic::access
