// Calibration on a coarse thorax: the parameters that made a breath are found again from its measures.
#include "server/calibrate/calibrate.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/physiology/generated_thorax.h"

namespace phrenic::calibrate {
namespace {

using ::testing::HasSubstr;

const Target* Named(std::string_view name) {
  return &*std::find_if(Targets().begin(), Targets().end(), [&](const Target& each) { return each.name == name; });
}

class CalibratedThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CompileShipped("thorax", 20);
    subject_ = *physiology::Subject::Of(*model_);
  }
  static void TearDownTestSuite() {
    subject_.reset();
    model_.reset();
  }

  static v1::Parameters Breath(double diaphragm, double intercostals) {
    v1::Parameters parameters = model_->parameters;
    parameters.set_diaphragm_activation(diaphragm);
    parameters.set_intercostal_activation(intercostals);
    return parameters;
  }
  // Measured as `phrenic physiology` does, with the search for flaws.
  static double Measured(std::string_view target, const v1::Parameters& parameters) {
    const auto recording = physiology::Record(*subject_, "breath", parameters, [](double) { return true; });
    return Named(target)->scale * Named(target)->measure(*recording, *recording);
  }
  static Task TaskOf(double litres, double share, double tolerance) {
    Task task;
    task.wanted = {{Named("tidal-volume"), litres}, {Named("abdominal-share"), share}};
    task.varied = {*ReadVaried("diaphragm_activation"), *ReadVaried("intercostal_activation")};
    task.limits.tolerance = tolerance;
    return task;
  }
  static absl::StatusOr<Calibration> Run(const Task& task) {
    return Calibrate(*subject_, Breath(0.08, 0.165), task, [](int, double) { return true; });
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::unique_ptr<const physiology::Subject> subject_;
};

TEST_F(CalibratedThorax, RecoversTheActivationsThatMadeABreath) {
  const v1::Parameters made = Breath(0.06, 0.25);
  const auto found = Run(TaskOf(Measured("tidal-volume", made), Measured("abdominal-share", made), 0.002));
  ASSERT_TRUE(found.ok()) << found.status();
  ASSERT_TRUE(found->reached) << found->reason;
  std::printf("%g and %g after %d breaths, residual %g\n", found->parameters[0].value, found->parameters[1].value,
              found->breaths, found->residual);
  EXPECT_NEAR(found->parameters[0].value, 0.06, 0.02 * 0.06);
  EXPECT_NEAR(found->parameters[1].value, 0.25, 0.02 * 0.25);
  EXPECT_LE(found->breaths, 40);
}

TEST_F(CalibratedThorax, ReachesTheWantedMeasuresAsPhysiologyMeasuresThemTwiceInTheSameWay) {
  const Task task = TaskOf(0.5, 0.63, 0.01);
  const auto found = Run(task), again = Run(task);
  ASSERT_TRUE(found.ok()) << found.status();
  ASSERT_TRUE(found->reached) << found->reason;
  const v1::Parameters breath = Breath(found->parameters[0].value, found->parameters[1].value);
  EXPECT_NEAR(Measured("tidal-volume", breath), 0.5, 0.01 * 0.5);
  EXPECT_NEAR(Measured("abdominal-share", breath), 0.63, 0.01 * 0.63);
  EXPECT_NEAR(found->measures[0].got, Measured("tidal-volume", breath), 1e-12);
  EXPECT_GT(std::abs(Measured("tidal-volume", Breath(0.08, 0.165)) - 0.5), 0.01 * 0.5) << "the start is a solution";
  EXPECT_EQ(found->breaths, again->breaths);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found->parameters[i].value, again->parameters[i].value);
    EXPECT_EQ(found->measures[i].got, again->measures[i].got);
  }
}

TEST_F(CalibratedThorax, NamesTheBoundsAtWhichItStopped) {
  Task task = TaskOf(2.5, 0.63, 0.01);
  task.wanted.pop_back();
  task.varied = {*ReadVaried("diaphragm_activation:0:0.1")};
  const auto found = Run(task);
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_FALSE(found->reached);
  EXPECT_EQ(found->reason, "diaphragm_activation stopped at its upper bound 0.1");
  EXPECT_EQ(found->parameters[0].value, 0.1);
  EXPECT_GT(found->residual, 0.5);
}

TEST_F(CalibratedThorax, EndsAtItsLimitOfBreaths) {
  Task task = TaskOf(0.5, 0.63, 0.001);
  task.limits.tries = 2;
  const auto found = Run(task);
  EXPECT_EQ(found->breaths, 2);
  EXPECT_THAT(found->reason, HasSubstr("limit of 2 breaths"));
}

TEST_F(CalibratedThorax, IsCancelledInABreath) {
  int asked = 0;
  const auto stop = [&](int, double) { return ++asked < 4; };
  const auto found = Calibrate(*subject_, Breath(0.08, 0.165), TaskOf(0.5, 0.63, 0.01), stop);
  EXPECT_EQ(found.status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(asked, 4);
}

TEST_F(CalibratedThorax, RefusesABreathThatDivergesAtTheStart) {
  v1::Parameters start = Breath(0.08, 0.165);
  start.set_time_step(0.02);
  const auto found = Calibrate(*subject_, start, TaskOf(0.5, 0.63, 0.01), [](int, double) { return true; });
  EXPECT_EQ(found.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(found.status().message()), HasSubstr("diverged"));
}

TEST(CalibrationTask, NeedsAMeasureForEachParameter) {
  Task task;
  task.varied = {*ReadVaried("diaphragm_activation"), *ReadVaried("intercostal_activation")};
  EXPECT_THAT(std::string(CheckTask(task).message()), HasSubstr("no measure is wanted"));
  task.wanted = {{Named("tidal-volume"), 0.5}};
  EXPECT_THAT(std::string(CheckTask(task).message()), HasSubstr("2 parameters are varied for 1 measure"));
  task.varied = {task.varied[0], task.varied[0]};
  EXPECT_THAT(std::string(CheckTask(task).message()), HasSubstr("diaphragm_activation is varied twice"));
  task.varied.pop_back();
  EXPECT_TRUE(CheckTask(task).ok());
}

TEST(CalibrationTask, NeedsASceneThatHasTheMeasure) {
  const auto model = CompileShipped("thorax-thesis", 20);
  const auto subject = *physiology::Subject::Of(*model);
  Task task;
  task.varied = {*ReadVaried("breath_force")};
  task.wanted = {{Named("tidal-volume"), 0.5}};
  const auto found = Calibrate(*subject, model->parameters, task, [](int, double) { return true; });
  EXPECT_EQ(found.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(found.status().message()), HasSubstr("tidal-volume: the scene has no pressures"));
}

}  // namespace
}  // namespace phrenic::calibrate
