// The layers of a sheet, which are only seen, stand for its deformable middle surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "server/session/export/export_plan.h"
#include "server/session/present_body.h"
#include "server/session/present_forces.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"

namespace phrenic::session {
namespace {

// A middle surface with more triangles than its layer, whose vertex 0 is over the middle's vertex 7.
constexpr char kSheet[] = R"(
  name: "sheet"
  bodies { name: "middle" role: ROLE_DEFORMABLE grid { columns: 6 rows: 6 u { x: 0.01 } v { y: 0.01 } } }
  bodies { name: "layer" role: ROLE_SEEN
           grid { columns: 2 rows: 2 origin { x: 0.01 y: 0.01 z: 0.001 } u { x: 0.025 } v { y: 0.025 } } }
  motions { skin { bodies: "layer" drivers: "middle" mode: SKIN_MODE_SHEET } }
  forces { gravity { bodies: "middle" acceleration { z: -10 } } }
)";

class LayersTest : public testing::Test {
 protected:
  void SetUp() override {
    v1::CreateSessionRequest request;
    request.set_session_id("mine");
    *request.mutable_source()->mutable_scene() = *schema::ParseScene("sheet", kSheet);
    const auto session = table_.Create(request);
    ASSERT_TRUE(session.ok()) << session.status();
  }
  absl::StatusOr<v1::GetForcesResponse> Forces(const std::string& body, int vertex) {
    v1::GetForcesRequest request;
    request.set_session_id("mine");
    request.set_body(body);
    request.set_vertex(vertex);
    request.set_kind("gravity");
    return ReadForces(table_, request);
  }

  FakeClock clock_;
  Models models_{SceneCatalogue({}), "", 1};
  Table table_{models_, clock_, {}};
};

TEST_F(LayersTest, AreWhatIsCompared) {
  v1::SessionBody wanted;
  wanted.set_session_id("mine");
  v1::ComparedState state;
  const auto mesh = FindPresentBody(table_, wanted, state);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(state.body(), "layer");
  EXPECT_NEAR(mesh->vertices(2, 0), 0.001, 1e-15);
}

TEST_F(LayersTest, AreWhatIsExported) {
  v1::CreateExportRequest request;
  request.set_session_id("mine");
  request.set_format("msh");
  request.set_seconds(1);
  const Model& model = (*table_.Find("mine"))->model();
  const auto plan = PlanExport(request, model, {model.parameters, model.InitialState()}, testing::TempDir());
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_EQ(plan->bodies, std::vector<int>{1});
}

TEST_F(LayersTest, AreReportedAsTissueInPlaceOfTheMiddle) {
  const Model& model = (*table_.Find("mine"))->model();
  EXPECT_FALSE(model.report.bodies(0).tissue());
  EXPECT_TRUE(model.report.bodies(1).tissue());
  EXPECT_TRUE(CompileText("name: 'x' bodies { name: 'a' role: ROLE_DEFORMABLE polyhedron { vertices {} } }")
                  ->report.bodies(0)
                  .tissue());
}

TEST_F(LayersTest, HaveTheForcesOfTheMiddleSurface) {
  const auto middle = Forces("middle", 7), layer = Forces("layer", 0);
  ASSERT_TRUE(middle.ok() && layer.ok()) << layer.status();
  ASSERT_GT(layer->forces_size(), 0);
  for (int k = 0; k < layer->forces_size(); ++k) EXPECT_NEAR(layer->forces(k).z(), middle->forces(k).z(), 1e-12);
  EXPECT_LT(layer->forces(0).z(), 0);
  ASSERT_EQ(layer->sizes().size(), 4 * sizeof(float)) << "one per vertex of the layer";
  float first = 0;
  std::memcpy(&first, layer->sizes().data(), sizeof(float));
  EXPECT_NEAR(first, -layer->forces(0).z(), 1e-6);
  EXPECT_FALSE(Forces("layer", 4).ok());
}

}  // namespace
}  // namespace phrenic::session
