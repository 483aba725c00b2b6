// One greedy caller beside a modest one, for everything that callers share.
#include "server/service/calls/fair_share.h"

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <thread>

#include "phrenic/v1/access.grpc.pb.h"
#include "phrenic/v1/compare.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/access/token_file.h"
#include "server/service/calls/turn.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FairShare, OneCallerLeavesRoomForOthers) {
  FairShare share({"things", "--max-things", 4, 3});
  std::vector<FairShare::Hold> held;
  for (int i = 0; i < 3; ++i) held.push_back(*share.Take("greedy"));
  const auto refused = share.Take("greedy");
  EXPECT_TRUE(absl::IsResourceExhausted(refused.status()));
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("--max-things"));
  held.push_back(*share.Take("modest"));
  EXPECT_FALSE(share.Take("third").ok()) << "all places are taken";
  held.clear();
  EXPECT_TRUE(share.Take("third").ok());
}

TEST(FairShare, ThisProcessHasNoLimitOfItsOwn) {
  FairShare share({"things", "--max-things", 4, 1});
  std::vector<FairShare::Hold> held;
  for (int i = 0; i < 4; ++i) held.push_back(*share.Take(""));
}

TEST(FairShare, CallersThatWaitGetPlacesInTurn) {
  FairShare share({"things", "--max-things", 1, 1, 8});
  std::vector<std::string> got;
  FairShare::Hold last;
  const auto enter = [&](const std::string& caller) {
    return share.Enter(caller, [&got, &last, caller](FairShare::Hold hold) {
      got.push_back(caller);
      last = std::move(hold);
    });
  };
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(enter("greedy").ok());
  ASSERT_TRUE(enter("modest").ok());
  for (int i = 0; i < 5; ++i) {
    const FairShare::Hold released = std::move(last);
    last = nullptr;
  }
  EXPECT_THAT(got, ElementsAre("greedy", "greedy", "modest", "greedy", "greedy"));
}

TEST(FairShare, ReadsOfLargeModelsAreTwoAtATimeAndOneOfACaller) {
  FairShare share(LargeReads());
  auto first = AwaitTurn(share, "greedy");
  ASSERT_TRUE(first.ok());
  std::atomic<bool> again = false;
  std::thread waits([&] { again = AwaitTurn(share, "greedy").ok(); });
  EXPECT_TRUE(AwaitTurn(share, "modest").ok()) << "it waits behind the greedy one";
  absl::SleepFor(absl::Milliseconds(50));
  EXPECT_FALSE(again);
  first->reset();
  waits.join();
  EXPECT_TRUE(again);
}

TEST(FairShare, WhoHasGoneIsPassedOver) {
  FairShare share({"things", "--max-things", 1, 1, 8});
  int granted = 0;
  FairShare::Hold held = *share.Take("a");
  const auto ticket = share.Enter("b", [&](const FairShare::Hold&) { ++granted; });
  ASSERT_TRUE(ticket.ok());
  EXPECT_TRUE(share.Withdraw("b", *ticket));
  EXPECT_FALSE(share.Withdraw("b", *ticket));
  held = nullptr;
  EXPECT_EQ(granted, 0);
}

TEST(FairShare, AFullQueueRefusesItsCallerOnly) {
  FairShare share({"things", "--max-things", 1, 1, 1});
  const FairShare::Hold held = *share.Take("greedy");
  const auto nothing = [](const FairShare::Hold&) {};
  EXPECT_TRUE(share.Enter("greedy", nothing).ok());
  const auto refused = share.Enter("greedy", nothing);
  EXPECT_TRUE(absl::IsResourceExhausted(refused.status()));
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("--max-things"));
  EXPECT_TRUE(share.Enter("modest", nothing).ok());
}

// A server with two accounts.
class TwoAccounts : public ServerFixture {
 protected:
  TwoAccounts() {
    options_.accounts.tokens_file = absl::StrCat(testing::TempDir(), "/phrenic-two-", getpid());
    std::filesystem::remove(options_.accounts.tokens_file);
    options_.limits.viewers = 4;
    options_.limits.exports = 2;
    options_.limits.kept_exports = 4;
    options_.limits.sessions_of_user = 3;
    for (const char* name : {"greedy", "modest"}) {
      tokens_[name] = *access::AddToken(options_.accounts.tokens_file, {name, v1::ACCESS_ROLE_OWNER});
    }
  }
  ~TwoAccounts() override { std::filesystem::remove(options_.accounts.tokens_file); }
  void SetUp() override {
    ServerFixture::SetUp();
    for (const auto& [name, token] : tokens_) ASSERT_TRUE(Create(name, name).ok());
  }
  void TearDown() override {
    for (const auto& context : held_) context->TryCancel();
    ends_.clear();
  }
  grpc::ClientContext& Context(const std::string& account) {
    auto& context = *held_.emplace_back(std::make_unique<grpc::ClientContext>());
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(120));
    context.AddMetadata("authorization", "Bearer " + tokens_.at(account));
    return context;
  }
  grpc::Status Create(const std::string& account, const std::string& id) {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    request.mutable_source()->set_name("cube-springs");
    v1::CreateSessionResponse response;
    return sessions_->CreateSession(&Context(account), request, &response);
  }
  // Keeps a stream that has sent a message, and reads no more of it; returns the status of one that has ended.
  template <class Stub, class Request, class Response>
  grpc::Status Keep(std::unique_ptr<Stub> stub,
                    std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(grpc::ClientContext*, const Request&),
                    const std::string& account, const Request& request) {
    const std::shared_ptr<Stub> shared = std::move(stub);
    const std::shared_ptr<grpc::ClientReader<Response>> reader = (shared.get()->*method)(&Context(account), request);
    Response response;
    if (!reader->Read(&response)) return reader->Finish();
    ends_.emplace_back(nullptr, [shared, reader](void*) {
      Response rest;
      while (reader->Read(&rest)) continue;
      reader->Finish();
    });
    return grpc::Status::OK;
  }

  std::map<std::string, std::string> tokens_;
  std::vector<std::unique_ptr<grpc::ClientContext>> held_;
  std::vector<std::shared_ptr<void>> ends_;
};

TEST_F(TwoAccounts, ShareSessions) {
  grpc::Status status;
  for (int i = 0; i < 6 && status.ok(); ++i) status = Create("greedy", absl::StrCat("more-", i));
  EXPECT_THAT(status.error_message(), HasSubstr("--max-sessions-of-user"));
  EXPECT_TRUE(Create("modest", "mine").ok());
}

TEST_F(TwoAccounts, ShareStudies) {
  const auto studies = v1::StudyService::NewStub(channel_);
  const auto add = [&](const std::string& account) {
    v1::CreateStudyRequest request;
    request.mutable_source()->set_name("sheet-2d");
    request.mutable_error()->set_seconds(120);
    request.mutable_error()->set_levels(16);
    v1::CreateStudyResponse response;
    return studies->CreateStudy(&Context(account), request, &response);
  };
  grpc::Status status;
  for (int i = 0; i < 16 && status.ok(); ++i) status = add("greedy");
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  EXPECT_TRUE(add("modest").ok());
}

TEST_F(TwoAccounts, ShareExports) {
  const auto add = [&](const std::string& account) {
    v1::CreateExportRequest request;
    request.set_session_id(account);
    request.set_format("msh");
    request.set_seconds(3600);
    request.set_frames_per_second(1000);
    v1::CreateExportResponse response;
    return exports_->CreateExport(&Context(account), request, &response);
  };
  grpc::Status status;
  for (int i = 0; i < 4 && status.ok(); ++i) status = add("greedy");
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  ASSERT_TRUE(add("modest").ok());
  v1::WatchExportRequest watch;
  watch.set_export_id("modest");
  const auto reader = exports_->WatchExport(&Context("modest"), watch);
  v1::WatchExportResponse seen;
  while (seen.job().state() != v1::EXPORT_STATE_RUNNING && reader->Read(&seen)) continue;
  EXPECT_EQ(seen.job().state(), v1::EXPORT_STATE_RUNNING) << "the greedy one's run first";
  held_.back()->TryCancel();
}

// Surfaces whose map of distances does not fit into the window of a client that does not read.
TEST_F(TwoAccounts, ShareComparisons) {
  std::string grid;
  constexpr int kSide = 200;
  for (int i = 0; i < kSide * kSide; ++i) absl::StrAppend(&grid, "v ", i % kSide, " ", i / kSide, " ", i % 7, "\n");
  for (int i = 1; i < kSide * (kSide - 1); ++i) absl::StrAppend(&grid, "f ", i, " ", i + 1, " ", i + kSide, "\n");
  v1::CompareRequest request;
  request.mutable_a()->set_name("a.obj");
  request.mutable_a()->set_content(grid);
  request.mutable_b()->set_name("b.obj");
  request.mutable_b()->set_content("v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n");
  request.set_map_format("vtp");
  const auto compare = [&](const std::string& account) {
    return Keep(v1::CompareService::NewStub(channel_), &v1::CompareService::Stub::Compare, account, request);
  };
  ASSERT_TRUE(compare("greedy").ok());
  const grpc::Status status = compare("greedy");
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  EXPECT_TRUE(compare("modest").ok());
}

TEST_F(TwoAccounts, ShareChecksOfPhysiology) {
  v1::CheckPhysiologyRequest request;
  request.mutable_source()->set_name("thorax");
  request.mutable_source()->set_resolution_mm(15);  // compiled fast
  const auto check = [&](const std::string& account) {
    return Keep(v1::StudyService::NewStub(channel_), &v1::StudyService::Stub::CheckPhysiology, account, request);
  };
  ASSERT_TRUE(check("greedy").ok());
  const grpc::Status status = check("greedy");
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  EXPECT_TRUE(check("modest").ok());
}

TEST_F(TwoAccounts, ShareBatches) {
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("cube-springs");
  request.set_seconds(3600);
  request.set_frames_per_second(0.001);
  request.add_runs();
  const auto run = [&](const std::string& account) {
    return Keep(v1::StudyService::NewStub(channel_), &v1::StudyService::Stub::RunBatch, account, request);
  };
  ASSERT_TRUE(run("greedy").ok());
  const grpc::Status status = run("greedy");
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  EXPECT_TRUE(run("modest").ok());
}

// Join links of one session.
TEST_F(TwoAccounts, LinksShareTheSeatsOfASession) {
  const auto links = v1::AccessService::NewStub(channel_);
  std::vector<std::string> secrets;
  for (int i = 0; i < 2; ++i) {
    v1::CreateLinkRequest request;
    request.set_session_id("greedy");
    v1::CreateLinkResponse response;
    ASSERT_TRUE(links->CreateLink(&Context("greedy"), request, &response).ok());
    secrets.push_back(response.secret());
  }
  v1::WatchFramesRequest request;
  request.set_session_id("greedy");
  std::vector<std::unique_ptr<grpc::ClientReader<v1::WatchFramesResponse>>> readers;
  const auto watch = [&](const std::string& link) -> grpc::Status {
    auto& context = *held_.emplace_back(std::make_unique<grpc::ClientContext>());
    context.AddMetadata("x-join", link);
    auto& reader = readers.emplace_back(frames_->WatchFrames(&context, request));
    v1::WatchFramesResponse response;
    return reader->Read(&response) ? grpc::Status::OK : reader->Finish();
  };
  grpc::Status status;
  for (int i = 0; i < 4 && status.ok(); ++i) status = watch(secrets[0]);
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("--max-share"));
  EXPECT_TRUE(watch(secrets[1]).ok());
  for (const auto& context : held_) context->TryCancel();
}

}  // namespace
}  // namespace phrenic::service
