#include "server/fit/trace_residuals.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mechanics/breath_signal.h"

namespace phrenic::fit {
namespace {

constexpr double kLengthVariation = 0.1;  // of a breath's length, between breaths (Tobin et al.: 10 to 20 %)
constexpr double kDataPerBreath = 4;
constexpr double kShareStep = 1e-4;  // of the derivatives by the shares

// Where the numbers of a time course are.
struct TimeCourse {
  int inspiratory, pause, start, offset;
};

class BreathShape {
 public:
  BreathShape(double inspiratory, double pause) {
    breath_.set_waveform(v1::WAVEFORM_RAISED_COSINE);
    parameters_.set_inspiratory_share(inspiratory);
    parameters_.set_pause_share(pause);
  }
  BreathSignal At(double phase) const { return BreathSignalAt(breath_, parameters_, phase); }

 private:
  v1::Breath breath_;
  v1::Parameters parameters_;
};

class TraceResiduals final : public Residuals {
 public:
  TraceResiduals(KindOfData kind, const TracedBreaths& breaths, Eigen::VectorXd depth, TimeCourse at)
      : Residuals(std::move(kind)),
        breaths_(breaths),
        depth_(std::move(depth)),
        at_(at),
        fitting_(SamplesOf(breaths, false)),
        held_out_(SamplesOf(breaths, true)) {
    for (const std::string& doubt : breaths.doubts) Doubt(doubt);
  }

  Rows At(const Eigen::VectorXd& numbers, Part part) const override {
    const std::vector<int>& own = part == Part::kFitting ? fitting_ : held_out_;
    const auto count = static_cast<Eigen::Index>(own.size());
    const double of_breaths = std::max(1.0, static_cast<double>(BreathsOf(breaths_, part == Part::kHeldOut).size()));
    const double per_breath = static_cast<double>(count) / of_breaths;
    const double alike = std::max(1.0, per_breath / kDataPerBreath), sd = this->kind().sd;
    Rows rows = {Eigen::VectorXd(count), Eigen::VectorXd::Constant(count, 1 / (sd * sd * alike)),
                 Eigen::MatrixXd::Zero(count, numbers.size())};
    const double in = numbers[at_.inspiratory], pause = numbers[at_.pause];
    const double depth = depth_.dot(numbers.head(depth_.size()));
    const BreathShape shape(in, pause), more(in + kShareStep, pause), less(in - kShareStep, pause),
        longer(in, pause + kShareStep), shorter(in, pause - kShareStep);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int sample = own[static_cast<size_t>(i)];
      const double phase = breaths_.phase[sample] + numbers[at_.start];
      const BreathSignal signal = shape.At(phase);
      rows.residual[i] = breaths_.value[sample] - numbers[at_.offset] - depth * signal.value;
      rows.slope.row(i).head(depth_.size()) = signal.value * depth_.transpose();
      rows.slope(i, at_.offset) = 1;
      rows.slope(i, at_.start) = depth * signal.slope;
      rows.slope(i, at_.inspiratory) = depth * (more.At(phase).value - less.At(phase).value) / (2 * kShareStep);
      rows.slope(i, at_.pause) = depth * (longer.At(phase).value - shorter.At(phase).value) / (2 * kShareStep);
    }
    return rows;
  }

  // Nothing moves at the mean of the recording.
  Eigen::VectorXd Still(Eigen::VectorXd numbers, Eigen::Index amplitudes) const override {
    numbers.head(amplitudes).setZero();
    numbers[at_.offset] = breaths_.value.mean();
    return numbers;
  }

 private:
  const TracedBreaths breaths_;
  const Eigen::VectorXd depth_;
  const TimeCourse at_;
  const std::vector<int> fitting_, held_out_;  // samples
};

class LengthResiduals final : public Residuals {
 public:
  LengthResiduals(KindOfData kind, const TracedBreaths& breaths, int at)
      : Residuals(std::move(kind)),
        fitting_(breaths.lengths(BreathsOf(breaths, false))),
        held_out_(breaths.lengths(BreathsOf(breaths, true))),
        at_(at) {}

  Rows At(const Eigen::VectorXd& numbers, Part part) const override {
    const Eigen::VectorXd& lengths = part == Part::kFitting ? fitting_ : held_out_;
    const double sd = kind().sd;
    Rows rows = {lengths.array() - numbers[at_], Eigen::VectorXd::Constant(lengths.size(), 1 / (sd * sd)),
                 Eigen::MatrixXd::Zero(lengths.size(), numbers.size())};
    rows.slope.col(at_).setOnes();
    return rows;
  }

 private:
  const Eigen::VectorXd fitting_, held_out_;  // lengths
  const int at_;
};

int FindOrAdd(const FitNumber& number, FitSpace& space) {
  const int found = space.Find(number.name);
  return found >= 0 ? found : space.Add(number);
}

TimeCourse AddTimeCourse(const KindOfData& kind, FitSpace& space) {
  TimeCourse at = {};
  at.inspiratory =
      FindOrAdd({kInspiratoryShare, "part of a breath that is inspiration", "1", 1, 0.42, 0.08, 0.1, 0.8}, space);
  at.pause = FindOrAdd(
      {kPauseShare, "part of a breath between expiration and inspiration", "1", 1, 0.1, 0.08, 0.001, 0.15}, space);
  const std::string of = absl::StrCat(" of ", kind.source);
  at.start = space.Add({absl::StrCat("beginning", of), "of an inspiration, in breaths before the recording's middle",
                        "1", 1, 0.2, 0.1, 0, 0.5});
  const double unsure = kind.unit == "l" ? 2e-5 : 1e-3;  // of the ends of expirations [m^3], [m]
  at.offset = space.Add({absl::StrCat("offset", of), "of the recording's end of expiration", kind.unit, kind.per_unit,
                         0, unsure, -100 * unsure, 100 * unsure});
  return at;
}

}  // namespace

void AddTrace(const KindOfData& kind, const TracedBreaths& breaths, const Eigen::VectorXd& depth, FitSpace& space,
              AllResiduals& all) {
  const TimeCourse at = AddTimeCourse(kind, space);
  all.push_back(std::make_unique<TraceResiduals>(kind, breaths, depth, at));
  const int length = FindOrAdd({kBreathLength, "of one breath, in and out", "s", 1, 4, 1.5, 0.5, 30}, space);
  const KindOfData lengths = {"breath lengths", kind.source, "s", 1, kLengthVariation * breaths.lengths.mean(), 1};
  all.push_back(std::make_unique<LengthResiduals>(lengths, breaths, length));
}

}  // namespace phrenic::fit
