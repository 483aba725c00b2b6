// A sniff with the right half of the diaphragm paralysed: what its pressure and the rise of the dome follow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "server/mechanics/step/step.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

constexpr double kMiddle = 8;       // edges of the middle surface [mm]: the effects are as large as at 5 mm
constexpr double kSniffEnds = 0.6;  // past the peak of the pressure [s]

struct Swing {
  double pressure = 0, rise = 0;  // of Pdi [Pa], of the right dome [mm]
};

class PalsyPressure : public testing::Test {
 protected:
  static void TearDownTestSuite() { models_.clear(); }

  // The shipped thorax with another passive stiffness of muscle [N/m].
  static const Model& Thorax(double passive) {
    std::shared_ptr<const Model>& model = models_[passive];
    if (model == nullptr) {
      v1::Scene scene = ReadShipped("thorax");
      for (v1::Force& force : *scene.mutable_forces()) {
        if (force.has_muscle()) force.mutable_muscle()->set_passive_stiffness(passive);
      }
      model = CompileScene(scene, [](const v1::Body&) { return kMiddle; });
    }
    return *model;
  }

  static v1::Parameters With(const Model& model, const std::string& preset) {
    v1::Parameters parameters = model.parameters;
    parameters.MergeFrom(*FindPreset(model.scene, preset));
    return parameters;
  }

  // Calls `look` with each moment until `seconds`.
  template <typename Look>
  static void Run(const Model& model, const v1::Parameters& parameters, double seconds, const Look& look) {
    State state = model.InitialState();
    Workspace work = model.MakeWorkspace();
    for (int i = 0; state.time < seconds; ++i) {
      if (i % 16 == 0) look(MakeEvalContext(model, parameters, state, work.scratch), state);
      ASSERT_TRUE(Step(model, parameters, parameters.time_step(), state, work).ok()) << state.time;
    }
  }

  static double Read(const Model& model, const std::string& measure, const EvalContext& at) {
    const auto found = std::find_if(model.measures.begin(), model.measures.end(),
                                    [&](const auto& each) { return each->name() == measure; });
    EXPECT_NE(found, model.measures.end()) << measure;
    return found == model.measures.end() ? 0 : (*found)->Value(at);
  }

  static Swing Sniff(const Model& model, double right_activation) {
    v1::Parameters parameters = With(model, "sniff");
    parameters.set_right_activation(right_activation);
    const auto subject = physiology::Subject::Of(model);
    EXPECT_TRUE(subject.ok()) << subject.status();
    double first = 0;
    Swing swing;
    Run(model, parameters, kSniffEnds, [&](const EvalContext& at, const State& state) {
      const double pressure = Read(model, "transdiaphragmatic pressure", at);
      if (state.time == 0) first = pressure;
      swing.pressure = std::max(swing.pressure, pressure - first);
      swing.rise = std::max(swing.rise, -DomeDescent(**subject, state, v1::SIDE_RIGHT));
    });
    return swing;
  }

  static double TidalVolume(const Model& model) {
    const v1::Parameters parameters = With(model, "quiet");
    double least = 1, greatest = 0;
    Run(model, parameters, parameters.breath_length(), [&](const EvalContext& at, const State&) {
      const double volume = Read(model, "lung volume", at);
      least = std::min(least, volume), greatest = std::max(greatest, volume);
    });
    return greatest - least;
  }

  inline static std::map<double, std::shared_ptr<const Model>> models_;
};

TEST_F(PalsyPressure, FollowsThePassiveStiffnessOfTheParalysedHalf) {
  double share = 0, rise = 1e3, healthy = 0;
  for (const double passive : {60, 250, 1000}) {
    const Swing health = Sniff(Thorax(passive), 1), palsy = Sniff(Thorax(passive), 0);
    const double of_health = palsy.pressure / health.pressure;
    std::printf("%4.0f N/m: Pdi %.0f cmH2O, with a right palsy %.0f %% of it; the dome rises by %.1f mm\n", passive,
                health.pressure / 98.0665, 100 * of_health, palsy.rise);
    EXPECT_GT(of_health, share + 0.05) << "a stiffer sheet bears more";
    EXPECT_LT(palsy.rise, 0.8 * rise) << "and gives way less";
    if (healthy == 0) healthy = health.pressure;
    EXPECT_NEAR(health.pressure, healthy, 0.1 * healthy) << "which health hardly feels";
    share = of_health, rise = palsy.rise;
  }
}

TEST_F(PalsyPressure, OfAQuietBreathDoesNotFeelThePassiveStiffness) {
  const double soft = TidalVolume(Thorax(60)), stiff = TidalVolume(Thorax(1000));
  EXPECT_NEAR(soft, stiff, 0.01 * stiff) << "active fibres are shorter than at rest";
}

TEST_F(PalsyPressure, ASlowlyRelaxingSniffMakesADomeHollow) {
  const auto hollow = [](double pause) {
    const Model& model = Thorax(250);
    v1::Parameters parameters = With(model, "sniff");
    parameters.set_right_activation(0);
    parameters.set_pause_share(pause);
    const auto subject = physiology::Subject::Of(model);
    const auto breath = physiology::Record(**subject, "sniff", parameters, [](double) { return true; });
    EXPECT_TRUE(breath.ok()) << breath.status();
    return breath->flaws[physiology::kHollow];
  };
  const double slow = hollow(0.7), shipped = hollow(With(Thorax(250), "sniff").pause_share());
  std::printf("hollow of a dome: %.2f mm, where the effort ends over 1.5 s %.2f mm\n", 1e3 * shipped, 1e3 * slow);
  EXPECT_LT(shipped, 0.7 * slow);
}

}  // namespace
}  // namespace phrenic
