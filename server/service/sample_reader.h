// One reader of a session's samples: what it selected, and its position.
#ifndef PHRENIC_SERVER_SERVICE_SAMPLE_READER_H_
#define PHRENIC_SERVER_SERVICE_SAMPLE_READER_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "google/protobuf/repeated_ptr_field.h"
#include "phrenic/v1/samples.pb.h"
#include "server/session/session.h"

namespace phrenic::service {

// What a request selects. Plain data.
struct SampleSelection {
  double interval = stream::kDefaultInterval;  // [simulated s]
  std::vector<std::size_t> places;  // in Sampler::quantities(), in the order of the values that the reader gets
};

// Returns the selection of a WatchSamplesRequest or a ReadSamplesRequest. INVALID_ARGUMENT names the measure's place in
// the request, for an unknown or repeated name, or more than 256 of them.
absl::StatusOr<SampleSelection> SelectSamples(const stream::Sampler& sampler,
                                              const google::protobuf::RepeatedPtrField<std::string>& measures,
                                              bool probes);

// Where a reader was: SampleBatch.track and SampleBatch.last. 0: nowhere yet.
struct SamplePosition {
  std::int64_t track = 0, last = 0;
};

// Not thread-safe: one thread at a time. Keeps the session, and the track of its interval, alive.
class SampleReader {
 public:
  // Begins at the present state, unless the position is of the interval's track. Calls `may_begin` before it reads the
  // present state, which waits for the step in progress. The track is kept for `keep` from now on. The errors of
  // Sampler::Track and of `may_begin`.
  static absl::StatusOr<SampleReader> Open(std::shared_ptr<session::Session> session, SampleSelection selection,
                                           const SamplePosition& position, absl::Duration keep,
                                           absl::FunctionRef<absl::Status()> may_begin);

  // Returns the samples since the last call, at most 256 of them, and sets `more` if there are further ones. Returns an
  // empty batch if there are none. Counts as attention to the session. The reason of its end once the session has ended
  // and all was read. Does not wait.
  absl::StatusOr<v1::ReadSamplesResponse> Next();

  // Keeps the track for `keep` from now on, so that another reader can go on from this one's position.
  void Keep(absl::Duration keep) const;

 private:
  SampleReader(std::shared_ptr<session::Session> session, SampleSelection selection)
      : session_(std::move(session)), selection_(std::move(selection)) {}

  void Write(const stream::Sample& sample, v1::Sample& message) const;

  std::shared_ptr<session::Session> session_;
  SampleSelection selection_;
  std::shared_ptr<const stream::SampleTrack> track_;
  std::int64_t last_ = 0;
  bool describes_ = true;         // the next batch has the quantities
  stream::SharedSample present_;  // of the first batch; null afterwards
};

// True if a batch says nothing.
bool IsEmpty(const v1::SampleBatch& batch);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SAMPLE_READER_H_
