// Parameters of a simulation fitted to a person's recordings: what made the data comes back within its standard error.
#include "server/calibrate/breath_fit.h"

#include <gmock/gmock.h>

#include <random>

#include "absl/strings/str_format.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic::calibrate {
namespace {

using ::testing::HasSubstr;

class FittedThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CompileShipped("thorax", 30);
    subject_ = *physiology::Subject::Of(*model_);
    const auto made = Simulated(Drive(0.1, 0.28, 0.36));
    ASSERT_TRUE(made.ok()) << made.status();
    made_ = new physiology::Recording(*made);
  }
  static void TearDownTestSuite() {
    delete made_;
    subject_.reset();
    model_.reset();
  }

  static v1::Parameters Drive(double diaphragm, double intercostals, double inspiratory_share) {
    v1::Parameters parameters = model_->parameters;
    parameters.set_breath_length(2);
    parameters.set_time_step(1.4 * parameters.time_step());  // the laws hold for coarser breaths too
    parameters.set_diaphragm_activation(diaphragm);
    parameters.set_intercostal_activation(intercostals);
    parameters.set_inspiratory_share(inspiratory_share);
    return parameters;
  }
  static absl::StatusOr<physiology::Recording> Simulated(const v1::Parameters& parameters) {
    return physiology::Record(
        *subject_, "made", parameters, [](double) { return true; }, physiology::FlawSearch::kNever);
  }

  // Eight breaths of the thorax as a file, with noise [l], [mm].
  static fit::MeasuredFile RecordingOf(fit::Measured measured, double noise, unsigned seed) {
    fit::MeasuredFile file;
    file.measured = measured;
    file.name = measured == fit::Measured::kVolume ? "spiro.csv" : "mmode.csv";
    file.bytes = measured == fit::Measured::kVolume ? "time_s,volume_l\n" : "time_s,displacement_mm\n";
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    const std::vector<double>& series =
        made_->of[measured == fit::Measured::kVolume ? physiology::kVolume : physiology::kRightApex];
    const double sign = measured == fit::Measured::kVolume ? 1 : -1;
    for (int breath = 0; breath < 8; ++breath) {
      for (size_t i = 0; i + 1 < made_->time.size(); i += 2) {
        const double value = 1000 * sign * (series[i] - series[0]) + normal(random);
        file.bytes += absl::StrFormat("%.3f,%.5f\n", 2 * breath + made_->time[i], value);
      }
    }
    return file;
  }
  static AllBreathData DataOf(const std::vector<fit::MeasuredFile>& files) {
    const auto evidence = fit::ParseEvidence(files);
    EXPECT_TRUE(evidence.ok()) << evidence.status();
    AllBreathData data;
    for (const fit::Evidence::TraceFile& file : evidence->traces) data.push_back(TraceData(file));
    return data;
  }
  static AllBreathData BothRecordings(double error_factor = 1) {
    fit::MeasuredFile volume = RecordingOf(fit::Measured::kVolume, 0.02, 5);
    fit::MeasuredFile dome = RecordingOf(fit::Measured::kMMode, 0.8, 7);
    volume.error = 0.02 * error_factor;
    dome.error = 0.8 * error_factor;
    return DataOf({volume, dome});
  }
  static absl::StatusOr<BreathFit> Fitted(const AllBreathData& data, const std::vector<std::string>& names,
                                          int iterations = 8, int threads = 0) {
    const v1::Parameters start = Drive(0.06978, 0.175, 0.42);
    std::vector<FittedParameter> parameters;
    for (const std::string& name : names) parameters.push_back(PriorOf(*ReadVaried(name), start));
    return FitBreath(*subject_, start, parameters, data, {iterations, threads},
                     [](double, const std::string&) { return true; });
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::unique_ptr<const physiology::Subject> subject_;
  inline static const physiology::Recording* made_ = nullptr;
};

TEST_F(FittedThorax, FindsWhatMadeTheRecordingsWithinItsErrors) {
  const auto fit = Fitted(BothRecordings(), {"diaphragm_activation", "intercostal_activation", "inspiratory_share"});
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_TRUE(fit->converged);
  const double truth[] = {0.1, 0.28, 0.36};
  for (size_t k = 0; k < 3; ++k) {
    const fit::FittedQuantity& each = fit->numbers[k];
    std::printf("%s: %.4f +- %.4f, made by %.4f\n", each.number.name.c_str(), each.value, each.standard_error,
                truth[k]);
    EXPECT_LT(std::abs(each.value - truth[k]), 3 * each.standard_error) << each.number.name;
    EXPECT_TRUE(each.determined) << each.number.name;
    EXPECT_LT(each.standard_error, 0.25 * truth[k]) << each.number.name;
  }
  for (const fit::KindReport& kind : fit->kinds) {
    std::printf("%s: %d data, rms %.3g %s before, %.3g after; held out %.3g of %.3g at rest\n", kind.kind.kind.c_str(),
                kind.fitting, kind.before / kind.kind.per_unit, kind.kind.unit.c_str(), kind.after / kind.kind.per_unit,
                kind.held_out_after / kind.kind.per_unit, kind.held_out_still / kind.kind.per_unit);
    EXPECT_LT(kind.after, 1.2 * kind.kind.sd);
    EXPECT_LT(kind.held_out_after, 1.25 * kind.kind.sd) << "breaths that were not fitted";
    EXPECT_GT(kind.before, 1.5 * kind.after);
    EXPECT_GT(kind.held_out, 100);
  }
  // The preset, run anew, is the breath that was fitted.
  const auto again = Simulated(fit->parameters);
  ASSERT_TRUE(again.ok());
  EXPECT_NEAR(physiology::TidalVolume(*again, *again), fit->derived[0].value, 1e-9);
  EXPECT_NEAR(physiology::TidalVolume(*again, *again), physiology::TidalVolume(*made_, *made_),
              3 * fit->derived[0].standard_error);
}

// A volume alone does not tell the diaphragm from the intercostals: they are correlated and uncertain, and say so.
TEST_F(FittedThorax, SaysWhatAVolumeCannotTell) {
  fit::MeasuredFile volume = RecordingOf(fit::Measured::kVolume, 0.02, 5);
  volume.error = 0.02;
  const std::vector<std::string> both = {"diaphragm_activation", "intercostal_activation"};
  const auto alone = Fitted(DataOf({volume}), both, 0), with_dome = Fitted(BothRecordings(), both, 0);
  ASSERT_TRUE(alone.ok() && with_dome.ok()) << alone.status() << with_dome.status();
  EXPECT_LT(alone->correlation(0, 1), -0.5);
  for (size_t k = 0; k < 2; ++k) EXPECT_LT(with_dome->numbers[k].standard_error, alone->numbers[k].standard_error);
  const auto relative = [](const fit::FittedQuantity& each) { return each.standard_error / each.value; };
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_LT(relative(alone->derived[0]), 0.5 * relative(alone->numbers[k])) << "it tells the tidal volume";
  }
}

TEST_F(FittedThorax, IsTheSameOnAnyNumberOfThreadsAndStopsWhenAsked) {
  fit::MeasuredFile volume = RecordingOf(fit::Measured::kVolume, 0.02, 5);
  const AllBreathData data = DataOf({volume});
  const std::vector<std::string> both = {"diaphragm_activation", "intercostal_activation"};
  const auto one = Fitted(data, both, 0, 1), two = Fitted(data, both, 0, 2);  // both expand at the start
  ASSERT_TRUE(one.ok() && two.ok());
  for (size_t k = 0; k < 2; ++k) EXPECT_EQ(one->numbers[k].standard_error, two->numbers[k].standard_error);
  EXPECT_EQ(one->correlation(0, 1), two->correlation(0, 1));
  const v1::Parameters start = Drive(0.07, 0.17, 0.42);
  const auto cancelled = FitBreath(*subject_, start, {PriorOf(*ReadVaried("diaphragm_activation"), start)}, data, {},
                                   [](double, const std::string&) { return false; });
  EXPECT_EQ(cancelled.status().code(), absl::StatusCode::kCancelled);
}

TEST_F(FittedThorax, StopsAtABoundAndSaysWhatCannotBeMet) {
  const AllBreathData data = BothRecordings();
  const auto fit = Fitted(data, {"diaphragm_activation:0:0.03"}, 2);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_TRUE(fit->numbers[0].at_bound);
  ASSERT_FALSE(fit->doubts.empty());
  EXPECT_THAT(fit->doubts[0], HasSubstr("cannot make this breath"));
  EXPECT_THAT(fit->doubts.back(), HasSubstr("diaphragm_activation is at its bound, 0.03"));
  EXPECT_EQ(Fitted(data, {"diaphragm_activation", "diaphragm_activation"}).status().code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(Fitted({}, {"diaphragm_activation"}).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace phrenic::calibrate
