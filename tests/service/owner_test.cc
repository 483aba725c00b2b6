// What an account makes is its own: uploads, session ids, pages of sessions, and the time that its scenes compile.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "phrenic/v1/upload.grpc.pb.h"
#include "server/crypto/sha256.h"
#include "tests/service/guarded_server.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr char kSurface[] = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n";
constexpr char kSmall[] = "bodies { name: 'x' role: ROLE_AT_REST grid { columns: 3 rows: 3 u { x: 1 } v { y: 1 } } }";

class OwnersOfUploads : public GuardedServer {
 protected:
  using Uploads = v1::UploadService::Stub;
  void SetUp() override {
    GuardedServer::SetUp();
    uploads_ = v1::UploadService::NewStub(channel_);
  }
  v1::BeginUploadResponse Begin(const std::string& who) {
    v1::BeginUploadResponse begun;
    const auto status = CallAs(
        {who}, *uploads_, &Uploads::BeginUpload,
        absl::StrCat("name: '", who, ".obj' size: ", sizeof kSurface - 1, " sha256: '", Sha256Hex(kSurface), "'"),
        &begun);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return begun;
  }
  grpc::StatusCode Send(const std::string& who, const std::string& id) {
    v1::AddUploadChunkResponse added;
    return CallAs({who}, *uploads_, &Uploads::AddUploadChunk,
                  absl::StrCat("upload_id: '", id, "' chunk: '", absl::CEscape(kSurface), "'"), &added)
        .error_code();
  }
  grpc::StatusCode Finish(const std::string& who, const std::string& id) {
    v1::FinishUploadResponse finished;
    return CallAs({who}, *uploads_, &Uploads::FinishUpload, absl::StrCat("upload_id: '", id, "'"), &finished)
        .error_code();
  }
  int Count(const std::string& who) {
    v1::ListUploadsResponse listed;
    EXPECT_TRUE(CallAs({who}, *uploads_, &Uploads::ListUploads, "", &listed).ok());
    return listed.files_size();
  }
  // Creates a session whose scene names the file.
  grpc::StatusCode Use(const std::string& who, const std::string& shape) {
    return Code({who}, &Sessions::CreateSession,
                "source { scene { name: 's' bodies { name: 'x' role: ROLE_AT_REST " + shape + " } } }");
  }

  std::unique_ptr<Uploads> uploads_;
};

TEST_F(OwnersOfUploads, AnotherAccountsUploadCanNeitherBeFilledNorFinishedNorUsed) {
  const std::string id = Begin("owner").upload_id();
  ASSERT_EQ(id.size(), 32U);
  EXPECT_EQ(Send("other", id), grpc::NOT_FOUND);
  ASSERT_EQ(Send("owner", id), grpc::OK);
  EXPECT_EQ(Finish("other", id), grpc::NOT_FOUND);
  ASSERT_EQ(Finish("owner", id), grpc::OK);
  EXPECT_EQ(Count("owner"), 1);
  EXPECT_EQ(Count("other"), 0);
  const std::string path = absl::StrCat("path: 'upload:", Sha256Hex(kSurface), "'");
  EXPECT_EQ(Use("owner", "file { " + path + " }"), grpc::OK);
  EXPECT_EQ(Use("other", "file { " + path + " }"), grpc::NOT_FOUND) << "though its model is kept";
  EXPECT_EQ(Use("other", "filling { cell: 0.1 file { " + path + " } }"), grpc::NOT_FOUND);
  v1::DescribeSceneResponse described;
  EXPECT_EQ(
      CallAs({"other"}, *scenes_, &v1::SceneService::Stub::DescribeScene,
             "source { scene { name: 's' bodies { name: 'x' role: ROLE_AT_REST file { " + path + " } } } }", &described)
          .error_code(),
      grpc::NOT_FOUND);
  v1::DeleteUploadResponse deleted;
  EXPECT_EQ(CallAs({"other"}, *uploads_, &Uploads::DeleteUpload, path, &deleted).error_code(), grpc::NOT_FOUND);
  const v1::BeginUploadResponse begun = Begin("other");
  EXPECT_EQ(begun.upload_id().size(), 32U) << "the hash alone is no file";
  EXPECT_FALSE(begun.has_file());
  ASSERT_EQ(Send("other", begun.upload_id()), grpc::OK);
  ASSERT_EQ(Finish("other", begun.upload_id()), grpc::OK);
  EXPECT_EQ(Use("other", "file { " + path + " }"), grpc::OK);
}

TEST_F(GuardedServer, SessionIdsCarryNoNameUnlessTheOwnerGivesOne) {
  const auto create = [&](const std::string& who, const std::string& text) {
    v1::CreateSessionResponse created;
    const auto status = CallAs({who}, *sessions_, &Sessions::CreateSession, text, &created);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return created.session().id();
  };
  const std::string inline_scene = absl::StrCat("source { scene { name: 'jane-doe-1948' ", kSmall, " } }");
  const std::string first = create("owner", inline_scene);
  EXPECT_THAT(first, StartsWith("session-"));
  EXPECT_THAT(first, Not(HasSubstr("doe")));
  const std::string shipped = create("other", "source { name: 'cube-springs' }");
  EXPECT_THAT(shipped, StartsWith("cube-springs-"));
  EXPECT_NE(create("other", "source { name: 'cube-springs' }"), shipped + "-2") << "ids do not count others' sessions";
  v1::ForkSessionResponse forked;
  ASSERT_TRUE(CallAs({"owner"}, *sessions_, &Sessions::ForkSession, "session_id: '" + first + "'", &forked).ok());
  EXPECT_THAT(forked.session().id(), Not(HasSubstr("doe")));
  EXPECT_EQ(create("admin", inline_scene + " session_id: 'chosen'"), "chosen");
  const auto studies = v1::StudyService::NewStub(channel_);
  v1::CreateStudyResponse study;
  ASSERT_TRUE(
      CallAs({"owner"}, *studies, &v1::StudyService::Stub::CreateStudy, inline_scene + " error {}", &study).ok());
  EXPECT_THAT(study.study().id(), Not(HasSubstr("doe")));
}

TEST_F(GuardedServer, ErrorsNameNoSessionOfAnother) {
  ASSERT_EQ(Create("owner", "jane-doe"), grpc::OK);
  for (const char* who : {"other", "viewer"}) {
    v1::GetSessionResponse response;
    const auto status = CallAs({who}, *sessions_, &Sessions::GetSession, "session_id: 'jane-do'", &response);
    EXPECT_THAT(status.error_message(), Not(HasSubstr("jane-doe")));
  }
}

TEST_F(GuardedServer, PagesHoldAndNameVisibleSessionsAlone) {
  ASSERT_EQ(Create("owner", "a-jane-doe"), grpc::OK);
  ASSERT_EQ(Create("other", "b"), grpc::OK);
  ASSERT_EQ(Create("owner", "c-jane-doe"), grpc::OK);
  ASSERT_EQ(Create("other", "d"), grpc::OK);
  const auto page = [&](const std::string& who, const std::string& token, v1::ListSessionsResponse* listed) {
    listed->Clear();
    return CallAs({who}, *sessions_, &Sessions::ListSessions, "page_size: 1 page_token: '" + token + "'", listed)
        .error_code();
  };
  v1::ListSessionsResponse listed;
  ASSERT_EQ(page("other", "", &listed), grpc::OK);
  ASSERT_EQ(listed.sessions_size(), 1);
  EXPECT_EQ(listed.sessions(0).id(), "b");
  const std::string token = listed.next_page_token();
  ASSERT_FALSE(token.empty());
  std::string bytes;
  absl::WebSafeBase64Unescape(token, &bytes);
  EXPECT_THAT(token + bytes, Not(HasSubstr("doe")));
  ASSERT_EQ(page("other", token, &listed), grpc::OK);
  ASSERT_EQ(listed.sessions_size(), 1);
  EXPECT_EQ(listed.sessions(0).id(), "d");
  EXPECT_THAT(listed.next_page_token(), IsEmpty()) << "no hidden session makes a page";
  EXPECT_EQ(page("owner", token, &listed), grpc::INVALID_ARGUMENT) << "another account's";
  for (const std::string& bad : {std::string("a"), std::string("c-jane-doe"), std::string(10'000, 'A'), token + "A",
                                 token.substr(1), token.substr(0, token.size() - 2)}) {
    EXPECT_EQ(page("other", bad, &listed), grpc::INVALID_ARGUMENT) << bad;
    EXPECT_EQ(listed.sessions_size(), 0);
  }
  std::string changed = token;
  changed[changed.size() / 2] = changed[changed.size() / 2] == 'x' ? 'y' : 'x';
  EXPECT_EQ(page("other", changed, &listed), grpc::INVALID_ARGUMENT);
}

TEST_F(GuardedServer, AJoinLinkThatNoSessionHasIsNotAnIdentity) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  const std::string good = Link("").secret();
  for (const std::string& bad : {std::string("garbage"), std::string(32, 'f'), std::string(5000, 'a'), std::string(","),
                                 std::string("' or 1=1"), good.substr(1), good + "0"}) {
    const As guest{"", bad};
    v1::ListSessionsResponse listed;
    EXPECT_EQ(CallAs(guest, *sessions_, &Sessions::ListSessions, "", &listed).error_code(), grpc::UNAUTHENTICATED)
        << bad;
    v1::ListScenesResponse scenes;
    EXPECT_EQ(CallAs(guest, *scenes_, &v1::SceneService::Stub::ListScenes, "", &scenes).error_code(),
              grpc::UNAUTHENTICATED);
    EXPECT_EQ(CallAs({"viewer", bad}, *sessions_, &Sessions::ListSessions, "", &listed).error_code(), grpc::OK)
        << "the account counts";
    EXPECT_THAT(listed.sessions(), IsEmpty());
  }
  v1::ListSessionsResponse listed;
  EXPECT_EQ(CallAs({"", "garbage, " + good}, *sessions_, &Sessions::ListSessions, "", &listed).error_code(), grpc::OK);
  EXPECT_EQ(listed.sessions_size(), 1);
}

// Every pair of 40,000 vertices is near: minutes of work in a request of some hundred bytes.
std::string LongScene(int number) {
  return absl::StrCat(
      "source { scene { name: 'long' title: '", number,
      "' bodies { name: 'x' role: ROLE_DEFORMABLE mass: 1 grid { columns: 200 rows: 200 u { x: 1e-6 } v { "
      "y: 1e-6 } } } forces { cross_layer { bodies: 'x' distance: 100 } } } }");
}

TEST_F(GuardedServer, LongCompilesOfOneAccountDelayNobodyAndEndWithTheirCaller) {
  std::vector<std::thread> greedy;
  std::atomic<int> sent = 0;
  for (int i = 0; i < 12; ++i) {
    greedy.emplace_back([&, i] {
      v1::DescribeSceneRequest request;
      EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(LongScene(i), &request));
      grpc::ClientContext context;
      context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(4));
      Sign({"owner"}, context);
      v1::DescribeSceneResponse response;
      ++sent;
      EXPECT_FALSE(scenes_->DescribeScene(&context, request, &response).ok());
    });
  }
  while (sent < 12) std::this_thread::yield();
  for (int i = 0; i < 10; ++i) {
    v1::DescribeSceneResponse response;
    const auto start = std::chrono::steady_clock::now();
    const auto status = CallAs({"other"}, *scenes_, &v1::SceneService::Stub::DescribeScene,
                               absl::StrCat("source { scene { name: 's' title: '", i, "' ", kSmall, " } }"), &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    EXPECT_EQ(Create("other", absl::StrCat("s", i)), i < 2 ? grpc::OK : grpc::RESOURCE_EXHAUSTED);
  }
  for (std::thread& thread : greedy) thread.join();
  // The deadlines have passed: slots are free for another long scene at once.
  v1::DescribeSceneResponse response;
  EXPECT_TRUE(CallAs({"owner"}, *scenes_, &v1::SceneService::Stub::DescribeScene,
                     absl::StrCat("source { scene { name: 's' title: 'last' ", kSmall, " } }"), &response)
                  .ok());
}

TEST_F(GuardedServer, ASmallRequestForAHugeSceneIsRefusedAtOnce) {
  for (const std::string scene :
       {"bodies { name: 'x' role: ROLE_AT_REST block { size { x: 1 y: 1 z: 1 } columns: 500 rows: 500 layers: 500 } }",
        "bodies { name: 'x{number}{side}' for_each { numbers { first: 1 last: 17 } sides: [SIDE_RIGHT, SIDE_LEFT] } "
        "role: ROLE_AT_REST anatomy { "
        "structure: "
        "STRUCTURE_DIAPHRAGM } generated { resolution_mm: 1 } }"}) {
    v1::DescribeSceneResponse response;
    const auto start = std::chrono::steady_clock::now();
    const auto status = CallAs({"owner"}, *scenes_, &v1::SceneService::Stub::DescribeScene,
                               "source { scene { name: 's' " + scene + " } }", &response);
    EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr("(--max-vertices)"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }
}

}  // namespace
}  // namespace phrenic::service
