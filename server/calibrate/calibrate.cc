#include "server/calibrate/calibrate.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/schema/fields.h"

namespace phrenic::calibrate {
namespace {

constexpr double kFirstStep = 0.2;  // of the start
constexpr double kAtBound = 1e-6;   // of the range

double Deviation(const Wanted& wanted, double got) {
  return (got - wanted.value) / std::max(std::abs(wanted.value), wanted.target->least_size);
}

SearchSpace SpaceOf(const Task& task, const v1::Parameters& start) {
  SearchSpace space;
  for (const Varied& varied : task.varied) {
    space.low.push_back(varied.low);
    space.high.push_back(varied.high);
    space.start.push_back(std::clamp(ValueOf(varied, start), varied.low, varied.high));
    space.step.push_back(std::max(kFirstStep * std::abs(space.start.back()), StepOf(varied)));
  }
  return space;
}

// Simulates and measures the breaths of one calibration.
class Breaths {
 public:
  Breaths(const physiology::Subject& subject, const v1::Parameters& start, const Task& task,
          absl::FunctionRef<bool(int, double)> progress)
      : subject_(subject), parameters_(start), task_(task), progress_(progress) {}

  // Returns the deviation of each wanted measure.
  absl::StatusOr<Numbers> Try(std::span<const double> point) {
    for (size_t i = 0; i < point.size(); ++i) SetValue(task_.varied[i], point[i], parameters_);
    const auto part = [this](double /*done*/) { return progress_(tried_, least_); };
    const auto recording =
        physiology::Record(subject_, "calibrated", parameters_, part, physiology::FlawSearch::kNever);
    if (!recording.ok()) return recording.status();
    Numbers deviations;
    for (const Wanted& wanted : task_.wanted) deviations.push_back(Measure(wanted, *recording));
    if (tried_++ == 0) {
      if (absl::Status status = CheckFirst(deviations, *recording); !status.ok()) return status;
    }
    Note(deviations);
    return deviations;
  }

 private:
  static double Measure(const Wanted& wanted, const physiology::Recording& recording) {
    if (!recording.problem.empty()) return physiology::kNone;
    return Deviation(wanted, wanted.target->scale * wanted.target->measure(recording, recording));
  }

  absl::Status CheckFirst(const Numbers& deviations, const physiology::Recording& recording) const {
    if (!recording.problem.empty()) return absl::FailedPreconditionError(recording.problem);
    for (size_t i = 0; i < deviations.size(); ++i) {
      if (std::isfinite(deviations[i])) continue;
      return absl::FailedPreconditionError(
          absl::StrCat(task_.wanted[i].target->name,
                       ": there is nothing to measure in the breath that the search begins with: begin with another "
                       "preset or parameters"));
    }
    return absl::OkStatus();
  }

  void Note(const Numbers& deviations) {
    double largest = 0;
    for (const double each : deviations) largest = std::isfinite(each) ? std::max(largest, std::abs(each)) : HUGE_VAL;
    least_ = std::min(least_, largest);
  }

  const physiology::Subject& subject_;
  v1::Parameters parameters_;
  const Task& task_;
  absl::FunctionRef<bool(int, double)> progress_;
  int tried_ = 0;
  double least_ = HUGE_VAL;
};

// Says what ended a search that did not reach the tolerance.
std::string ReasonOf(const Task& task, const Nearest& nearest) {
  if (nearest.end == Nearest::End::kTries) {
    return absl::StrCat("the limit of ", task.limits.tries, " breaths ended the search");
  }
  std::vector<std::string> bounds;
  for (size_t i = 0; i < nearest.at.size(); ++i) {
    const Varied& varied = task.varied[i];
    const double margin = kAtBound * (varied.high - varied.low);
    const bool low = nearest.at[i] <= varied.low + margin, high = nearest.at[i] >= varied.high - margin;
    if (!low && !high) continue;
    bounds.push_back(absl::StrCat(varied.field->name(), " stopped at its ", low ? "lower" : "upper", " bound ",
                                  schema::FormatNumber(low ? varied.low : varied.high)));
  }
  if (!bounds.empty()) return absl::StrJoin(bounds, "; ");
  return "no bound stopped the search: these parameters do not give these measures together";
}

Calibration Report(const Task& task, const SearchSpace& space, const Nearest& nearest) {
  Calibration found;
  for (size_t i = 0; i < task.varied.size(); ++i) {
    found.parameters.push_back({task.varied[i], space.start[i], nearest.at[i]});
  }
  for (size_t i = 0; i < task.wanted.size(); ++i) {
    const Wanted& wanted = task.wanted[i];
    const double size = std::max(std::abs(wanted.value), wanted.target->least_size);
    found.measures.push_back({wanted, wanted.value + nearest.deviations[i] * size, nearest.deviations[i]});
  }
  found.residual = nearest.largest;
  found.breaths = nearest.tries;
  found.reached = nearest.end == Nearest::End::kReached;
  if (!found.reached) found.reason = ReasonOf(task, nearest);
  return found;
}

}  // namespace

absl::Status CheckTask(const Task& task) {
  if (task.wanted.empty()) {
    return absl::InvalidArgumentError("no measure is wanted: name at least one, such as --tidal-volume 0.5");
  }
  std::set<const google::protobuf::FieldDescriptor*> fields;
  for (const Varied& varied : task.varied) {
    if (fields.insert(varied.field).second) continue;
    return absl::InvalidArgumentError(absl::StrCat(varied.field->name(), " is varied twice"));
  }
  if (task.varied.size() > task.wanted.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat(task.varied.size(), " parameters are varied for ", task.wanted.size(),
                     task.wanted.size() == 1 ? " measure" : " measures",
                     ", so that many breaths fit: want more measures, or --vary fewer parameters"));
  }
  return absl::OkStatus();
}

absl::StatusOr<Calibration> Calibrate(const physiology::Subject& subject, const v1::Parameters& start, const Task& task,
                                      absl::FunctionRef<bool(int, double)> progress) {
  if (absl::Status status = CheckTask(task); !status.ok()) return status;
  for (const Wanted& wanted : task.wanted) {
    if (physiology::Has(subject, wanted.target->needs)) continue;
    return absl::FailedPreconditionError(
        absl::StrCat(wanted.target->name, ": the scene has no ", physiology::NameOf(wanted.target->needs)));
  }
  const SearchSpace space = SpaceOf(task, start);
  Breaths breaths(subject, start, task, progress);
  const auto nearest = Search(space, task.limits, [&](std::span<const double> point) { return breaths.Try(point); });
  if (!nearest.ok()) return nearest.status();
  return Report(task, space, *nearest);
}

}  // namespace phrenic::calibrate
