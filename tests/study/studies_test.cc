#include "server/study/queue/studies.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "phrenic/v1/saved.pb.h"
#include "server/study/queue/request_size.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr char kScene[] = "cube";

// The store has records of an earlier server. The scene does not compile, so a study that runs again fails at once.
class StudiesTest : public testing::Test {
 protected:
  ~StudiesTest() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }

  std::unique_ptr<Studies> Make() {
    return std::make_unique<Studies>(
        [](const v1::CreateStudyRequest& request) -> absl::StatusOr<std::string> {
          if (request.source().name() != kScene) return absl::NotFoundError("there is no such scene");
          return kScene;
        },
        [](const v1::SceneSource&, const std::string&,
           const std::function<bool()>&) -> absl::StatusOr<std::shared_ptr<const Model>> {
          return absl::InvalidArgumentError("the scene does not compile");
        },
        clock_, store_.get());
  }

  static v1::CreateStudyRequest Request(const std::string& scene) {
    v1::CreateStudyRequest request;
    request.mutable_source()->set_name(scene);
    request.mutable_error();
    return request;
  }

  static v1::Study Ended(const Studies& studies, const std::string& id) {
    Studies::Seen seen;
    while (!seen.ended) {
      auto next = studies.Wait(id, seen.version, absl::Seconds(10));
      EXPECT_TRUE(next.ok()) << next.status();
      if (!next.ok()) break;
      seen = *std::move(next);
    }
    return seen.message;
  }

  // Restores all records and returns their owners by id.
  std::map<std::string, std::string> Restore(Studies& studies) {
    studies.Restore(
        *store_->LoadRecords(), [](const std::string& account) { return account; }, lost_);
    std::map<std::string, std::string> owners;
    for (const v1::Study& study : studies.List()) owners[study.id()] = studies.OwnerOf(study.id()).value_or("none");
    return owners;
  }

  const SystemClock clock_{};
  const std::string folder_ = testing::TempDir() + "phrenic_studies_" + std::to_string(getpid());
  std::unique_ptr<store::Store> store_ = *store::Store::Open(folder_);
  std::map<std::string, absl::Status> lost_;
};

TEST(StudyRequests, HaveABoundedSize) {
  v1::CreateStudyRequest request;
  request.mutable_source()->set_name("sheet-2d");
  for (int i = 0; i < 256; ++i) request.mutable_error()->add_integrators(v1::INTEGRATOR_VELOCITY_VERLET);
  EXPECT_TRUE(CheckSize(request).ok());
  request.mutable_error()->add_integrators(v1::INTEGRATOR_VELOCITY_VERLET);
  EXPECT_TRUE(absl::IsInvalidArgument(CheckSize(request)));
  EXPECT_EQ(CheckSize(request).message().find("error.integrators: has 257"), 0u) << CheckSize(request);
  request.mutable_streaming();
  EXPECT_TRUE(CheckSize(request).ok());
  request.mutable_source()->mutable_scene()->set_description(std::string(17 << 20, 'x'));
  EXPECT_TRUE(absl::IsResourceExhausted(CheckSize(request)));
}

TEST_F(StudiesTest, DeriveTheirIdFromKindAndSceneAndRefuseInvalidRequests) {
  const auto studies = Make();
  const auto added = studies->Add(Request(kScene), "anna");
  ASSERT_TRUE(added.ok()) << added.status();
  EXPECT_EQ(added->id(), "error-cube");
  EXPECT_EQ(added->scene(), kScene);
  EXPECT_TRUE(absl::IsNotFound(studies->Add(Request("sphere"), "anna").status()));
  v1::CreateStudyRequest nothing = Request(kScene);
  nothing.clear_error();
  EXPECT_THAT(std::string(studies->Add(nothing, "anna").status().message()), HasSubstr("must be set"));
  const v1::Study ended = Ended(*studies, "error-cube");
  EXPECT_EQ(ended.state(), v1::STUDY_STATE_FAILED);
  EXPECT_THAT(ended.problem(), HasSubstr("does not compile"));
}

TEST_F(StudiesTest, AnEndedStudySurvivesARestartAndListsLeaveOutItsResult) {
  v1::SavedStudy saved;
  saved.set_owner("anna");
  saved.mutable_study()->set_id("done");
  saved.mutable_study()->set_state(v1::STUDY_STATE_DONE);
  saved.mutable_study()->mutable_result()->set_scene(kScene);
  store_->Put("study", "done", saved.SerializeAsString());
  ASSERT_TRUE(store_->FlushRecords().ok());
  const auto studies = Make();
  EXPECT_EQ(Restore(*studies)["done"], "anna");
  EXPECT_EQ(Ended(*studies, "done").result().scene(), kScene);
  ASSERT_THAT(studies->List(), SizeIs(1));
  EXPECT_FALSE(studies->List()[0].has_result());
}

TEST_F(StudiesTest, AnUnfinishedStudyRunsAgainAndFailsIfItsSceneIsGone) {
  for (const char* scene : {kScene, "sphere"}) {
    v1::SavedStudy saved;
    *saved.mutable_request() = Request(scene);
    saved.mutable_request()->set_study_id(scene);
    saved.mutable_study()->set_id(scene);
    store_->Put("study", scene, saved.SerializeAsString());
  }
  store_->Put("study", "damaged", "\xff");
  ASSERT_TRUE(store_->FlushRecords().ok());
  const auto studies = Make();
  EXPECT_THAT(Restore(*studies), SizeIs(2));
  EXPECT_TRUE(absl::IsDataLoss(lost_["study damaged"]));
  EXPECT_THAT(Ended(*studies, kScene).problem(), HasSubstr("does not compile")) << "it ran";
  const v1::Study gone = Ended(*studies, "sphere");
  EXPECT_EQ(gone.state(), v1::STUDY_STATE_FAILED);
  EXPECT_THAT(gone.problem(), HasSubstr("no such scene"));
}

}  // namespace
}  // namespace phrenic::study
