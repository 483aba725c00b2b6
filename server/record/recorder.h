// Recorders write motions to files: every recorded frame, in order, none skipped. Viewers, which may skip frames, are
// served by server/stream.
#ifndef PHRENIC_SERVER_RECORD_RECORDER_H_
#define PHRENIC_SERVER_RECORD_RECORDER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::record {

// Receives the next bytes of the file. An error stops the recording. The recorder calls it on its own caller's thread;
// `bytes` are valid during the call.
using Sink = std::function<absl::Status(std::string_view bytes)>;

// A body in the file.
struct RecordedBody {
  std::string name;
  Mesh mesh;  // at the first frame [m]
};

// A scalar recorded with each frame, such as "tip x" [mm].
struct Column {
  std::string name, unit;  // the unit is that of the numbers, such as "mm"
};

// The vertices of a frame are those of `bodies`, in this order.
struct Recording {
  std::vector<RecordedBody> bodies;
  std::vector<Column> columns = {};
};

// Refers to its parts, which must live until AddFrame returns.
struct RecordedFrame {
  double time;                         // [s]
  const Points& positions;             // of the vertices of all bodies, concatenated (3 x n) [m]
  const std::vector<double>& numbers;  // one per column
};

// Writes one motion of one or more bodies to a sink. Call Begin once, AddFrame for each frame, End once. Methods return
// the sink's first error. Not thread-safe. Format::make makes one for each file, and an export drives it on the thread
// of its job. After an error the file is incomplete, and no further call is made.
class Recorder {
 public:
  virtual ~Recorder() = default;
  // The bodies are at the first frame, which AddFrame gets as well.
  virtual absl::Status Begin(const Recording& recording) = 0;
  // Requires: times increase, and every frame has as many positions and numbers.
  virtual absl::Status AddFrame(const RecordedFrame& frame) = 0;
  // Writes the rest. Calls `report` with the share of it that is written, in [0, 1]; an error from it cancels. A format
  // that has written everything by then does not call it. `report` runs on the calling thread.
  virtual absl::Status End(const std::function<absl::Status(double share)>& report) = 0;
};

// What the file stores for each vertex. Displacements are from the first frame.
enum class Values { kPositions, kDisplacements };

// Each recorder takes what its format needs.
struct Settings {
  Sink sink;
  Values values = Values::kPositions;  // one of Format::values, if there are any
  std::string stem = "motion";         // of file names in an archive
  std::string spool_folder = {};       // for temporary files; of .depl alone
};

// A row of the catalogue.
struct Format {
  std::string name;
  std::string ending;  // file name extension, without its dot
  std::string description;
  std::vector<Values> values = {};  // the first is the default; empty if there is no choice
  // Estimated size of the file and of the spool per vertex and frame [bytes], to reject exports that do not fit the
  // disk.
  std::int64_t file_bytes, spool_bytes;
  double frames_a_breath = 0;  // default frames per breath; 0: the default frame rate applies
  bool numbers_only = false;   // only columns, no bodies
  bool instant = false;        // only the last frame
  // A page that plays the motion (session/export/page_writer.h): every body, by default one breath. `make` is empty.
  bool page = false;
  std::function<std::unique_ptr<Recorder>(Settings settings)> make = {};
};

// The catalogue of motion formats, one row each. It lives as long as the process. Thread-safe.
const std::vector<Format>& Formats();

// Returns the format of that name. INVALID_ARGUMENT lists the known names. `formats` may have more rows than Formats().
absl::StatusOr<Format> FindFormat(const std::vector<Format>& formats, std::string_view name);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_RECORDER_H_
