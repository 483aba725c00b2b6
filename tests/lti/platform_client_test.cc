#include "server/lti/platform_client.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "tests/lti/example.h"

namespace phrenic::lti {
namespace {

using access::HttpAnswer;
using access::HttpRequest;

constexpr char kItem[] = "https://school.example/items/3";

class PlatformClientTest : public testing::Test {
 protected:
  ~PlatformClientTest() override { std::filesystem::remove(file_); }

  // Sends a score to a platform that answers with these statuses.
  absl::Status Send(long token_status, long score_status) {
    PlatformClient client(platform_, *key_, [&](const HttpRequest& request) -> absl::StatusOr<HttpAnswer> {
      if (absl::EndsWith(request.address, "/scores")) return HttpAnswer{score_status, "", ""};
      return HttpAnswer{token_status, R"({"access_token":"t1","expires_in":3600})", ""};
    });
    return client.SendScore(kItem, {});
  }

  const std::string file_ = absl::StrCat(testing::TempDir(), "/phrenic-lti-client-", getpid());
  const Platform platform_ = ExamplePlatform();
  const std::unique_ptr<ToolKey> key_ = *ToolKey::Open(file_);
};

TEST_F(PlatformClientTest, GivesNoScoreUpWhileItHasNoToken) {
  EXPECT_TRUE(Send(200, 201).ok());
  for (const long status : {400, 401, 403, 404, 422, 429, 500}) {
    EXPECT_TRUE(absl::IsUnavailable(Send(status, 200))) << status;
  }
}

TEST_F(PlatformClientTest, GivesAScoreUpOnlyIfItIsRefusedItself) {
  for (const long status : {400, 404, 422}) EXPECT_TRUE(absl::IsInvalidArgument(Send(200, status))) << status;
  for (const long status : {302, 401, 403, 408, 429, 500, 503}) {
    EXPECT_TRUE(absl::IsUnavailable(Send(200, status))) << status;
  }
}

TEST_F(PlatformClientTest, KeepsTheMembersOfThePagesBeforeOneThatFails) {
  const auto answer = [](const HttpRequest& request) -> absl::StatusOr<HttpAnswer> {
    if (request.post) return HttpAnswer{200, R"({"access_token":"t1","expires_in":3600})", ""};
    if (absl::EndsWith(request.address, "/1")) {
      return HttpAnswer{200, R"({"members":[{"user_id":"a","name":"Anna"}]})",
                        R"(<https://school.example/x,y>; rel="prev", <https://school.example/2,5>; rel="next")"};
    }
    if (absl::EndsWith(request.address, "/2,5")) {
      return HttpAnswer{200, R"({"members":[{"user_id":"b","name":"Bo"}]})", R"(<https://school.example/3>; rel=next)"};
    }
    return HttpAnswer{503, "", ""};
  };
  PlatformClient client(platform_, *key_, answer);
  const auto all = client.Members("https://school.example/1");
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_THAT(*all, testing::ElementsAre(testing::Pair("a", "Anna"), testing::Pair("b", "Bo")));
  EXPECT_EQ(client.Members("https://school.example/1", absl::InfinitePast())->size(), 1U);
  EXPECT_TRUE(absl::IsUnavailable(client.Members("https://school.example/3").status()));
}

}  // namespace
}  // namespace phrenic::lti
