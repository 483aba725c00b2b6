#include "server/lti/launch.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/lti/example.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;
using testing::HasSubstr;

absl::StatusOr<Launch> ReadExample(const json& claims) {
  return ReadLaunch(claims.dump(), ExamplePlatform(), kExampleNonce, kExampleUrl, kExampleNow);
}

// Returns the status of the example with a claim replaced; null removes it.
absl::Status ReadWith(const std::string& claim, const json& value) {
  json claims = ExampleClaims();
  claims.erase(claim);
  if (!value.is_null()) claims[claim] = value;
  return ReadExample(claims).status();
}

TEST(Launch, HasWhatThePlatformSays) {
  const auto launch = ReadExample(ExampleClaims());
  ASSERT_TRUE(launch.ok()) << launch.status();
  EXPECT_EQ(launch->user, "user-7");
  EXPECT_EQ(launch->lesson, "paralysis");
  EXPECT_EQ(launch->course, "course-1");
  EXPECT_FALSE(launch->teaches || launch->chooses || launch->learners_control);
  EXPECT_EQ(launch->line_item, "https://school.example/items/3?type=1");
  EXPECT_EQ(launch->memberships, "https://school.example/members");
}

TEST(Launch, WithAWrongClaimIsRefusedInWords) {
  const std::string lti = "https://purl.imsglobal.org/spec/lti/claim/";
  const std::tuple<std::string, json, const char*> wrong[] = {
      {"iss", "https://evil.example", "(iss)"},
      {"iss", nullptr, "(iss)"},
      {"aud", "other", "(aud)"},
      {"aud", nullptr, "(aud)"},
      {"aud", json::array(), "(aud)"},
      {"aud", json{"client-1", "other"}, "(azp)"},
      {"azp", "other", "(azp)"},
      {"exp", 1'799'999'000, "(exp)"},
      {"exp", nullptr, "(exp)"},
      {"exp", "soon", "(exp)"},
      {"iat", nullptr, "(iat)"},
      {"iat", 1'800'009'000, "(iat)"},
      {"nonce", "another", "(nonce)"},
      {"nonce", nullptr, "(nonce)"},
      {"sub", nullptr, "(sub)"},
      {"sub", "a b", "(sub)"},
      {"sub", std::string(300, 'a'), "(sub)"},
      {lti + "version", "1.1.0", "(version)"},
      {lti + "deployment_id", "2", "(deployment_id)"},
      {lti + "deployment_id", 1, "(deployment_id)"},
      {lti + "message_type", "LtiStartProctoring", "(message_type)"},
      {lti + "target_link_uri", "https://evil.example/lti/launch", "(target_link_uri)"},
      {lti + "target_link_uri", "https://tool.example.evil.example/", "(target_link_uri)"},
      {lti + "resource_link", json::object(), "(resource_link)"}};
  for (const auto& [claim, value, words] : wrong) {
    EXPECT_THAT(std::string(ReadWith(claim, value).message()), HasSubstr(words)) << claim << " " << value;
  }
}

TEST(Launch, ForSeveralToolsNeedsItsOwnAsTheParty) {
  json claims = ExampleClaims();
  claims["aud"] = {"client-1", "other"};
  claims["azp"] = "client-1";
  EXPECT_TRUE(ReadExample(claims).ok());
}

TEST(Launch, HasServicesOfThePlatformAlone) {
  json claims = ExampleClaims();
  claims[kExampleEndpoint]["lineitem"] = "https://169.254.169.254/latest/meta-data";
  EXPECT_TRUE(absl::IsPermissionDenied(ReadExample(claims).status()));
  claims[kExampleEndpoint]["lineitem"] = "https://school.example@evil.example/";
  EXPECT_TRUE(absl::IsPermissionDenied(ReadExample(claims).status()));
  claims[kExampleEndpoint]["lineitem"] = "http://school.example/items/3";
  EXPECT_TRUE(absl::IsPermissionDenied(ReadExample(claims).status()));
  claims[kExampleEndpoint]["scope"] = json::array();  // the platform takes no scores: nothing is sent
  EXPECT_EQ(ReadExample(claims)->line_item, "");
}

TEST(Launch, TeachesByARoleInTheCourseAlone) {
  const std::string lis = "http://purl.imsglobal.org/vocab/lis/v2/";
  const std::pair<std::string, bool> roles[] = {{lis + "membership#Instructor", true},
                                                {lis + "membership#ContentDeveloper", true},
                                                {lis + "membership/Instructor#TeachingAssistant", true},
                                                {"Instructor", true},
                                                {lis + "membership#Learner", false},
                                                {lis + "institution/person#Instructor", false},
                                                {lis + "system/person#Administrator", false},
                                                {"http://evil.example/membership#Instructor", false}};
  for (const auto& [role, teaches] : roles) {
    json claims = ExampleClaims();
    claims["https://purl.imsglobal.org/spec/lti/claim/roles"] = {role};
    EXPECT_EQ(ReadExample(claims)->teaches, teaches) << role;
  }
}

TEST(Launch, ToChooseALessonIsForTeachersAndReturnsToThePlatform) {
  json claims = ExampleChoiceClaims();
  ASSERT_TRUE(ReadExample(claims).ok()) << ReadExample(claims).status();
  EXPECT_TRUE(ReadExample(claims)->chooses);
  claims[kExampleDeepLinking]["deep_link_return_url"] = "https://evil.example/";
  EXPECT_TRUE(absl::IsPermissionDenied(ReadExample(claims).status()));
  claims = ExampleChoiceClaims();
  claims["https://purl.imsglobal.org/spec/lti/claim/roles"] = json::array();
  EXPECT_TRUE(absl::IsPermissionDenied(ReadExample(claims).status()));
  claims = ExampleChoiceClaims();
  claims[kExampleDeepLinking]["accept_types"] = {"link"};
  EXPECT_TRUE(absl::IsInvalidArgument(ReadExample(claims).status()));
}

TEST(Platform, NamesTheFieldThatIsWrong) {
  const std::pair<const char*, const char*> texts[] = {
      {"", "issuer"},
      {"issuer=https://a.example", "client"},
      {"issuer=https://a.example client=1", "deployment"},
      {"issuer=https://a.example client=1 deployment=1 token=https://a.example keys=https://a.example", "login"},
      {"issuer=https://a.example client=1 deployment=1 login=http://a.example/x", "login"},
      {"issuer=https://a.example client=1 deployment=1 login=https://u@a.example/x", "login"},
      {"issuer=https://a.example issuer=https://b.example", "issuer"},
      {"origin=ftp://a.example", "origin"},
      {"colour=red", "colour"},
      {"client=", "client"}};
  for (const auto& [text, field] : texts) {
    EXPECT_THAT(std::string(ReadPlatform(text).status().message()), testing::StartsWith(field)) << text;
  }
  EXPECT_TRUE(ReadPlatform("issuer=https://a.example client=1 deployment=1 login=http://127.0.0.1:1/ "
                           "token=http://localhost/ keys=http://[::1]/")
                  .ok());
}

TEST(Platform, HasTheOriginsOfItsAddresses) {
  EXPECT_EQ(OriginOf("HTTPS://School.Example:443/a?b#c"), "https://school.example");
  EXPECT_EQ(OriginOf("http://[::1]:8080/"), "http://[::1]:8080");
  for (const char* bad :
       {"", "school.example", "javascript:alert(1)", "file:///etc/passwd", "https://a b/",
        "https://u:p@school.example/", "https://a.example\\@b.example/", "https://a.example\r\nX: y"}) {
    EXPECT_EQ(OriginOf(bad), "") << bad;
  }
  EXPECT_EQ(OriginOf("https://school.example;script-src 'x'/"), "");
}

}  // namespace
}  // namespace phrenic::lti
