// Hyperinflated lungs of the generated thorax: the preset "COPD" has low domes, high ribs and full lungs.
#include <gtest/gtest.h>

#include <cstdio>

#include "server/mechanics/step/step.h"
#include "server/physiology/bones.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

struct Extent {
  double right = 0, left = 0;  // descent of the domes from rest [mm]
  double litres = 0;           // change of lung volume from rest [l]
  double sternum = 0;          // cranial displacement [mm]
};

struct Breath {
  Extent out, in;  // at the end of the third expiration and at the next peak of inspiration
};

class Hyperinflated : public GeneratedThorax {
 protected:
  static Extent Measure(const State& state) {
    const auto subject = *physiology::Subject::Of(*model_);
    const State rest = model_->InitialState();
    const auto volume = [&](const State& at) { return physiology::LungSurfaceVolume(*model_, subject->parts, at); };
    return {DomeDescent(*subject, state, v1::SIDE_RIGHT), DomeDescent(*subject, state, v1::SIDE_LEFT),
            1e3 * (volume(state) - volume(rest)),
            1e3 * physiology::SternumShift(*model_, subject->parts, rest, state).z()};
  }

  static Breath Breathe(const v1::Parameters& parameters) {
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    const auto advance_to = [&](double breaths) {
      while (state.time < breaths * parameters.breath_length()) {
        const absl::Status status = Step(*model_, parameters, parameters.time_step(), state, work);
        EXPECT_TRUE(status.ok()) << status;
        if (!status.ok()) break;
      }
      return Measure(state);
    };
    const Breath breath{advance_to(3), advance_to(3.5)};
    for (const Extent& at : {breath.out, breath.in}) {
      std::printf("right %5.1f mm  left %5.1f mm  lungs %+.2f l  sternum %4.1f mm\n", at.right, at.left, at.litres,
                  at.sternum);
    }
    return breath;
  }
};

TEST_F(Hyperinflated, CopdBreathesFromLowDomesHighRibsAndFullLungs) {
  const Breath quiet = Breathe(With("quiet")), copd = Breathe(With("COPD"));
  EXPECT_GT(copd.out.right, quiet.out.right + 10);
  EXPECT_GT(copd.out.left, quiet.out.left + 8);
  EXPECT_GT(copd.out.sternum, 3);
  // COPD raises a functional residual capacity of 2.5 l to 120 to 160 %.
  EXPECT_GT(copd.out.litres - quiet.out.litres, 0.5);
  EXPECT_LT(copd.out.litres - quiet.out.litres, 1.5);
  EXPECT_LT(copd.in.right - copd.out.right, (quiet.in.right - quiet.out.right) * 0.8)
      << "the low domes descend little further";
}

TEST_F(Hyperinflated, IsStableOverTheParametersRange) {
  v1::Parameters parameters = With("quiet");
  double before = 0;
  for (const double h : {0.5, 1.0, 2.0}) {
    parameters.set_hyperinflation(h);
    const Extent out = Breathe(parameters).out;
    EXPECT_GT(out.litres, before + 0.1) << h;
    EXPECT_LT(out.right, 60) << h;
    before = out.litres;
  }
}

}  // namespace
}  // namespace phrenic
