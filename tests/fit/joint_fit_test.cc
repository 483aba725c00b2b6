// Fits to several kinds of data together: the truth comes back within its standard error, more data never make a number
// less certain, data without weight change nothing.
#include "server/fit/joint_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fit/person_truth.h"

namespace phrenic::fit {
namespace {

using testing::Contains;
using testing::HasSubstr;

JointFit JointlyFitted(const std::vector<MeasuredFile>& files) {
  const auto evidence = ParseEvidence(files);
  EXPECT_TRUE(evidence.ok()) << evidence.status();
  auto fit = FitJointly(GeneratedLungs(), *evidence, {});
  EXPECT_TRUE(fit.ok()) << fit.status();
  return *std::move(fit);
}

MeasuredFile WithError(MeasuredFile file, double error) {
  file.error = error;
  return file;
}

const FittedQuantity& NumberOf(const JointFit& fit, const std::string& name) {
  for (const auto* list : {&fit.numbers, &fit.derived}) {
    for (const FittedQuantity& each : *list) {
      if (each.number.name == name) return each;
    }
  }
  ADD_FAILURE() << "no number " << name;
  return fit.numbers.front();
}

// The posterior's covariance of the amplitudes.
Eigen::MatrixXd CovarianceOf(const JointFit& fit) {
  Eigen::VectorXd errors(8);
  for (int k = 0; k < 8; ++k) errors[k] = fit.numbers[static_cast<size_t>(k)].standard_error;
  return errors.asDiagonal() * fit.correlation.topLeftCorner(8, 8) * errors.asDiagonal();
}

// Checks every amplitude, and all together: chi-squared of 8 numbers exceeds 26 once in a thousand.
void ExpectTruth(const JointFit& fit, const char* what) {
  const Eigen::VectorXd& truth = PersonTruth::One().amplitudes();
  Eigen::VectorXd off(8);
  for (int k = 0; k < 8; ++k) {
    const FittedQuantity& each = fit.numbers[static_cast<size_t>(k)];
    off[k] = each.value - truth[k];
    EXPECT_LT(std::abs(off[k]), 3 * each.standard_error) << what << ": " << each.number.name;
    EXPECT_LT(each.standard_error, 1.001 * each.number.sd) << what << ": " << each.number.name;
  }
  const double chi = off.dot(CovarianceOf(fit).ldlt().solve(off));
  std::printf("%s: chi-squared %.2f of 8\n", what, chi);
  EXPECT_LT(chi, 26) << what;
}

std::vector<std::vector<MeasuredFile>> EachKind() {
  const PersonTruth& truth = PersonTruth::One();
  const MeasuredFile exhale = truth.Exhale();
  return {{exhale, truth.Landmarks(0.0015)},
          {exhale, truth.Surface(Measured::kLungs, false, 0.001), truth.Surface(Measured::kLungs, true)},
          {exhale, truth.Surface(Measured::kDiaphragm, false, 0.001)},
          {exhale, truth.Volume()},
          {exhale, truth.MarkersOf(0.002)}};
}

TEST(JointFit, GivesTheTruthBackWithinItsErrorForEachKind) {
  for (const auto& files : EachKind()) ExpectTruth(JointlyFitted(files), files[1].name.c_str());
}

TEST(JointFit, MakesWhatAKindTellsMoreCertain) {
  const PersonTruth& truth = PersonTruth::One();
  const JointFit landmarks = JointlyFitted({truth.Exhale(), truth.Landmarks(0.0015)});
  for (const char* name : {"piston-right", "piston-left", "tilt-front-back"}) {
    EXPECT_TRUE(NumberOf(landmarks, name).determined) << name;
  }
  const JointFit volume = JointlyFitted({truth.Exhale(), truth.Volume()});
  EXPECT_TRUE(NumberOf(volume, "tidal volume").determined);
  EXPECT_FALSE(NumberOf(volume, "tilt-left-right").determined) << "a spirogram cannot tell it";
  EXPECT_NEAR(NumberOf(volume, "tidal volume").value, truth.volume(),
              3 * NumberOf(volume, "tidal volume").standard_error);
}

TEST(JointFit, ReadsTheTimeCourseOffARecording) {
  const PersonTruth& truth = PersonTruth::One();
  const JointFit fit = JointlyFitted({truth.Exhale(), truth.Volume()});
  EXPECT_NEAR(fit.breath_length, 4.4, 0.05);
  EXPECT_NEAR(fit.inspiratory_share, 0.4, 3 * NumberOf(fit, "inspiratory share").standard_error);
  EXPECT_NEAR(fit.pause_share, 0.08, 3 * NumberOf(fit, "pause").standard_error);
  EXPECT_NEAR(NumberOf(fit, "rate").value, 60 / 4.4, 0.2);
  EXPECT_NEAR(NumberOf(fit, "E:I").value, 1.5, 3 * NumberOf(fit, "E:I").standard_error);
}

TEST(JointFit, OfADomesDescentMovesThatSide) {
  const PersonTruth& truth = PersonTruth::One();
  const double descent = NumberOf(JointlyFitted({truth.Exhale(), truth.Landmarks(0.0001)}), "right dome").value;
  for (const Side side : {kRight, kLeft}) {
    MeasuredFile file = truth.Trace(Measured::kMMode, 2 * descent, 0.0005);
    file.side = side;
    const JointFit fit = JointlyFitted({truth.Exhale(), file});
    const char* own = side == kRight ? "right dome" : "left dome";
    EXPECT_NEAR(NumberOf(fit, own).value, 2 * descent, 3 * NumberOf(fit, own).standard_error);
    EXPECT_TRUE(NumberOf(fit, own).determined);
    EXPECT_LT(NumberOf(fit, own).standard_error,
              NumberOf(fit, side == kRight ? "left dome" : "right dome").standard_error);
  }
}

TEST(JointFit, OfMoreKindsIsNeverLessCertain) {
  std::vector<MeasuredFile> files = {PersonTruth::One().Exhale()};
  std::vector<double> errors;
  for (const auto& kind : EachKind()) {
    if (kind[1].measured == Measured::kDiaphragm) continue;  // the same surface twice
    files.insert(files.end(), kind.begin() + 1, kind.end());
    const JointFit fit = JointlyFitted(files);
    for (size_t k = 0; k < 8; ++k) {
      const double error = fit.numbers[k].standard_error;
      if (errors.size() == 8) {
        EXPECT_LE(error, 1.0001 * errors[k]) << kind[1].name << ": " << fit.numbers[k].number.name;
      }
    }
    errors.clear();
    for (size_t k = 0; k < 8; ++k) errors.push_back(fit.numbers[k].standard_error);
  }
  ExpectTruth(JointlyFitted(files), "all kinds");
}

TEST(JointFit, IsUnchangedByDataWithoutWeight) {
  const PersonTruth& truth = PersonTruth::One();
  const std::vector<MeasuredFile> files = {truth.Exhale(), truth.Landmarks(0.0015)};
  const JointFit alone = JointlyFitted(files);
  std::vector<MeasuredFile> others = {truth.Surface(Measured::kLungs, false), truth.Trace(Measured::kVolume, 0.002, 0),
                                      truth.Trace(Measured::kMMode, 0.05, 0), truth.MarkersOf(0.01)};
  for (MeasuredFile& other : others) {
    std::vector<MeasuredFile> both = files;
    both.push_back(WithError(std::move(other), 1e8));
    const JointFit fit = JointlyFitted(both);
    for (size_t k = 0; k < 8; ++k) {
      EXPECT_NEAR(fit.numbers[k].value, alone.numbers[k].value, 1e-7) << both.back().name;
      EXPECT_NEAR(fit.numbers[k].standard_error, alone.numbers[k].standard_error, 1e-7) << both.back().name;
    }
  }
}

TEST(JointFit, OfNothingThatMovesIsThePrior) {
  const PersonTruth& truth = PersonTruth::One();
  const JointFit fit = JointlyFitted({truth.Exhale(), WithError(truth.Volume(), 1e8)});
  for (size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(fit.numbers[k].value, fit.numbers[k].number.mean, 1e-7);
    EXPECT_NEAR(fit.numbers[k].standard_error, fit.numbers[k].number.sd, 1e-7);
    EXPECT_FALSE(fit.numbers[k].determined);
  }
}

TEST(JointFit, FindsTheDepthOfOtherPhases) {
  const PersonTruth& truth = PersonTruth::One();
  MeasuredFile early = truth.Landmarks(0.001, 2, 0.35), late = truth.Landmarks(0.001, 2, 0.8);
  early.phase = 0.4;
  late.phase = 1.3;
  const JointFit fit = JointlyFitted({truth.Exhale(), truth.Landmarks(0.001), early, late});
  ExpectTruth(fit, "three phases");
  const FittedQuantity &first = NumberOf(fit, "depth at phase 0.4"), &second = NumberOf(fit, "depth at phase 1.3");
  EXPECT_NEAR(first.value, 0.35, 3 * first.standard_error);
  EXPECT_NEAR(second.value, 0.8, 3 * second.standard_error);
  EXPECT_TRUE(second.determined);
}

TEST(JointFit, SaysHowWellEachKindIsMet) {
  const PersonTruth& truth = PersonTruth::One();
  const JointFit fit = JointlyFitted({truth.Exhale(), truth.Landmarks(0.0015), truth.Volume(), truth.MarkersOf(0.002)});
  for (const KindReport& each : fit.kinds) {
    EXPECT_GT(each.fitting, 0) << each.kind.kind;
    if (each.kind.kind == "breath lengths") continue;
    EXPECT_LT(each.after, each.before) << each.kind.kind;
    EXPECT_LT(each.after, each.still) << each.kind.kind;
    if (each.held_out > 0) {
      EXPECT_LT(each.held_out_after, each.held_out_still) << each.kind.kind;
    }
  }
  EXPECT_EQ(fit.motion.baselines.size(), 5u);
  EXPECT_LT(fit.motion.held_out.mean, fit.motion.baselines[2].held_out.mean);
  EXPECT_EQ(fit.motion.halves.held_out.size(), 400u);
}

TEST(JointFit, GivesTheSameBitsForTheSameData) {
  const std::vector<MeasuredFile> files = {PersonTruth::One().Exhale(),
                                           PersonTruth::One().Surface(Measured::kDiaphragm, false),
                                           PersonTruth::One().Volume()};
  const JointFit one = JointlyFitted(files), two = JointlyFitted(files);
  for (size_t k = 0; k < one.numbers.size(); ++k) EXPECT_EQ(one.numbers[k].value, two.numbers[k].value);
}

TEST(JointFit, WithoutPointsHasTheScenesLungsAndSaysSo) {
  const JointFit fit = JointlyFitted({PersonTruth::One().Volume()});
  EXPECT_FALSE(fit.own_lungs);
  EXPECT_THAT(fit.motion.registered.doubts, Contains(HasSubstr("the scene's own")));
  EXPECT_NEAR(NumberOf(fit, "tidal volume").value, PersonTruth::One().volume(), 1e-4);
}

TEST(JointFit, DoubtsDataThatContradictEachOther) {
  const PersonTruth& truth = PersonTruth::One();
  const JointFit fit =
      JointlyFitted({truth.Exhale(), truth.Landmarks(0.0005), truth.Trace(Measured::kVolume, 0.003, 0)});
  EXPECT_THAT(fit.motion.registered.doubts, Contains(HasSubstr("contradict")));
}

std::string RefusalOfJoint(const std::vector<MeasuredFile>& files) {
  const auto evidence = ParseEvidence(files);
  if (!evidence.ok()) return std::string(evidence.status().message());
  return std::string(FitJointly(GeneratedLungs(), *evidence, {}).status().message());
}

TEST(JointFit, RefusesDataInAnotherUnitOrFrame) {
  const PersonTruth& truth = PersonTruth::One();
  const auto scaled = [](MeasuredFile file, double scale) {
    Mesh mesh = *meshio::Parse(file.name, file.bytes, 0.001);
    file.bytes = *meshio::Write(file.name, mesh, 0.001 / scale);
    return file;
  };
  const MeasuredFile surface = truth.Surface(Measured::kDiaphragm, false);
  EXPECT_THAT(RefusalOfJoint({truth.Exhale(), scaled(surface, 0.001)}), HasSubstr("moved.obj: extends 0."));
  EXPECT_THAT(RefusalOfJoint({truth.Exhale(), scaled(surface, 0.001)}), HasSubstr("multiply metres by 1000"));
  MeasuredFile elsewhere = surface;
  Mesh far = *meshio::Parse(surface.name, surface.bytes, 0.001);
  far.vertices.row(2).array() += 0.5;
  elsewhere.bytes = *meshio::Write(surface.name, far, 0.001);
  EXPECT_THAT(RefusalOfJoint({truth.Exhale(), elsewhere}), HasSubstr("in the frame of the other data"));
  MeasuredFile few = truth.Landmarks(0.001, 20);
  few.bytes = few.bytes.substr(0, few.bytes.find('\n') + 1) + "900,900,900,900,900,890\n";
  EXPECT_THAT(RefusalOfJoint({few}), HasSubstr("outside the lungs"));
  EXPECT_THAT(RefusalOfJoint({truth.Exhale()}), HasSubstr("there is nothing to fit"));
  EXPECT_THAT(RefusalOfJoint({truth.Surface(Measured::kLungs, true)}), HasSubstr("the one at end inhale is missing"));
  EXPECT_THAT(RefusalOfJoint({WithError(surface, -1)}), HasSubstr("its error must be between"));
  MeasuredFile phased = truth.Landmarks(0.001);
  phased.phase = 2.5;
  EXPECT_THAT(RefusalOfJoint({phased}), HasSubstr("its phase must be"));
}

TEST(JointFit, CanBeCancelled) {
  const auto evidence = ParseEvidence({PersonTruth::One().Exhale(), PersonTruth::One().Volume()});
  ASSERT_TRUE(evidence.ok());
  for (const double until : {0.0, 0.3, 0.8}) {
    const auto fit = FitJointly(GeneratedLungs(), *evidence, {}, [&](double done, auto) { return done < until; });
    EXPECT_EQ(fit.status().code(), absl::StatusCode::kCancelled) << until;
  }
}

}  // namespace
}  // namespace phrenic::fit
