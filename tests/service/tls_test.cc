#include "server/service/net/tls.h"

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>

#include <cstdio>
#include <fstream>

#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"
#include "tests/service/certificates.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

class Tls : public testing::Test {
 protected:
  Tls() {
    certificates_.Sign("server");
    options_.listen = options_.web = "127.0.0.1:0";
    options_.tls = {certificates_.File("server"), certificates_.Key("server"), ""};
  }
  void Start() {
    auto server = Server::Start(options_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
  }
  // Returns the status of a call with these credentials.
  grpc::Status CallWith(const std::shared_ptr<grpc::ChannelCredentials>& credentials) const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    const auto channel =
        grpc::CreateCustomChannel("127.0.0.1:" + std::to_string(server_->port()), credentials, arguments);
    const auto stub = v1::SessionService::NewStub(channel);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    v1::ListSessionsResponse response;
    return stub->ListSessions(&context, {}, &response);
  }
  // Returns credentials of a client that trusts a CA and, if `name` is set, has a certificate.
  std::shared_ptr<grpc::ChannelCredentials> Trusting(const std::string& authority, const std::string& own = "") const {
    grpc::SslCredentialsOptions options;
    options.pem_root_certs = Certificates::Read(certificates_.File(authority));
    if (!own.empty()) {
      options.pem_private_key = Certificates::Read(certificates_.Key(own));
      options.pem_cert_chain = Certificates::Read(certificates_.File(own));
    }
    return grpc::SslCredentials(options);
  }
  // Returns curl's HTTP status from the web port; "000" if the connection fails.
  std::string Curl(const std::string& words, const std::string& scheme = "https") const {
    const std::string command = "curl -s -m 10 -o /dev/null -w '%{http_code}' " + words + " " + scheme +
                                "://127.0.0.1:" + std::to_string(server_->web_port()) + "/healthz 2>/dev/null";
    FILE* pipe = popen(command.c_str(), "r");
    char code[16] = "";
    EXPECT_NE(std::fgets(code, sizeof code, pipe), nullptr);
    pclose(pipe);
    return code;
  }

  Certificates certificates_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
};

TEST_F(Tls, OnlyClientsThatTrustTheCaConnect) {
  Start();
  const grpc::Status trusted = CallWith(Trusting("good"));
  EXPECT_TRUE(trusted.ok()) << trusted.error_message();
  EXPECT_EQ(CallWith(Trusting("evil")).error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(CallWith(grpc::InsecureChannelCredentials()).error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(Curl("--cacert " + certificates_.File("good")), "200");
  EXPECT_EQ(Curl("--cacert " + certificates_.File("evil")), "000");
  EXPECT_EQ(Curl("--tls-max 1.1 --cacert " + certificates_.File("good")), "000");
}

TEST_F(Tls, WithAClientCaEveryClientNeedsItsCertificate) {
  options_.tls.client_ca = certificates_.File("good");
  certificates_.Sign("client");
  certificates_.Sign("forged", "evil");
  Start();
  const grpc::Status known = CallWith(Trusting("good", "client"));
  EXPECT_TRUE(known.ok()) << known.error_message();
  EXPECT_EQ(CallWith(Trusting("good")).error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(CallWith(Trusting("good", "forged")).error_code(), grpc::UNAVAILABLE);
  const std::string trust = "--cacert " + certificates_.File("good");
  const auto as = [&](const std::string& name) {
    return trust + " --cert " + certificates_.File(name) + " --key " + certificates_.Key(name);
  };
  EXPECT_EQ(Curl(as("client")), "200");
  EXPECT_EQ(Curl(trust), "000");
  EXPECT_EQ(Curl(as("forged")), "000");
}

TEST_F(Tls, RenewedCertificatesAreUsedWithoutARestart) {
  Start();
  ASSERT_EQ(Curl("--cacert " + certificates_.File("good")), "200");
  certificates_.Sign("server", "evil");
  std::string code;
  grpc::StatusCode call = grpc::UNAVAILABLE;
  for (int i = 0; i < 60 && (code != "200" || call != grpc::OK); ++i) {
    usleep(500'000);
    code = Curl("--cacert " + certificates_.File("evil"));
    call = CallWith(Trusting("evil")).error_code();
  }
  EXPECT_EQ(code, "200");
  EXPECT_EQ(call, grpc::OK);
  EXPECT_EQ(CallWith(Trusting("good")).error_code(), grpc::UNAVAILABLE);
}

// The files can go bad between the start and the first connection.
TEST_F(Tls, WithoutUsableCertificatesTheWebPortAnswersNothing) {
  Start();
  std::ofstream(options_.tls.certificate) << "no certificate";
  EXPECT_EQ(Curl("--insecure"), "000");
  EXPECT_EQ(Curl("", "http"), "000") << "it was served in the clear";
}

TEST_F(Tls, BadFilesAreNamedWithTheirFlag) {
  certificates_.Sign("another");
  const std::string good = certificates_.File("server"), key = certificates_.Key("server");
  const struct {
    TlsFiles files;
    const char* words;
  } cases[] = {{{"", key, ""}, "--tls-cert: required with"},
               {{good, "", ""}, "--tls-key: required with"},
               {{"/nowhere", key, ""}, "--tls-cert: no such file: /nowhere"},
               {{key, key, ""}, "--tls-cert"},
               {{good, certificates_.Key("another"), ""}, "is not the private key of the certificate"},
               {{good, key, key}, "--tls-client-ca"}};
  for (const auto& one : cases) {
    options_.tls = one.files;
    EXPECT_THAT(std::string(Server::Start(options_).status().message()), HasSubstr(one.words));
  }
}

}  // namespace
}  // namespace phrenic::service
