#include "server/service/sample_reader.h"

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic::service {
namespace {

constexpr int kMostNames = 256;
constexpr std::size_t kMostSamples = 256;  // of one batch
constexpr std::size_t kQuotedBytes = 64;   // of an unknown name

// Returns "there is no measure x; the scene has a, b".
std::string UnknownMeasure(const stream::Sampler& sampler, const std::string& name) {
  std::vector<std::string> known;
  for (const v1::SampledQuantity& quantity : sampler.quantities()) {
    if (quantity.kind() == v1::SampledQuantity::KIND_MEASURE) known.push_back(quantity.name());
  }
  return absl::StrCat("there is no measure \"", name.substr(0, kQuotedBytes), "\"; the scene has ",
                      known.empty() ? "none" : absl::StrJoin(known, ", "));
}

}  // namespace

absl::StatusOr<SampleSelection> SelectSamples(const stream::Sampler& sampler,
                                              const google::protobuf::RepeatedPtrField<std::string>& measures,
                                              bool probes) {
  if (measures.size() > kMostNames) {
    return absl::InvalidArgumentError(
        absl::StrCat("measures: ", measures.size(), " names, at most ", kMostNames, " are allowed"));
  }
  const std::vector<v1::SampledQuantity>& known = sampler.quantities();
  SampleSelection selection;
  std::set<std::size_t> seen;
  for (int i = 0; i < measures.size(); ++i) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const v1::SampledQuantity& each) {
      return each.kind() == v1::SampledQuantity::KIND_MEASURE && each.name() == measures[i];
    });
    const auto place = static_cast<std::size_t>(found - known.begin());
    if (found == known.end()) {
      return absl::InvalidArgumentError(absl::StrCat("measures[", i, "]: ", UnknownMeasure(sampler, measures[i])));
    }
    if (!seen.insert(place).second) {
      return absl::InvalidArgumentError(absl::StrCat("measures[", i, "]: \"", measures[i], "\" is named twice"));
    }
    selection.places.push_back(place);
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    const bool wanted = known[i].kind() == v1::SampledQuantity::KIND_PROBE ? probes : measures.empty();
    if (wanted) selection.places.push_back(i);
  }
  return selection;
}

absl::StatusOr<SampleReader> SampleReader::Open(std::shared_ptr<session::Session> session, SampleSelection selection,
                                                const SamplePosition& position, absl::Duration keep,
                                                absl::FunctionRef<absl::Status()> may_begin) {
  auto found = session->sampler().Track(selection.interval, keep);
  if (!found.ok()) return found.status();
  SampleReader reader(std::move(session), std::move(selection));
  reader.track_ = *std::move(found);
  reader.describes_ = reader.track_->id() != position.track;
  reader.last_ = reader.describes_ ? reader.track_->newest() : position.last;
  if (!reader.describes_) return reader;
  if (absl::Status may = may_begin(); !may.ok()) return may;
  const auto present = reader.session_->ReadState();
  if (present.ok()) {
    reader.present_ = std::make_shared<const stream::Sample>(
        reader.session_->sampler().Evaluate(present->parameters, present->state()));
  } else if (!absl::IsFailedPrecondition(present.status())) {  // else it has diverged: there is no present state
    return present.status();
  }
  return reader;
}

absl::StatusOr<v1::ReadSamplesResponse> SampleReader::Next() {
  session_->NoteAttention();
  const std::optional<absl::Status> ended = session_->sampler().closed();  // before the last samples are read
  const stream::SampleTrack::Part part = track_->Read(last_, kMostSamples);
  if (ended.has_value() && part.samples.empty()) return *ended;
  v1::ReadSamplesResponse response;
  response.set_more(part.more);
  v1::SampleBatch& batch = *response.mutable_batch();
  if (std::exchange(describes_, false)) {
    for (const std::size_t place : selection_.places) *batch.add_quantities() = session_->sampler().quantities()[place];
  }
  for (const stream::SharedSample& sample : part.samples) Write(*sample, *batch.add_samples());
  const stream::SharedSample present = std::exchange(present_, nullptr);
  if (present != nullptr && part.samples.empty()) Write(*present, *batch.mutable_present());
  batch.set_left_out(part.left_out);
  batch.set_track(track_->id());
  batch.set_last(last_ = part.last);
  return response;
}

void SampleReader::Keep(absl::Duration keep) const {
  session_->sampler().Track(selection_.interval, keep).status().IgnoreError();  // the session may have ended
}

void SampleReader::Write(const stream::Sample& sample, v1::Sample& message) const {
  message.set_tick(sample.tick);
  message.set_time(sample.time);
  message.set_breath(sample.breath);
  message.mutable_values()->Reserve(static_cast<int>(selection_.places.size()));
  for (const std::size_t place : selection_.places) message.add_values(sample.values[place]);
}

bool IsEmpty(const v1::SampleBatch& batch) {
  return batch.samples().empty() && batch.quantities().empty() && batch.left_out() == 0;
}

}  // namespace phrenic::service
