// Lungs that stay full, on the generated thorax: what the preset of COPD promises.
#include <gtest/gtest.h>

#include <cstdio>

#include "server/mechanics/step/step.h"
#include "server/physiology/thorax_metrics.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

struct Extent {
  double right = 0, left = 0;  // a dome's descent from rest [mm]
  double litres = 0;           // more in the lungs than at rest
  double sternum = 0;          // up [mm]
};

struct Breath {
  Extent out, in;  // at the end of the third expiration, and the peak of the breath after it
};

class Hyperinflated : public GeneratedThorax {
 protected:
  static Extent Measure(const State& state) {
    const auto metrics = physiology::ThoraxMetrics::Of(*model_);
    return {1e3 * metrics->DomeDescent(state, v1::SIDE_RIGHT), 1e3 * metrics->DomeDescent(state, v1::SIDE_LEFT),
            1e3 * metrics->LungVolumeChange(state).value_or(0), 1e3 * metrics->SternumShift(state)->z()};
  }

  static Breath Breathe(const v1::Parameters& parameters) {
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    const auto go_on_to = [&](double breaths) {
      while (state.time < breaths * parameters.breath_length()) {
        const absl::Status status = Step(*model_, parameters, parameters.time_step(), state, work);
        EXPECT_TRUE(status.ok()) << status;
        if (!status.ok()) break;
      }
      return Measure(state);
    };
    const Breath breath{go_on_to(3), go_on_to(3.5)};
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
  // A functional residual capacity of 2.5 l, raised to 120 to 160 %.
  EXPECT_GT(copd.out.litres - quiet.out.litres, 0.5);
  EXPECT_LT(copd.out.litres - quiet.out.litres, 1.5);
  EXPECT_LT(copd.in.right - copd.out.right, (quiet.in.right - quiet.out.right) * 0.6) << "and hardly descends";
}

TEST_F(Hyperinflated, IsStableAsFarAsTheParameterGoes) {
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
