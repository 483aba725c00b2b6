#include "server/stream/sampler.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/skinning/probe_position.h"

namespace phrenic::stream {
namespace {

v1::SampledQuantity Quantity(v1::SampledQuantity::Kind kind, const std::string& name, const std::string& unit) {
  v1::SampledQuantity quantity;
  quantity.set_kind(kind);
  quantity.set_name(name);
  quantity.set_unit(unit);
  return quantity;
}

std::vector<v1::SampledQuantity> QuantitiesOf(const Model& model) {
  std::vector<v1::SampledQuantity> quantities;
  for (const auto& measure : model.measures) {
    quantities.push_back(Quantity(v1::SampledQuantity::KIND_MEASURE, measure->name(), measure->unit()));
  }
  for (const Probe& probe : model.probes) {
    quantities.push_back(Quantity(v1::SampledQuantity::KIND_PROBE, probe.name, "m"));
  }
  return quantities;
}

}  // namespace

Sampler::Sampler(std::shared_ptr<const Model> model, const Clock& clock)
    : model_(std::move(model)), clock_(clock), quantities_(QuantitiesOf(*model_)) {}

absl::StatusOr<std::shared_ptr<const SampleTrack>> Sampler::Track(double interval, absl::Duration keep) {
  const absl::Time now = clock_.Now();
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return *closed_;
  for (Entry& entry : tracks_) {
    if (entry.track->interval() != interval) continue;
    entry.kept_until = std::max(entry.kept_until, now + keep);
    return entry.track;
  }
  DropUnread();
  const auto others = std::count_if(tracks_.begin(), tracks_.end(),
                                    [](const Entry& entry) { return entry.track->interval() != kDefaultInterval; });
  if (interval != kDefaultInterval && others >= static_cast<std::ptrdiff_t>(kMostTracks)) {
    return absl::ResourceExhaustedError(absl::StrCat("interval: the session is sampled at ", others,
                                                     " other intervals, and no more are allowed; use the default of ",
                                                     kDefaultInterval, " s, or try again later"));
  }
  last_id_ = std::max(last_id_ + 1, absl::ToUnixNanos(now));
  tracks_.push_back({std::make_shared<SampleTrack>(last_id_, interval), now + keep});
  next_due_ = -std::numeric_limits<double>::infinity();
  return tracks_.back().track;
}

Sample Sampler::Evaluate(const v1::Parameters& parameters, const State& state) const {
  const EvalContext at = MakeEvalContext(*model_, parameters, state);
  Sample sample{.tick = state.tick, .time = state.time, .breath = at.breath, .values = {}};
  sample.values.reserve(quantities_.size());
  for (const v1::MeasureReading& reading : ReadMeasures(*model_, at)) sample.values.push_back(reading.value());
  for (const Probe& probe : model_->probes) {
    const Eigen::Vector3d rest = model_->bodies[probe.body].mesh.vertices.col(probe.vertex);
    sample.values.push_back(ProbePosition(*model_, state, probe).z() - rest.z());
  }
  return sample;
}

void Sampler::Take(const v1::Parameters& parameters, const State& state) {
  absl::MutexLock lock(&mutex_);
  DropUnread();
  SharedSample sample;
  double next = std::numeric_limits<double>::infinity();
  for (const Entry& entry : tracks_) {
    if (entry.track->Reaches(state.time, parameters.time_step())) {
      if (sample == nullptr) {
        sample = std::make_shared<const Sample>(Evaluate(parameters, state));
        ++evaluations_;
      }
      entry.track->Put(sample);
    }
    next = std::min(next, entry.track->next_due());
  }
  next_due_ = next;
}

void Sampler::Restart(const v1::Parameters& parameters, const State& state) {
  {
    absl::MutexLock lock(&mutex_);
    for (const Entry& entry : tracks_) entry.track->Restart();
  }
  Take(parameters, state);
}

void Sampler::DropUnread() {
  const absl::Time now = clock_.Now();
  std::erase_if(tracks_, [now](const Entry& entry) { return entry.kept_until < now && entry.track.use_count() == 1; });
}

void Sampler::Close(const absl::Status& reason) {
  absl::MutexLock lock(&mutex_);
  if (!closed_.has_value()) closed_ = reason;
}

std::optional<absl::Status> Sampler::closed() const {
  absl::MutexLock lock(&mutex_);
  return closed_;
}

}  // namespace phrenic::stream
