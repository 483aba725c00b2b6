// Studies survive a restart: finished ones are restored, others run again with equal results.
#include <gtest/gtest.h>

#include <filesystem>

#include "phrenic/v1/study.grpc.pb.h"
#include "server/store/layout.h"
#include "tests/support/server_process.h"

namespace phrenic::service {
namespace {

class StudyRestartTest : public testing::Test {
 protected:
  StudyRestartTest() : folder_(testing::TempDir() + "/phrenic-study-" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  void SetUp() override { Restart(); }
  // Restarts the server; a server that is stopped by SIGTERM writes pending records.
  void Restart() {
    if (server_.running()) {
      ASSERT_EQ(server_.Stop(20), 0) << server_.output();
    }
    const absl::Status status = server_.Start();
    ASSERT_TRUE(status.ok()) << status;
  }
  ~StudyRestartTest() override {
    server_.Kill();
    std::filesystem::remove_all(folder_);
  }
  std::unique_ptr<v1::StudyService::Stub> Studies() const { return v1::StudyService::NewStub(server_.NewChannel()); }

  std::string Create(const std::string& id) const {
    v1::CreateStudyRequest request;
    request.set_study_id(id);
    request.mutable_source()->set_name("cube-springs");
    request.mutable_error()->set_seconds(0.2);
    v1::CreateStudyResponse response;
    grpc::ClientContext context;
    const grpc::Status status = Studies()->CreateStudy(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.study().id();
  }
  v1::Study Await(const std::string& id) const {
    v1::WatchStudyRequest watch;
    watch.set_study_id(id);
    grpc::ClientContext context;
    const auto studies = Studies();
    const auto reader = studies->WatchStudy(&context, watch);
    v1::WatchStudyResponse response;
    while (reader->Read(&response)) continue;
    return response.study();
  }
  // Returns the part of a result that repeats: the errors, without the run times.
  static std::vector<double> Errors(const v1::Study& study) {
    std::vector<double> errors;
    for (const auto& row : study.result().error().rows()) errors.push_back(row.error_rms_mm());
    return errors;
  }

  const std::string folder_;
  ServerProcess server_{folder_ + "/said", {"--store", folder_ + "/store"}};
};

TEST_F(StudyRestartTest, FinishedStudiesAreRestoredAndOthersRunAgain) {
  const v1::Study ended = Await(Create("ended"));
  ASSERT_EQ(ended.state(), v1::STUDY_STATE_DONE) << ended.problem();
  Create("killed");
  Create("waiting");
  Restart();
  EXPECT_EQ(Await("ended").result().SerializeAsString(), ended.result().SerializeAsString());
  for (const char* id : {"killed", "waiting"}) {
    const v1::Study again = Await(id);
    EXPECT_EQ(again.state(), v1::STUDY_STATE_DONE) << again.problem();
    EXPECT_EQ(Errors(again), Errors(ended));
  }
  v1::DeleteStudyRequest remove;
  remove.set_study_id("ended");
  v1::DeleteStudyResponse removed;
  grpc::ClientContext context;
  ASSERT_TRUE(Studies()->DeleteStudy(&context, remove, &removed).ok());
  Restart();
  v1::ListStudiesResponse list;
  grpc::ClientContext listing;
  ASSERT_TRUE(Studies()->ListStudies(&listing, {}, &list).ok());
  EXPECT_EQ(list.studies_size(), 2);
}

TEST_F(StudyRestartTest, ADamagedStudyIsSkippedAndTheOthersAreRestored) {
  for (const char* id : {"damaged", "good"}) ASSERT_EQ(Await(Create(id)).state(), v1::STUDY_STATE_DONE);
  ASSERT_EQ(server_.Stop(20), 0) << server_.output();
  {
    auto database = store::Database::Open(store::StoreFile(folder_ + "/store"), store::Access::kWrite);
    ASSERT_TRUE(database.ok()) << database.status();
    ASSERT_TRUE(database->Run("UPDATE records SET bytes = 'other' WHERE id = 'damaged'").ok());
  }
  Restart();
  v1::ListStudiesResponse list;
  grpc::ClientContext listing;
  ASSERT_TRUE(Studies()->ListStudies(&listing, {}, &list).ok());
  ASSERT_EQ(list.studies_size(), 1);
  EXPECT_EQ(list.studies(0).id(), "good");
}

}  // namespace
}  // namespace phrenic::service
