#include <cmath>

#include "phrenic/v1/tissue.grpc.pb.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using Tissue = v1::TissueService::Stub;
using testing::HasSubstr;

class TissueServiceTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    tissue_ = v1::TissueService::NewStub(channel_);
  }
  void CreateThorax() {
    v1::CreateSessionResponse created;
    const grpc::Status status = Call(*sessions_, &v1::SessionService::Stub::CreateSession,
                                     "source { name: 'thorax' } session_id: 'thorax'", &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  v1::ReadTissueResponse Read(const std::string& text) {
    v1::ReadTissueResponse response;
    const grpc::Status status = Call(*tissue_, &Tissue::ReadTissue, text, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }
  grpc::Status Refused(const std::string& text) {
    v1::ReadTissueResponse response;
    return Call(*tissue_, &Tissue::ReadTissue, text, &response);
  }

  std::unique_ptr<Tissue> tissue_;
};

TEST_F(TissueServiceTest, LungsRestAndThenGainVolume) {
  CreateThorax();
  const v1::ReadTissueResponse rest = Read("session_id: 'thorax'");
  EXPECT_EQ(rest.tick(), 0);
  ASSERT_EQ(rest.lungs_size(), 2);
  ASSERT_TRUE(Session(&v1::SessionService::Stub::StepSession, "session_id: 'thorax' ticks: 1200").ok());
  const v1::ReadTissueResponse moved = Read("session_id: 'thorax' points { x: -0.06 z: 0.25 } points { z: -1 }");
  EXPECT_EQ(moved.tick(), 1200);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(rest.lungs(i).volume()), 1e-6);
    EXPECT_GT(moved.lungs(i).volume(), 2e-5);
    ASSERT_EQ(moved.lungs(i).regions_size(), 5);
    EXPECT_EQ(moved.lungs(i).regions(0).name(), "base");
    EXPECT_GT(moved.lungs(i).regions(0).ventilation(), 0.005);
    EXPECT_GT(moved.lungs(i).regions(0).descent(), moved.lungs(i).regions(2).descent());
  }
  ASSERT_EQ(moved.points_size(), 2);
  EXPECT_EQ(moved.points(0).lung(), "lung-right");
  EXPECT_LT(moved.points(0).dz(), 0);
  EXPECT_GE(moved.points(0).strain(), moved.points(0).ventilation() / 3);
  EXPECT_EQ(moved.points(1).lung(), "");
}

// The arrays have the lengths by which a client decodes them.
TEST_F(TissueServiceTest, ShapesHaveTheBytesThatTheGridSays) {
  CreateThorax();
  v1::GetTissueRequest request;
  request.set_session_id("thorax");
  grpc::ClientContext context;
  const auto reader = tissue_->GetTissue(&context, request);
  const v1::ReadTissueResponse read = Read("session_id: 'thorax'");
  v1::GetTissueResponse lung;
  int lungs = 0;
  for (; reader->Read(&lung); ++lungs) {
    EXPECT_EQ(lung.lung_index(), lungs);
    EXPECT_EQ(lung.lung_count(), 2);
    ASSERT_EQ(lung.cells_size(), 3);
    EXPECT_EQ(lung.bricks().size(), static_cast<size_t>(lung.cells(0) * lung.cells(1) * lung.cells(2)));
    const size_t shape_bytes = lung.shapes().size() / static_cast<size_t>(lung.shape_count());
    EXPECT_EQ(lung.shapes().size(), shape_bytes * static_cast<size_t>(lung.shape_count()));
    EXPECT_EQ(shape_bytes % (3 * sizeof(float)), 0u);
    EXPECT_GT(shape_bytes / (3 * sizeof(float)), 500u);
    EXPECT_EQ(read.lungs(lungs).amplitudes().size(), sizeof(float) * static_cast<size_t>(lung.shape_count()));
    EXPECT_EQ(read.lungs(lungs).name(), lung.name());
  }
  EXPECT_EQ(lungs, 2);
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(TissueServiceTest, ASceneWithoutLungsIsRefused) {
  CreateCube("cube");
  const grpc::Status status = Refused("session_id: 'cube'");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_THAT(status.error_message(), HasSubstr("lacks lungs"));
}

TEST_F(TissueServiceTest, AWrongRequestIsRefusedWithItsField) {
  CreateCube("cube");
  std::string many = "session_id: 'cube'";
  for (int i = 0; i < 65; ++i) many += " points {}";
  EXPECT_EQ(Refused(many).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(Refused(many).error_message(), HasSubstr("points"));
  EXPECT_EQ(Refused("session_id: 'cube' points { x: nan }").error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Refused("session_id: 'none'").error_code(), grpc::StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace phrenic::service
