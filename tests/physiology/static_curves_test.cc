#include "server/physiology/static_curves.h"

#include <algorithm>
#include <cmath>

#include "server/mechanics/measures/readings.h"
#include "server/mechanics/step/step.h"
#include "server/physiology/health_ranges.h"
#include "server/physiology/rows.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic::physiology {
namespace {

// Returns the pressure of a curve at a volume [Pa].
double PressureAt(const v1::StaticCurve& curve, double volume) {
  int i = 1;
  while (i + 1 < curve.volumes_size() && curve.volumes(i) < volume) ++i;
  const double part = (volume - curve.volumes(i - 1)) / (curve.volumes(i) - curve.volumes(i - 1));
  return curve.pressures(i - 1) + part * (curve.pressures(i) - curve.pressures(i - 1));
}

class StaticCurvesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { model_ = CompileShipped("thorax", 16); }
  static void TearDownTestSuite() { model_ = nullptr; }

  // Holds relaxed lungs at an airway pressure [Pa] until they are at rest. Returns volume and pleural pressure.
  static std::pair<double, double> Inflated(v1::Parameters parameters, double pressure) {
    parameters.set_breath_force(0);
    parameters.set_airway_pressure(pressure);
    State state = model_->InitialState();
    Workspace work = model_->MakeWorkspace();
    while (state.time < 6) EXPECT_TRUE(Step(*model_, parameters, parameters.time_step(), state, work).ok());
    std::pair<double, double> found;
    for (const auto& reading : ReadMeasures(*model_, MakeEvalContext(*model_, parameters, state))) {
      if (reading.name() == "lung volume") found.first = reading.value();
      if (reading.name() == "pleural pressure") found.second = reading.value();
    }
    return found;
  }

  static std::shared_ptr<const Model> model_;
};

std::shared_ptr<const Model> StaticCurvesTest::model_;

TEST_F(StaticCurvesTest, RelaxedLungsAreOnTheCurves) {
  for (const double compliance : {1.0, 0.6}) {
    v1::Parameters parameters = model_->parameters;
    parameters.set_lung_compliance(compliance);
    const auto curves = StaticCurves(model_->scene, parameters);
    ASSERT_EQ(curves.size(), 2u);
    const auto [volume, pleural] = Inflated(parameters, 800);
    EXPECT_GT(volume, 0.0027);
    EXPECT_NEAR(pleural - 800, PressureAt(curves[0], volume), 20) << "lungs at " << volume;
    RecordProperty("volume", std::to_string(volume));
    // The wall's curve leaves out the tension of the diaphragm.
    EXPECT_NEAR(pleural, PressureAt(curves[1], volume), 250) << "chest wall at " << volume;
  }
}

TEST_F(StaticCurvesTest, TheCurvesMeetAtTheRestVolume) {
  const auto curves = StaticCurves(model_->scene, model_->parameters);
  const double rest = ThoraxPressuresOf(model_->scene)->lungs().rest_volume();
  EXPECT_NEAR(PressureAt(curves[0], rest), PressureAt(curves[1], rest), 10);
  for (const v1::StaticCurve& curve : curves) {
    EXPECT_TRUE(std::is_sorted(curve.volumes().begin(), curve.volumes().end()));
    for (const double pressure : curve.pressures()) EXPECT_TRUE(std::isfinite(pressure));
  }
  EXPECT_TRUE(std::is_sorted(curves[0].pressures().rbegin(), curves[0].pressures().rend()));
  EXPECT_TRUE(std::is_sorted(curves[1].pressures().begin(), curves[1].pressures().end()));
}

TEST_F(StaticCurvesTest, ASofterWallMovesMoreForItsPressure) {
  v1::Parameters soft = model_->parameters;
  soft.set_chest_wall_compliance(3);
  const double volume = 0.0035;
  EXPECT_LT(PressureAt(StaticCurves(model_->scene, soft)[1], volume),
            PressureAt(StaticCurves(model_->scene, model_->parameters)[1], volume) - 50);
}

TEST_F(StaticCurvesTest, RangesOfHealthAreRowsOfTheTable) {
  const auto ranges = HealthRanges(model_->scene);
  const auto found = std::find_if(ranges.begin(), ranges.end(),
                                  [](const auto& range) { return range.what() == std::string("tidal volume"); });
  ASSERT_NE(found, ranges.end());
  const auto rows = RowsOfHealth();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) {
    return each.breath == found->breath() && each.what == found->what();
  });
  ASSERT_NE(row, rows.end());
  EXPECT_DOUBLE_EQ(found->low(), 1e-3 * row->low);
  EXPECT_DOUBLE_EQ(found->high(), 1e-3 * row->high);
  for (const v1::HealthRange& range : ranges) {
    EXPECT_GT(range.high(), range.low()) << range.what();
    EXPECT_NE(range.change(), v1::HealthRange::CHANGE_UNSPECIFIED) << range.what();
  }
  // Each measure over time that a student sees has a range of a quiet breath.
  for (const char* measure : {"lung volume", "pleural pressure", "right dome"}) {
    EXPECT_TRUE(std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) {
      return range.measure() == measure && range.breath() == "quiet";
    })) << measure;
  }
}

TEST(StaticCurves, OtherScenesHaveNone) {
  EXPECT_TRUE(StaticCurves(v1::Scene(), v1::Parameters()).empty());
  EXPECT_TRUE(HealthRanges(v1::Scene()).empty());
}

}  // namespace
}  // namespace phrenic::physiology
