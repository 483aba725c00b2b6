// The thorax that its muscles move: each effect goes when its cause is taken away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/self_crossings.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

constexpr double kSample = 0.05;  // [s]
constexpr double kLitre = 1e-3;   // [m^3]

// The measures of a run, each at every sample.
struct Curves {
  std::map<std::string, std::vector<double>> of;
  State last;

  // The last breath of `seconds`.
  std::vector<double> Last(const std::string& name, double seconds) const {
    const std::vector<double>& all = of.at(name);
    return {all.end() - static_cast<std::ptrdiff_t>(std::lround(seconds / kSample)), all.end()};
  }
  double Range(const std::string& name, double seconds) const {
    const auto breath = Last(name, seconds);
    const auto [low, high] = std::minmax_element(breath.begin(), breath.end());
    return *high - *low;
  }
  double Least(const std::string& name, double seconds) const {
    const auto breath = Last(name, seconds);
    return *std::min_element(breath.begin(), breath.end());
  }
};

class BreathingThorax : public GeneratedThorax {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax"); }

  static Curves Run(const v1::Parameters& parameters, double seconds) {
    Curves curves;
    State& state = curves.last = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    double next = 0;
    while (state.time < seconds) {
      if (state.time >= next) {
        const EvalContext at = MakeEvalContext(*model_, parameters, state, work.scratch);
        for (const auto& measure : model_->measures) curves.of[measure->name()].push_back(measure->Value(at));
        next += kSample;
      }
      const absl::Status status = Step(*model_, parameters, parameters.time_step(), state, work);
      EXPECT_TRUE(status.ok()) << status << " at " << state.time;
      if (!status.ok()) break;
    }
    return curves;
  }
  // Of the second breath of a preset, changed.
  template <typename Change>
  static Curves Breathe(const std::string& preset, const Change& change) {
    v1::Parameters parameters = With(preset);
    change(parameters);
    return Run(parameters, 2 * parameters.breath_length());
  }
  static Curves Breathe(const std::string& preset) {
    return Breathe(preset, [](v1::Parameters&) {});
  }
  static double TidalVolume(const Curves& curves) { return curves.Range("lung volume", 4); }

  static const Curves& Quiet() {
    static const Curves& curves = *new Curves(Breathe("quiet"));
    return curves;
  }
};

TEST_F(BreathingThorax, WithoutDriveNothingMoves) {
  v1::Parameters parameters = With("quiet");
  parameters.set_diaphragm_activation(0);
  parameters.set_intercostal_activation(0);
  const Curves curves = Run(parameters, 10);
  const Eigen::Index vertices = model_->coordinates.front().vertex;  // those of coordinates follow
  EXPECT_LT((curves.last.x - model_->rest).leftCols(vertices).colwise().norm().maxCoeff(), 1e-4);
  EXPECT_LT(curves.Range("lung volume", 10), 1e-6);
}

TEST_F(BreathingThorax, QuietBreathIsThatOfAPerson) {
  const Curves& quiet = Quiet();
  EXPECT_GT(TidalVolume(quiet), 0.4 * kLitre);
  EXPECT_LT(TidalVolume(quiet), 0.7 * kLitre);
  const double share = quiet.Range("displaced by the abdomen", 4) / TidalVolume(quiet);
  EXPECT_GT(share, 0.52);
  EXPECT_LT(share, 0.75);
  EXPECT_GT(quiet.Range("transdiaphragmatic pressure", 4), 392);
  EXPECT_LT(quiet.Range("transdiaphragmatic pressure", 4), 1471);
}

TEST_F(BreathingThorax, VolumeIsTheFlowIntegrated) {
  const v1::Parameters parameters = With("quiet");
  State state = model_->InitialState();
  Workspace work = model_->MakeWorkspace();
  const auto read = [&](const std::string& name) {
    const EvalContext at = MakeEvalContext(*model_, parameters, state, work.scratch);
    const auto measure = std::find_if(model_->measures.begin(), model_->measures.end(),
                                      [&](const auto& each) { return each->name() == name; });
    return (*measure)->Value(at);
  };
  const double rest = read("lung volume");
  double integrated = 0, worst = 0, greatest = 0, flow = read("flow");
  while (state.time < 4) {
    const double before = state.time, flow_before = flow;
    ASSERT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
    flow = read("flow");
    integrated += (state.time - before) * (flow_before + flow) / 2;
    const double volume = read("lung volume") - rest;
    worst = std::max(worst, std::abs(integrated - volume));
    greatest = std::max(greatest, volume);
  }
  EXPECT_GT(greatest, 0.4 * kLitre);
  EXPECT_LT(worst, 1e-3 * greatest);
}

TEST_F(BreathingThorax, StiffLungsTakeLessAir) {
  const double stiff = TidalVolume(Breathe("quiet", [](v1::Parameters& p) { p.set_lung_compliance(0.25); }));
  EXPECT_GT(1 - stiff / TidalVolume(Quiet()), 0.25);
  EXPECT_LT(1 - stiff / TidalVolume(Quiet()), 0.6);
}

TEST_F(BreathingThorax, NarrowAirwaysMakeTheVolumeLag) {
  const Curves narrow = Breathe("quiet", [](v1::Parameters& p) { p.set_airway_resistance(10); });
  EXPECT_LT(TidalVolume(narrow), 0.8 * TidalVolume(Quiet()));
  const auto peak = [](const Curves& curves) {
    const auto last = curves.Last("lung volume", 4);
    return std::max_element(last.begin(), last.end()) - last.begin();
  };
  EXPECT_GT(peak(narrow), peak(Quiet()) + 2);
}

TEST_F(BreathingThorax, AStiffAbdomenLeavesMoreToTheRibs) {
  const Curves stiff = Breathe("quiet", [](v1::Parameters& p) { p.set_abdominal_compliance(0.3); });
  const auto share = [](const Curves& curves) {
    return curves.Range("displaced by the abdomen", 4) / TidalVolume(curves);
  };
  EXPECT_LT(share(stiff), share(Quiet()) - 0.1);
}

TEST_F(BreathingThorax, AStiffCageLeavesMoreToTheAbdomen) {
  const Curves stiff = Breathe("quiet", [](v1::Parameters& p) {
    p.set_chest_wall_compliance(0.2);
    p.set_intercostal_activation(0);
  });
  const Curves soft = Breathe("quiet", [](v1::Parameters& p) { p.set_intercostal_activation(0); });
  EXPECT_LT(stiff.Range("bucket handle", 4), 0.6 * soft.Range("bucket handle", 4));
}

TEST_F(BreathingThorax, ClosedAirwayLetsNoAirIn) {
  const Curves mueller = Breathe("mueller");
  EXPECT_LT(TidalVolume(mueller), 0.05 * kLitre);
  EXPECT_LT(mueller.Least("pleural pressure", 4), Quiet().Least("pleural pressure", 4) - 500);
}

TEST_F(BreathingThorax, AVentilatorMovesRelaxedDomesDown) {
  const Curves ventilated = Breathe("ventilator");
  EXPECT_GT(TidalVolume(ventilated), 0.5 * kLitre);
  EXPECT_LT(TidalVolume(ventilated), 1.1 * kLitre);
  EXPECT_LT(ventilated.Least("left dome", 4), -0.003);
}

TEST_F(BreathingThorax, AParalysedDomeIsDrawnUp) {
  const Curves both = Breathe("palsy-both");
  const auto top = both.Last("right dome", 4);
  EXPECT_GT(*std::max_element(top.begin(), top.end()), 0.001) << "the ribs' suction";
  const auto displaced = both.Last("displaced by the abdomen", 4);
  EXPECT_LT(*std::min_element(displaced.begin(), displaced.end()), -0.02 * kLitre);
}

// The area of the triangles whose corners all have links [m^2].
double LinkedArea(const Model& model, const Points& x) {
  std::vector<Link> links;
  model.constraints.front()->ListLinks(links);
  std::vector<bool> linked(static_cast<size_t>(x.cols()), false);
  for (const Link& link : links) linked[static_cast<size_t>(link.a)] = linked[static_cast<size_t>(link.b)] = true;
  double area = 0;
  for (const BodyModel& body : model.bodies) {
    for (const auto corner : body.mesh.triangles.colwise()) {
      if (body.first_vertex < 0) break;
      const Eigen::Vector3i at = corner.array() + body.first_vertex;
      if (!linked[at[0]] || !linked[at[1]] || !linked[at[2]]) continue;
      const Eigen::Vector3d a = x.col(at[0]), b = x.col(at[1]), c = x.col(at[2]);
      area += (b - a).cross(c - a).norm() / 2;
    }
  }
  return area;
}

TEST_F(BreathingThorax, LinksKeepTheTendonsSizeAndWithoutThemTheSniffIsWeaker) {
  const auto growth = [](bool links) {
    v1::Parameters parameters = With("deep");
    parameters.set_apply_links(links);
    const Curves half = Run(parameters, parameters.breath_length() / 2);
    return 100 * (LinkedArea(*model_, half.last.x) / LinkedArea(*model_, model_->rest) - 1);
  };
  const auto pressure = [](bool links) {
    return Breathe("sniff", [=](auto& p) { p.set_apply_links(links); }).Range("transdiaphragmatic pressure", 6) / 98.07;
  };
  const double held = growth(true), free = growth(false), with = pressure(true), without = pressure(false);
  std::printf("with and without links: the tendon grows by %.2f, %.1f %%; sniff's Pdi %.0f, %.0f cmH2O\n", held, free,
              with, without);
  EXPECT_LT(std::abs(held), 1);
  EXPECT_GT(free, 3);
  EXPECT_GT(with, 1.03 * without);
}

TEST_F(BreathingThorax, TrappedAirFillsTheLungsAndLeavesTheDomesLessToMove) {
  const Curves with = Breathe("copd"), without = Breathe("copd", [](auto&p) { p.set_trapped_air(0); });
  std::printf("COPD with and without trapped air: least volume %.2f, %.2f l; right dome %.1f, %.1f mm\n",
              with.Least("lung volume", 3.5) / kLitre, without.Least("lung volume", 3.5) / kLitre,
              1e3 * with.Range("right dome", 3.5), 1e3 * without.Range("right dome", 3.5));
  EXPECT_GT(with.Least("lung volume", 3.5), without.Least("lung volume", 3.5) + 0.1 * kLitre);
  EXPECT_LT(with.Range("right dome", 3.5), without.Range("right dome", 3.5));
}

TEST_F(BreathingThorax, ACoughIsAShutGlottisThatOpensUnderPressure) {
  const auto flow = [](const Curves& curves) { return -curves.Least("flow", 4) / kLitre; };
  const auto pressure = [](const Curves& curves) {
    const auto last = curves.Last("pleural pressure", 4);
    return *std::max_element(last.begin(), last.end());
  };
  const Curves cough = Breathe("cough"), open = Breathe("cough", [](auto&p) { p.set_glottis_share(0); }),
               weak = Breathe("cough", [](auto&p) { p.set_expiratory_activation(0); });
  std::printf("cough, with an open glottis, without abdominal muscles: %.1f, %.1f, %.1f l/s; %.0f, %.0f, %.0f Pa\n",
              flow(cough), flow(open), flow(weak), pressure(cough), pressure(open), pressure(weak));
  EXPECT_GT(flow(cough), 4);
  EXPECT_LT(pressure(open), 0.95 * pressure(cough));
  EXPECT_LT(flow(open), 0.96 * flow(cough));
  EXPECT_LT(flow(weak), 0.5 * flow(cough));
  EXPECT_LT(pressure(weak), 0.3 * pressure(cough));
}

// What makes the shut glottis raise the flow: ribs that bear the pressure. Where only the belly presses, it blows up
// the cage instead, and the air that it has moved there comes out slowly.
TEST_F(BreathingThorax, AValsalvaMovesNothingBecauseTheRibsPressToo) {
  const Curves effort = Breathe("valsalva");
  std::printf("Valsalva: %.0f Pa; pump handle %.3f; displaced by the abdomen %.3f l\n",
              effort.Range("pleural pressure", 4), effort.Range("pump handle", 4),
              effort.Range("displaced by the abdomen", 4) / kLitre);
  EXPECT_GT(effort.Range("pleural pressure", 4), 0.8 * 0.4 * 10000);
  EXPECT_LT(effort.Range("pump handle", 4), 0.1);
  EXPECT_LT(effort.Range("displaced by the abdomen", 4), 0.1 * kLitre);
}

TEST_F(BreathingThorax, ResidualVolumeIsAQuarterOfTotalCapacity) {
  const Curves breath = Breathe("vital-capacity");
  const double least = breath.Least("lung volume", 8), range = breath.Range("lung volume", 8);
  EXPECT_NEAR(least / (least + range), 0.25, 0.03);
}

// Where ribs follow the pressure instead of the muscles, more of the same drive is lost.
TEST_F(BreathingThorax, BrokenRibsAreDrawnInWhileTheOthersRise) {
  const Curves flail = Breathe("flail-chest"), whole = Breathe("flail-chest", [](auto&p) { p.set_flail_right(0); }),
               other = Breathe("flail-chest", [](auto&p) { p.set_flail_right(0), p.set_flail_left(1); });
  EXPECT_LT(flail.Least("right segment", 3), -0.05);
  EXPECT_GT(flail.Range("bucket handle", 3), 0.1);
  EXPECT_EQ(whole.Range("right segment", 3), 0);
  EXPECT_EQ(flail.Range("left segment", 3), 0);
  EXPECT_NEAR(other.Least("left segment", 3), flail.Least("right segment", 3), 0.2 * flail.Range("right segment", 3));
  EXPECT_LT(flail.Range("lung volume", 3), 0.99 * whole.Range("lung volume", 3));
}

TEST_F(BreathingThorax, AnAsymmetricCageBreathesWithOneSide) {
  const Curves bent = Breathe("kyphoscoliosis"), even = Breathe("kyphoscoliosis", [](auto&p) {
                                                   p.set_right_cage_compliance(1);
                                                   p.set_cage_tilt(0);
                                                 });
  EXPECT_LT(bent.of.at("sides apart").back(), -0.05) << "the right ribs rest lowered";
  EXPECT_GT(bent.Range("sides apart", 3), 0.01);
  EXPECT_EQ(even.Range("sides apart", 3), 0);
  EXPECT_LT(bent.Range("lung volume", 3), even.Range("lung volume", 3));
}

TEST_F(BreathingThorax, UprightLungsRestFuller) {
  v1::Parameters parameters = With("breath-hold");
  const double supine = Run(parameters, 4).of.at("lung volume").back();
  parameters.set_posture(v1::POSTURE_UPRIGHT);
  const double upright = Run(parameters, 4).of.at("lung volume").back();
  EXPECT_GT(upright - supine, 0.4 * kLitre);
  EXPECT_LT(upright - supine, 1.0 * kLitre);
}

TEST_F(BreathingThorax, NoLayerCrossesItselfInAnyBreath) {
  int seen = -1;
  for (size_t b = 0; b < model_->bodies.size(); ++b) {
    if (model_->bodies[b].name == "diaphragm") seen = static_cast<int>(b);
  }
  ASSERT_GE(seen, 0);
  // Full expiration, vital capacity and hiccup fold the crura's borders if the aorta does not fill the hiatus.
  for (const std::string preset : {"quiet", "deep", "sniff", "palsy-right", "pneumothorax-right", "ventilator",
                                   "full-expiration", "vital-capacity", "hiccup"}) {
    v1::Parameters parameters = With(preset);
    Mesh sheet = model_->bodies[static_cast<size_t>(seen)].mesh;
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    for (const double phase : {0.25, 0.5, 0.75}) {
      while (state.time < phase * parameters.breath_length()) {
        ASSERT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok()) << preset;
      }
      PlaceBody(*model_, state, seen, sheet.vertices);
      EXPECT_EQ(SelfCrossings(sheet, 0.004), 0) << preset << " at " << phase;
    }
  }
}

TEST_F(BreathingThorax, RunsRepeatBitForBit) {
  const v1::Parameters parameters = With("deep");
  EXPECT_EQ(StateHash(Run(parameters, 0.5).last), StateHash(Run(parameters, 0.5).last));
}

}  // namespace
}  // namespace phrenic
