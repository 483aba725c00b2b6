// What an export records into.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_MOTION_WRITER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_MOTION_WRITER_H_

#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "server/session/run.h"

namespace phrenic::session {

// Writes the states of one run to a file. Call Begin once, AddFrame for each recorded state, the first included, and
// End once. Methods return the first error of the file. Not thread-safe: ExportMotion drives it on the thread of its
// job.
class MotionWriter {
 public:
  virtual ~MotionWriter() = default;
  // Requires: `run` is at the first recorded state.
  virtual absl::Status Begin(const Run& run) = 0;
  // Requires: `run` is the run of Begin at a later time, or at the first.
  virtual absl::Status AddFrame(const Run& run) = 0;
  // As record::Recorder::End.
  virtual absl::Status End(const std::function<absl::Status(double share)>& report) = 0;
  // Returns the number of vertices in a frame.
  virtual std::int64_t vertices() const = 0;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_MOTION_WRITER_H_
