// An identity provider's keys, fetched from its address.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "absl/time/clock.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/access/fetch.h"
#include "tests/access/provider.h"
#include "tests/support/server_process.h"

namespace phrenic::service {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// One server publishes the provider's documents, another one fetches them.
class KeysByAddress : public testing::Test {
 protected:
  KeysByAddress() {
    std::filesystem::create_directories(folder_ + "/.well-known");
    Publish("keys.json", {{"keys", {provider_.PublicKey()}}});
  }
  ~KeysByAddress() override {
    site_.Kill();
    server_.reset();
    std::filesystem::remove_all(folder_);
  }
  void SetUp() override {
    const absl::Status status = site_.Start();
    ASSERT_TRUE(status.ok()) << status;
  }
  void Publish(const std::string& name, const json& document) const { std::ofstream(folder_ + "/" + name) << document; }
  std::string At(const std::string& name) const { return "http://" + site_.web_address() + "/" + name; }
  absl::Status Start(const std::string& keys) {
    server_ = std::make_unique<ServerProcess>(
        folder_ + "/server", std::vector<std::string>{"--store", "none", "--jwt-keys", keys, "--jwt-issuer",
                                                      "https://id", "--jwt-audience", "phrenic"});
    return server_->Start();
  }
  grpc::StatusCode ListAs(access::Provider& provider) const {
    const json claims = {{"iss", "https://id"},
                         {"aud", "phrenic"},
                         {"sub", "anna"},
                         {"phrenic_role", "viewer"},
                         {"exp", absl::ToUnixSeconds(absl::Now() + absl::Minutes(5))}};
    grpc::ClientContext context;
    context.AddMetadata("authorization", "Bearer " + provider.Sign(claims));
    v1::ListSessionsResponse response;
    return v1::SessionService::NewStub(server_->NewChannel())->ListSessions(&context, {}, &response).error_code();
  }

  const std::string folder_ = testing::TempDir() + "/phrenic-keys-" + std::to_string(getpid());
  access::Provider provider_;
  ServerProcess site_{folder_ + "/site", {"--store", "none", "--web-root", folder_}};
  std::unique_ptr<ServerProcess> server_;
};

TEST_F(KeysByAddress, AdmitCallersWithTokensOfTheProvider) {
  const absl::Status started = Start(At("keys.json"));
  ASSERT_TRUE(started.ok()) << started;
  access::Provider other;
  EXPECT_EQ(ListAs(provider_), grpc::OK);
  EXPECT_EQ(ListAs(other), grpc::UNAUTHENTICATED);
  site_.Kill();
  EXPECT_EQ(ListAs(provider_), grpc::OK) << "the provider is asked at every call";
}

TEST_F(KeysByAddress, AreFoundByTheOpenIdConfiguration) {
  Publish("configuration.json", {{"issuer", "https://id"}, {"jwks_uri", At("keys.json")}});
  const absl::Status started = Start(At("configuration.json"));
  ASSERT_TRUE(started.ok()) << started;
  EXPECT_EQ(ListAs(provider_), grpc::OK);
}

TEST_F(KeysByAddress, ThatCannotBeReadPreventTheStartWithTheReason) {
  EXPECT_THAT(std::string(Start(At("other.json")).message()), HasSubstr("other.json: returns HTTP status 404"));
  Publish("none.json", {{"keys", 3}});
  EXPECT_THAT(std::string(Start(At("none.json")).message()), HasSubstr("none.json is not a JSON Web Key Set"));
  EXPECT_THAT(std::string(Start("http://id.example.org/keys").message()), HasSubstr("use https://"));
  EXPECT_THAT(std::string(Start("https://127.0.0.1:1/keys").message()),
              HasSubstr("https://127.0.0.1:1/keys: cannot be"));
  Publish("loop.json", {{"jwks_uri", At("loop.json")}});
  EXPECT_THAT(std::string(Start(At("loop.json")).message()), HasSubstr("loop.json is not a JSON Web Key Set"));
  Publish("elsewhere.json", {{"jwks_uri", "/etc/passwd"}});
  EXPECT_THAT(std::string(Start(At("elsewhere.json")).message()), HasSubstr("is not a JSON Web Key Set"));
}

TEST_F(KeysByAddress, AreLimitedInSize) {
  std::ofstream(folder_ + "/endless.json") << std::string(2 << 20, ' ');
  EXPECT_TRUE(absl::IsUnavailable(access::Fetch(At("endless.json")).status()));
}

}  // namespace
}  // namespace phrenic::service
