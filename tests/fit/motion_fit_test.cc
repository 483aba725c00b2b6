// A breath fitted to a synthetic person, whose motion obeys another law than the fit's.
#include "server/fit/motion_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/fit/assimilation.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

class SyntheticFit : public testing::Test {
 protected:
  static const MotionFit& Fitted() {
    static const auto* const fit = new MotionFit(*FitMotion(GeneratedLungs(), SyntheticPerson(), {.assimilate = true}));
    return *fit;
  }
  static double Baseline(const MotionFit& fit, size_t i) { return fit.baselines[i].held_out.mean; }
};

TEST_F(SyntheticFit, BeatsShiftAndLineOnPointsItHasNotSeen) {
  const MotionFit& fit = Fitted();
  ASSERT_EQ(fit.baselines.size(), 5u);
  std::printf("fit %.2f, line and slope %.2f, affine %.2f, assimilated %.2f mm\n", 1e3 * fit.held_out.mean,
              1e3 * Baseline(fit, 3), 1e3 * Baseline(fit, 4), 1e3 * fit.assimilated->mean);
  EXPECT_EQ(fit.parameters.size(), 8u);
  // The person's law is nearly a line with a slope itself.
  for (size_t i = 0; i < 3; ++i) EXPECT_LT(fit.held_out.mean, Baseline(fit, i)) << fit.baselines[i].name;
  EXPECT_GT(Baseline(fit, 0), 0.004);
  EXPECT_EQ(fit.halves.held_out.size() + fit.halves.fitting.size(), 1600u);
}

TEST_F(SyntheticFit, TellsHeldOutFromFittedPoints) {
  const MotionFit& fit = Fitted();
  EXPECT_LT(fit.fitting.mean, fit.held_out.mean * 1.1);
  EXPECT_LT(fit.assimilated->mean, fit.held_out.mean);
  const double noise = 0.0005 * std::sqrt(8 / M_PI);  // the mean length of three normal deviates
  EXPECT_GT(fit.assimilated->mean, noise) << "noise of points that were not seen was predicted";
}

TEST_F(SyntheticFit, IsWorseIfTheLungsAreGluedInsteadOfSliding) {
  FitOptions glued;
  glued.elasticity.tangential = glued.elasticity.contact;
  const auto fit = FitMotion(GeneratedLungs(), SyntheticPerson(), glued);
  ASSERT_TRUE(fit.ok()) << fit.status();
  std::printf("glued %.2f mm, sliding %.2f mm\n", 1e3 * fit->held_out.mean, 1e3 * Fitted().held_out.mean);
  EXPECT_GT(fit->held_out.mean, 1.3 * Fitted().held_out.mean);
}

TEST_F(SyntheticFit, IsTheSameForTheSameRequest) {
  const auto again = FitMotion(GeneratedLungs(), SyntheticPerson(), {.assimilate = true});
  const auto other = FitMotion(GeneratedLungs(), SyntheticPerson(), {.split = 2});
  ASSERT_TRUE(again.ok() && other.ok());
  for (size_t i = 0; i < 8; ++i) EXPECT_EQ(again->parameters[i].value, Fitted().parameters[i].value);
  EXPECT_EQ(again->assimilated->p95, Fitted().assimilated->p95);
  EXPECT_NE(other->held_out.mean, Fitted().held_out.mean);
  EXPECT_NEAR(other->held_out.mean, Fitted().held_out.mean, 0.1 * Fitted().held_out.mean);
}

TEST_F(SyntheticFit, RefusesWhatIsNoBreath) {
  const auto fault = [](const Landmarks& landmarks) {
    return std::string(FitMotion(GeneratedLungs(), landmarks, {}).status().message());
  };
  Landmarks person = SyntheticPerson(99);
  EXPECT_THAT(fault(person), HasSubstr("there are 198 landmark pairs; a fit needs 200"));
  person.motion.resize(3, 0);
  EXPECT_THAT(fault(person), HasSubstr("add the columns inhale_x"));
  person = SyntheticPerson();
  person.motion(0, 0) = HUGE_VAL;
  EXPECT_THAT(fault(person), HasSubstr("not finite"));
  int asked = 0;
  const auto cancelled = FitMotion(GeneratedLungs(), SyntheticPerson(), {}, [&](double, auto) { return ++asked < 4; });
  EXPECT_EQ(cancelled.status().code(), absl::StatusCode::kCancelled);
}

TEST_F(SyntheticFit, DoubtsABreathInWhichTheLungsShrink) {
  Landmarks person = SyntheticPerson();
  person.exhale += person.motion;
  person.motion = -person.motion;
  const auto fit = FitMotion(GeneratedLungs(), person, {});
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_THAT(fit->registered.doubts, testing::Contains(HasSubstr("exchanged")));
  EXPECT_THAT(Fitted().registered.doubts, testing::Not(testing::Contains(HasSubstr("exchanged"))));
}

// The motion is the model's own here, so the fit is exact, but for its ridge of 0.1 %.
TEST_F(SyntheticFit, FindsTheAmplitudesThatMadeTheMotion) {
  Landmarks person = SyntheticPerson(400);
  const auto halves = SplitInHalves(static_cast<int>(person.size()), 1);
  const auto registered = RegisterLungs(GeneratedLungs(), person.exhale(Eigen::all, halves.fitting));
  ASSERT_TRUE(registered.ok()) << registered.status();
  const auto made = Person::Make(GeneratedLungs(), *registered, BreathAmplitudes(8), {});
  ASSERT_TRUE(made.ok()) << made.status();
  Eigen::VectorXd amplitudes(8);
  amplitudes << 11, 9, 14, 4, 2, -5, 1, 0.5;
  person.motion = (made->Responses(person.exhale) * amplitudes / 1000).reshaped(3, person.size());
  const auto fit = FitMotion(GeneratedLungs(), person, {});
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_LT(fit->held_out.mean, 0.0001);
  for (Eigen::Index i = 0; i < 8; ++i) {
    EXPECT_NEAR(1000 * fit->parameters[static_cast<size_t>(i)].value, amplitudes[i], 0.25)
        << fit->parameters[static_cast<size_t>(i)].name;
  }
  EXPECT_NEAR(fit->volume, made->VolumeResponses().dot(amplitudes) / 1000, 1e-5);
}

TEST(Assimilation, PassesThroughFewPointsAndIsLinear) {
  const auto tissue = LungTissue::Make(GeneratedLungs()[kRight].surface(), {0.014, 0.3, 5, 0});
  ASSERT_TRUE(tissue.ok()) << tissue.status();
  const Points points = PointsInside(kRight, 3), vectors = 0.002 * Points::Random(3, 3);
  const auto strong = tissue->SolveThrough(points, vectors, 1000), weak = tissue->SolveThrough(points, vectors, 0.001),
             twice = tissue->SolveThrough(points, 2 * vectors, 1000);
  ASSERT_TRUE(strong.ok() && weak.ok() && twice.ok());
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((tissue->DisplacementAt(*strong, points.col(i)) - vectors.col(i)).norm(), 2e-5);
    EXPECT_GT((tissue->DisplacementAt(*weak, points.col(i)) - vectors.col(i)).norm(), 5e-4);
  }
  EXPECT_LT((*twice - 2 * *strong).norm(), 1e-9 * strong->norm());
  EXPECT_FALSE(tissue->SolveThrough(points, Points::Constant(3, 3, std::nan("")), 1).ok());
}

TEST(OneNumber, OfVolumeAndOfDescentAreTheSameMotion) {
  const auto registered = RegisterLungs(GeneratedLungs(), SyntheticPerson().exhale);
  const auto person = Person::Make(GeneratedLungs(), *registered, BreathAmplitudes(8), {});
  ASSERT_TRUE(person.ok()) << person.status();
  const Prediction by_descent = PredictFromDescent(*person, ShippedPeople(8), 0.013);
  const auto by_volume = PredictFromVolume(*person, ShippedPeople(8), by_descent.volume);
  ASSERT_TRUE(by_volume.ok()) << by_volume.status();
  EXPECT_NEAR(by_volume->descent, 0.013, 1e-9);
  EXPECT_GT(by_descent.volume, 0.0001);
  const Points points = SyntheticPerson().exhale;
  const MotionBand band = BandAt(*person, by_descent, points);
  EXPECT_NEAR(DescentOf(person->PlacesAt(points), band.motion), 0.013, 0.003);
  EXPECT_GT(band.spread.minCoeff(), 0);
}

TEST(LeastSquares, AreExactWithoutNoiseAndUncertainWithTooFewDirections) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(300, 2);
  Points points(3, 100);
  for (int i = 0; i < 100; ++i) {
    points.col(i) = 0.02 * Eigen::Vector3d(i % 5, i / 5 % 5, i / 25);
    a(3 * i + 2, 0) = 1;
    a(3 * i + 2, 1) = 1 + 1e-3 * (i % 7);  // hardly another direction
  }
  const Eigen::Vector2d made(3, -1);
  Eigen::VectorXd u = a * made;
  EXPECT_LT((LeastSquares(a, u, 0) - made).norm(), 1e-6);
  for (int i = 0; i < 300; ++i) u[i] += 0.1 * std::sin(12.9898 * i);
  const Estimate estimate = BootstrapLeastSquares(a, u, 0, points, 1);
  EXPECT_GT(estimate.standard_error.minCoeff(), 0.5);
  EXPECT_LT(estimate.correlation(0, 1), -0.99);
  EXPECT_NEAR(estimate.correlation(0, 0), 1, 1e-9);
}

TEST(Halves, HaveEachLandmarkOnceAndDependOnTheSeedAlone) {
  const Halves halves = SplitInHalves(101, 5), again = SplitInHalves(101, 5), other = SplitInHalves(101, 6);
  EXPECT_EQ(halves.fitting.size(), 50u);
  std::vector<int> all = halves.fitting;
  all.insert(all.end(), halves.held_out.begin(), halves.held_out.end());
  std::sort(all.begin(), all.end());
  for (int i = 0; i < 101; ++i) EXPECT_EQ(all[static_cast<size_t>(i)], i);
  EXPECT_EQ(halves.fitting, again.fitting);
  EXPECT_NE(halves.fitting, other.fitting);
}

TEST(BoundaryPlace, HasWeightsThatAddToOne) {
  const Eigen::Vector3d low(-1, -1, -1), high(1, 1, 1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d normal = Eigen::Vector3d(std::sin(i), std::cos(3 * i), std::sin(7 * i + 1)).normalized();
    const BoundaryPlace place = PlaceOf({0.1, 0.2, -0.7}, normal, {low, high}, 1);
    EXPECT_NEAR(place.base + place.costal + place.medial, 1, 1e-12);
    EXPECT_GE(std::min({place.base, place.costal, place.medial}), -1e-12);
  }
}

}  // namespace
}  // namespace phrenic::fit
