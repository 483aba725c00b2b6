#include "server/calibrate/breath_data.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/fit/sides.h"

namespace phrenic::calibrate {
namespace {

using fit::Part;

constexpr double kDataPerBreath = 4;  // neighbouring samples are alike: a quarter of a breath counts as one datum

// A quantity over one breath as a periodic function of the phase, which is 0 where it crosses its middle upwards; 0 is
// its least value.
class Cycle {
 public:
  Cycle(const std::vector<double>& time, std::vector<double> value) : time_(time), value_(std::move(value)) {
    const double least = *std::min_element(value_.begin(), value_.end());
    for (double& each : value_) each -= least;
    const double middle = (fit::Quantile(value_, 0.05) + fit::Quantile(value_, 0.95)) / 2;
    for (size_t i = 1; i < value_.size(); ++i) {
      if (value_[i - 1] > middle || value_[i] <= middle) continue;
      start_ = time_[i - 1] + (time_[i] - time_[i - 1]) * (middle - value_[i - 1]) / (value_[i] - value_[i - 1]);
      break;
    }
  }

  double At(double phase) const {
    const double length = time_.back() - time_.front(), at = start_ - time_.front() + phase * length;
    const double t = time_.front() + at - length * std::floor(at / length);
    const auto after = std::upper_bound(time_.begin() + 1, time_.end() - 1, t);
    const auto k = static_cast<size_t>(after - time_.begin());
    const double share = (t - time_[k - 1]) / (time_[k] - time_[k - 1]);
    return value_[k - 1] + share * (value_[k] - value_[k - 1]);
  }

 private:
  const std::vector<double>& time_;
  std::vector<double> value_;
  double start_ = 0;
};

class TracedData final : public BreathData {
 public:
  explicit TracedData(const fit::Evidence::TraceFile& file)
      : BreathData(file.kind), breaths_(file.breaths), traced_(file.traced), side_(file.side) {
    for (const std::string& doubt : file.breaths.doubts) Doubt(doubt);
  }

  std::vector<OwnNumber> OwnNumbers() const override {
    const double unsure = traced_ == fit::Traced::kVolume ? 2e-5 : 1e-3;
    return {{absl::StrCat("shift of ", kind().source), "1", 1, 0.03},
            {absl::StrCat("offset of ", kind().source), kind().unit, kind().per_unit, unsure}};
  }

  Eigen::VectorXd Values(Part part) const override { return breaths_.value(Samples(part)); }

  Eigen::VectorXd Weights(Part part) const override {
    const auto count = static_cast<Eigen::Index>(Samples(part).size());
    const double of_breaths = std::max(1.0, static_cast<double>(BreathsOf(breaths_, part == Part::kHeldOut).size()));
    const double alike = std::max(1.0, static_cast<double>(count) / of_breaths / kDataPerBreath);
    return Eigen::VectorXd::Constant(count, 1 / (kind().sd * kind().sd * alike));
  }

  Eigen::VectorXd Predict(const physiology::Recording& breath, const Eigen::VectorXd& own, Part part,
                          Eigen::MatrixXd* slopes) const override {
    const std::vector<int> samples = Samples(part);
    const Cycle cycle(breath.time, SeriesOf(breath));
    constexpr double kStep = 1e-3;
    Eigen::VectorXd predicted(static_cast<Eigen::Index>(samples.size()));
    if (slopes != nullptr) slopes->resize(predicted.size(), 2);
    for (Eigen::Index i = 0; i < predicted.size(); ++i) {
      const double phase = breaths_.phase[samples[static_cast<size_t>(i)]] + own[0];
      predicted[i] = cycle.At(phase) + own[1];
      if (slopes == nullptr) continue;
      (*slopes)(i, 0) = (cycle.At(phase + kStep) - cycle.At(phase - kStep)) / (2 * kStep);
      (*slopes)(i, 1) = 1;
    }
    return predicted;
  }

  // Nothing moves at the mean of the recording.
  Eigen::VectorXd Still(Part part) const override {
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(Samples(part).size()), breaths_.value.mean());
  }

 private:
  std::vector<int> Samples(Part part) const { return SamplesOf(breaths_, part == Part::kHeldOut); }
  // The lungs' volume, or how far the apex of a dome has descended.
  std::vector<double> SeriesOf(const physiology::Recording& breath) const {
    if (traced_ == fit::Traced::kVolume) return breath.of[physiology::kVolume];
    std::vector<double> down = breath.of[side_ == fit::kLeft ? physiology::kLeftApex : physiology::kRightApex];
    for (double& each : down) each = -each;
    return down;
  }

  const fit::TracedBreaths breaths_;
  const fit::Traced traced_;
  const fit::Side side_;
};

class KnownData final : public BreathData {
 public:
  explicit KnownData(const KnownMeasure& known)
      : BreathData({known.target->name, known.source, known.target->unit, 1, known.error, 1}), known_(known) {}

  Eigen::VectorXd Values(Part part) const override { return Of(part, known_.value); }
  Eigen::VectorXd Weights(Part part) const override { return Of(part, 1 / (known_.error * known_.error)); }
  Eigen::VectorXd Predict(const physiology::Recording& breath, const Eigen::VectorXd& /*own*/, Part part,
                          Eigen::MatrixXd* slopes) const override {
    if (slopes != nullptr) slopes->resize(part == Part::kFitting ? 1 : 0, 0);
    return Of(part, known_.target->scale * known_.target->measure(breath, breath));
  }

 private:
  static Eigen::VectorXd Of(Part part, double value) {
    return Eigen::VectorXd::Constant(part == Part::kFitting ? 1 : 0, value);
  }
  const KnownMeasure known_;
};

}  // namespace

std::unique_ptr<BreathData> TraceData(const fit::Evidence::TraceFile& file) {
  return std::make_unique<TracedData>(file);
}

std::unique_ptr<BreathData> MeasureData(const KnownMeasure& known) { return std::make_unique<KnownData>(known); }

}  // namespace phrenic::calibrate
