// The generated thorax breathes inside the published ranges; measures outside are listed in
// server/physiology/README.md.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/step/step.h"
#include "server/physiology/physiology.h"
#include "server/schema/schema.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

std::string ReadSource(const std::string& path) {
  std::ifstream file(std::string(PHRENIC_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::shared_ptr<const Model> CompileThorax() {
  const auto scene = schema::ParseScene("thorax-thesis.textproto", ReadSource("server/scenes/thorax-thesis.textproto"));
  EXPECT_TRUE(scene.ok()) << scene.status();
  auto model =
      Compile(*scene, [](const v1::Body& body) { return anatomy::Generate(body.anatomy(), body.generated()); });
  EXPECT_TRUE(model.ok()) << model.status();
  return *model;
}

const std::vector<std::string> kPresets = {"quiet", "deep", "diaphragmatic", "chest"};

class Thorax : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileThorax(); }
  static void TearDownTestSuite() { model_.reset(); }
  static std::shared_ptr<const Model> model_;
};

std::shared_ptr<const Model> Thorax::model_;

TEST_F(Thorax, BreathesInsideThePublishedRangesOrTheReadmeListsTheMeasure) {
  double last = 0;
  const auto table = physiology::CheckPhysiology(*model_, kPresets, [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  });
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_GE(table->rows_size(), 40);
  const std::string page = PhysiologyPage("The thorax by the thesis, whose motion is prescribed");
  for (const v1::PhysiologyRow& row : table->rows()) {
    std::printf("%-14s %-28s %7.2f   accepted %g to %g\n", row.breath().c_str(), row.what().c_str(), row.value(),
                row.low(), row.high());
    EXPECT_EQ(row.verdict() == v1::VERDICT_NOT_MODELLED, row.note().find("the scene has no") == 0) << row.what();
    const bool outside = row.verdict() == v1::VERDICT_OUTSIDE;
    const std::string named = row.breath() + ": " + row.what();
    EXPECT_FALSE(outside && page.find(named) == std::string::npos) << "the README does not list: " << named;
  }
}

TEST_F(Thorax, StopsTheStudyIfItIsCancelled) {
  EXPECT_EQ(physiology::CheckPhysiology(*model_, kPresets, [](double) { return false; }).status().code(),
            absl::StatusCode::kCancelled);
}

TEST_F(Thorax, KeepsTheRigidLinksOfItsTendon) {
  EXPECT_GT(model_->report.rigid_links(), 500);
  State state = model_->InitialState();
  Workspace work = model_->MakeWorkspace();
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(Step(*model_, model_->parameters, model_->parameters.time_step(), state, work).ok());
  }
  EXPECT_LT(model_->constraints.front()->Residual(state), 1e-9);
}

TEST_F(Thorax, HasTheSpecifiedNumberOfVertices) {
  EXPECT_GE(model_->report.simulated_vertices(), 20'000);
  EXPECT_LE(model_->report.simulated_vertices(), 21'000);
}

TEST(Physiology, NeedsADiaphragm) {
  const auto scene = schema::ParseScene("cube", ReadSource("server/scenes/cube-springs.textproto"));
  ASSERT_TRUE(scene.ok());
  const auto model = Compile(*scene, [](const v1::Body&) { return absl::NotFoundError(""); });
  ASSERT_TRUE(model.ok());
  const auto table = physiology::CheckPhysiology(**model, {}, [](double) { return true; });
  EXPECT_EQ(table.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_NE(std::string(table.status().message()).find("STRUCTURE_DIAPHRAGM"), std::string::npos);
}

}  // namespace
}  // namespace phrenic
