// What files hold of a motion: every recorded frame, in order, none skipped.
#ifndef PHRENIC_SERVER_RECORD_RECORDER_H_
#define PHRENIC_SERVER_RECORD_RECORDER_H_

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::record {

// Takes the next bytes of the file; an error stops the recording.
using Sink = std::function<absl::Status(std::string_view bytes)>;

// One body as it goes into the file.
struct RecordedBody {
  std::string name;
  Mesh mesh;  // at the first frame [m]
};

// Writes one motion of one or more bodies to a sink. Not thread-safe. `Begin` once, `AddFrame` for each frame, `End`
// once.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual absl::Status Begin(const std::vector<RecordedBody>& bodies) = 0;
  // Positions of all bodies' vertices one after the other, 3 x n [m].
  virtual absl::Status AddFrame(double time, const ConstPoints& positions) = 0;
  virtual absl::Status End() = 0;
};

struct Format {
  std::string_view name;  // also the file name's ending
  std::string_view description;
  std::unique_ptr<Recorder> (*make)(Sink sink);
};

// The catalogue: one row a format.
const std::vector<Format>& Formats();

// INVALID_ARGUMENT with the names there are.
absl::StatusOr<std::unique_ptr<Recorder>> MakeRecorder(std::string_view format, Sink sink);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_RECORDER_H_
