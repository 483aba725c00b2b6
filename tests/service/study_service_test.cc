// StudyService over a socket.
#include <map>
#include <set>

#include "phrenic/v1/study.grpc.pb.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

class Studies : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    stub_ = v1::StudyService::NewStub(channel_);
  }

  grpc::Status Create(const std::string& text, v1::CreateStudyResponse* response) {
    return Call(*stub_, &v1::StudyService::Stub::CreateStudy, text, response);
  }

  // Returns the last message of WatchStudy.
  v1::Study WatchToTheEnd(const std::string& id, grpc::Status* status) {
    v1::WatchStudyRequest request;
    request.set_study_id(id);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    const auto reader = stub_->WatchStudy(&context, request);
    v1::WatchStudyResponse response;
    double progress = 0;
    while (reader->Read(&response)) {
      EXPECT_GE(response.study().progress(), progress);
      progress = response.study().progress();
    }
    *status = reader->Finish();
    return response.study();
  }

  std::unique_ptr<v1::StudyService::Stub> stub_;
};

const char kQuick[] = R"(
  study_id: "quick" source { name: "cube-springs" }
  error { seconds: 0.2 levels: 2 integrators: INTEGRATOR_VELOCITY_VERLET }
)";

TEST_F(Studies, RunToTheirResult) {
  v1::CreateStudyResponse created;
  ASSERT_TRUE(Create(kQuick, &created).ok());
  EXPECT_EQ(created.study().id(), "quick");
  grpc::Status status;
  const v1::Study study = WatchToTheEnd("quick", &status);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(study.state(), v1::STUDY_STATE_DONE) << study.problem();
  EXPECT_EQ(study.result().error().rows_size(), 2);
}

TEST_F(Studies, AreCancelledWhenDeleted) {
  v1::CreateStudyResponse created;
  ASSERT_TRUE(
      Create(R"(study_id: "long" source { name: "sheet-2d" } error { seconds: 120 levels: 16 })", &created).ok());
  v1::DeleteStudyResponse deleted;
  ASSERT_TRUE(Call(*stub_, &v1::StudyService::Stub::DeleteStudy, R"(study_id: "long")", &deleted).ok());
  ASSERT_TRUE(Create(kQuick, &created).ok());
  grpc::Status status;
  EXPECT_EQ(WatchToTheEnd("quick", &status).state(), v1::STUDY_STATE_DONE);
  v1::ListStudiesResponse list;
  ASSERT_TRUE(Call(*stub_, &v1::StudyService::Stub::ListStudies, "", &list).ok());
  EXPECT_EQ(list.studies_size(), 1);
}

TEST_F(Studies, ThatAreInvalidAreRefusedAtOnce) {
  v1::CreateStudyResponse created;
  EXPECT_THAT(Create(R"(source { name: "cube-springs" })", &created).error_message(), HasSubstr("what: must be set"));
  EXPECT_THAT(Create(R"(error { })", &created).error_message(), HasSubstr("source: must be set"));
  EXPECT_EQ(Create(R"(source { name: "no-such" } error { })", &created).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_THAT(Create(R"(source { name: "cube-springs" } error { levels: 99 })", &created).error_message(),
              HasSubstr("error.levels: 99 is outside 1 to 16"));
  EXPECT_THAT(Create(R"(source { name: "cube-springs" } preset: "snore" error { })", &created).error_message(),
              HasSubstr("snore"));
}

TEST_F(Studies, HaveNoPageBeforeTheyAreDone) {
  v1::CreateStudyResponse created;
  ASSERT_TRUE(
      Create(R"(study_id: "long" source { name: "sheet-2d" } error { seconds: 120 levels: 16 })", &created).ok());
  v1::GetStudyPageResponse page;
  EXPECT_EQ(Call(*stub_, &v1::StudyService::Stub::GetStudyPage, R"(study_id: "long")", &page).error_code(),
            grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(Call(*stub_, &v1::StudyService::Stub::GetStudyPage, R"(study_id: "none")", &page).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST_F(Studies, RunBatchesThatStreamEachResult) {
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("cube-springs");
  request.set_seconds(0.2);
  for (int i = 0; i < 5; ++i) request.add_runs()->mutable_parameters()->set_breath_force(i);
  grpc::ClientContext context;
  const auto reader = stub_->RunBatch(&context, request);
  v1::RunBatchResponse response;
  ASSERT_TRUE(reader->Read(&response));
  EXPECT_TRUE(response.has_header());
  std::set<int> runs;
  while (reader->Read(&response)) {
    runs.insert(response.result().run());
    EXPECT_EQ(response.result().times_size(), 4);
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(runs.size(), 5u);
}

TEST_F(Studies, ResumeABatchThatWasCutOff) {
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("cube-springs");
  request.set_seconds(0.5);
  for (int i = 0; i < 12; ++i) request.add_runs()->mutable_parameters()->set_breath_force(0.2 * i);
  // Reads until it has `most` results, then cancels.
  const auto read = [&](std::size_t most) {
    std::map<int, std::string> hashes;
    grpc::ClientContext context;
    const auto reader = stub_->RunBatch(&context, request);
    v1::RunBatchResponse response;
    while (hashes.size() < most && reader->Read(&response)) {
      if (response.has_result()) hashes[response.result().run()] = response.result().state_hash();
    }
    context.TryCancel();
    reader->Finish();
    return hashes;
  };
  const auto whole = read(100);
  ASSERT_EQ(whole.size(), 12u);
  auto some = read(3);
  ASSERT_EQ(some.size(), 3u);
  for (const auto& [run, hash] : some) request.add_finished(run);
  std::map<int, std::string> rest;
  for (int i = 0; i < 100 && rest.empty(); ++i) {  // the first stream may hold its place for a moment
    rest = read(100);
    absl::SleepFor(absl::Milliseconds(20));
  }
  EXPECT_EQ(rest.size(), 9u);
  some.merge(rest);
  EXPECT_TRUE(rest.empty()) << "a run came twice";
  EXPECT_EQ(some, whole);
}

TEST_F(Studies, RefuseBatchesByTheField) {
  const auto refused = [&](const v1::RunBatchRequest& request) {
    grpc::ClientContext context;
    const auto reader = stub_->RunBatch(&context, request);
    v1::RunBatchResponse response;
    EXPECT_FALSE(reader->Read(&response));
    return reader->Finish();
  };
  v1::RunBatchRequest request;
  request.mutable_source()->set_name("cube-springs");
  EXPECT_THAT(refused(request).error_message(), HasSubstr("runs"));
  request.add_runs()->mutable_parameters()->set_breath_force(-1);
  EXPECT_THAT(refused(request).error_message(), HasSubstr("runs[0].parameters.breath_force: -1 is outside 0 to 20"));
  request.mutable_runs(0)->clear_parameters();
  request.add_finished(1);
  EXPECT_THAT(refused(request).error_message(), HasSubstr("finished[0]: 1 is not the index of a run"));
}

}  // namespace
}  // namespace phrenic::service
