// Writes one instant of the exported bodies as one surface file.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_

#include <string>
#include <utility>
#include <vector>

#include "server/record/recorder.h"

namespace phrenic::session {

// Keeps the last frame, and writes it at the end in a format of meshio [mm]. Bodies without triangles (networks of
// edges) are in the file only if no body has triangles, as the formats hold either. Not thread-safe.
class SurfaceRecorder final : public record::Recorder {
 public:
  // `ending` names the format: ".stl".
  SurfaceRecorder(std::string ending, record::Sink sink) : ending_(std::move(ending)), sink_(std::move(sink)) {}

  absl::Status Begin(const record::Recording& recording) override;
  absl::Status AddFrame(const record::RecordedFrame& frame) override;
  // Writes the whole file to the sink at once and reports no progress. The errors of meshio::Write and the sink.
  absl::Status End(const std::function<absl::Status(double share)>& report) override;

 private:
  const std::string ending_;
  const record::Sink sink_;
  std::vector<record::RecordedBody> bodies_;  // from Begin
  Points positions_;                          // 3 x n [m]
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_SURFACE_RECORDER_H_
