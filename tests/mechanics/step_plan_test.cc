// What a plan decides for a scene.
#include "server/mechanics/step/step_plan.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"
#include "tests/mechanics/mixed_sheet.h"

namespace phrenic {
namespace {

const char kLink[] = "constraints { rigid_links { body: 'sheet' list { links { a: 0 b: 1 } } } }";
const char kThesisLink[] =
    "constraints { rigid_links { body: 'sheet' list { links { a: 0 b: 1 } } projection: PROJECTION_THESIS } }";
const char kPressure[] = "forces { pressure { surface { bodies: 'sheet' } pressure: 1 } }";

class PlanOf : public testing::Test {
 protected:
  const StepPlan& Plan(const std::string& added) {
    model_ = CompileText(absl::StrCat(kMixedSheet, added));
    return *model_->plan;
  }
  // Whether a step of one thread is written over its start.
  bool Overwrites() {
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    return &model_->plan->ChooseEnd(state, work).x == &state.x;
  }
  bool RecordsBounds() {
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    model_->plan->PrepareBlocks(model_->parameters, state, work);
    return !work.bounds.empty();
  }

  std::shared_ptr<const Model> model_;
};

TEST_F(PlanOf, AForceForAllVerticesAtOnceIsEvaluatedFirst) {
  EXPECT_TRUE(Plan("").schedule().whole.empty());
  const ForceSchedule& schedule = Plan(kPressure).schedule();
  ASSERT_EQ(schedule.whole.size(), 1u);
  EXPECT_EQ(schedule.whole.front(), model_->forces.back().get());
}

TEST_F(PlanOf, SpringsOfEachPrecisionAndLoadsAreBatches) {
  const ForceSchedule& schedule = Plan("").schedule();
  EXPECT_EQ(schedule.batches.size(), 3u);
  EXPECT_EQ(schedule.by_block.size(), 4u) << "two batches of springs, point load and attachment";
  EXPECT_NE(schedule.loads, nullptr);
  EXPECT_GE(schedule.packing_origin, 0);
}

TEST_F(PlanOf, AStepIsNotWrittenOverPositionsThatSpringsInDoublePrecisionRead) {
  Plan("");
  EXPECT_FALSE(Overwrites());
  std::string single = kMixedSheet;
  single.replace(single.find("rest_length_ratio"), 0, "precision: PRECISION_SINGLE ");
  model_ = CompileText(single);
  ASSERT_NE(model_, nullptr);
  EXPECT_TRUE(Overwrites());
}

TEST_F(PlanOf, TheOnlyConstraintIsProjectedPerBlockIfItCanBe) {
  Plan("");
  EXPECT_TRUE(RecordsBounds()) << "no constraint";
  Plan(kLink);
  EXPECT_TRUE(RecordsBounds());
  Plan(absl::StrCat(kLink, kLink));
  EXPECT_FALSE(RecordsBounds()) << "two constraints";
  Plan(kThesisLink);
  EXPECT_FALSE(RecordsBounds()) << "for all vertices at once";
}

}  // namespace
}  // namespace phrenic
