// Paralysis of one half of the diaphragm: the presets of the generated thorax and their effect on the domes.
#include <gtest/gtest.h>

#include <cstdio>

#include "server/mechanics/step/step.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

struct Descent {
  double right = 0, left = 0;  // of the domes at the peak of inspiration [mm]
};

class Paralysis : public GeneratedThorax {
 protected:
  static Descent BreatheIn(const std::string& preset, const v1::Parameters& changes = {}) {
    v1::Parameters parameters = With(preset);
    parameters.MergeFrom(changes);
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    while (state.phase < 0.5) {
      EXPECT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok()) << preset;
    }
    const auto subject = physiology::Subject::Of(*model_);
    EXPECT_TRUE(subject.ok()) << subject.status();
    const Descent descent{DomeDescent(**subject, state, v1::SIDE_RIGHT), DomeDescent(**subject, state, v1::SIDE_LEFT)};
    std::printf("%-16s right %6.1f mm  left %6.1f mm\n", preset.c_str(), descent.right, descent.left);
    return descent;
  }
};

TEST_F(Paralysis, ADomeWithoutMuscleMovesLessThanAThirdOfTheOther) {
  const Descent right = BreatheIn("paralysis-right"), left = BreatheIn("paralysis-left");
  EXPECT_GT(right.left, 8);
  EXPECT_LT(right.right, right.left / 3);
  EXPECT_GT(left.right, 10);
  EXPECT_LT(left.left, left.right / 3);
}

TEST_F(Paralysis, IsSymmetric) {
  const Descent right = BreatheIn("paralysis-right"), left = BreatheIn("paralysis-left");
  EXPECT_NEAR(right.right, left.left, 2);
  // The right muscle is stronger: each active side moves by the same fraction of its motion in a quiet breath.
  const Descent quiet = BreatheIn("quiet");
  EXPECT_NEAR(right.left / quiet.left, left.right / quiet.right, 0.2);
}

TEST_F(Paralysis, ASniffDrawsTheParalysedDomeUp) {
  v1::Parameters changes;
  changes.set_right_activation(0);
  const Descent sniff = BreatheIn("sniff", changes);
  EXPECT_LT(sniff.right, -1);
  EXPECT_GT(sniff.left, 5);
}

TEST_F(Paralysis, DoesNotAffectOtherPresets) {
  v1::Parameters empty;
  empty.set_hyperinflation(0);
  const Descent quiet = BreatheIn("quiet"), weak = BreatheIn("COPD", empty), sniff = BreatheIn("sniff");
  EXPECT_LT(weak.right, quiet.right / 2);
  EXPECT_GT(sniff.right, 20);  // 29 +- 6 mm in men (Boussuges 2009)
  EXPECT_LT(sniff.right, 35);
}

}  // namespace
}  // namespace phrenic
