// What files hold of a motion: every recorded frame, in order, none skipped.
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

// Takes the next bytes of the file; an error stops the recording.
using Sink = std::function<absl::Status(std::string_view bytes)>;

// One body as it goes into the file.
struct RecordedBody {
  std::string name;
  Mesh mesh;  // at the first frame [m]
};

// A number beside the positions: "tip x" [mm].
struct Column {
  std::string name, unit;
};

struct Recording {
  std::vector<RecordedBody> bodies;
  std::vector<Column> columns = {};
};

struct RecordedFrame {
  double time;                         // [s]
  const Points& positions;             // of all bodies' vertices one after the other, 3 x n [m]
  const std::vector<double>& numbers;  // one a column
};

// Writes one motion of one or more bodies to a sink. Not thread-safe. `Begin` once, `AddFrame` for each frame, `End`
// once.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual absl::Status Begin(const Recording& recording) = 0;
  virtual absl::Status AddFrame(const RecordedFrame& frame) = 0;
  // `report` hears what share is done of what is left to write, and may end it by an error.
  virtual absl::Status End(const std::function<absl::Status(double share)>& report) = 0;
};

// What a vertex' numbers are in the file.
enum class Values { kPositions, kDisplacements };

struct Settings {
  Sink sink;
  Values values = Values::kPositions;  // one of the format's
  std::string stem = "motion";         // of the names of files in an archive
  std::string spool_folder = {};       // for what memory should not hold
};

struct Format {
  std::string name;
  std::string ending;  // of the file's name
  std::string description;
  std::vector<Values> values = {};  // the first is the format's own; empty where there is no choice
  // Estimates, by which a full disk is foreseen: of the file and of the spool, for each vertex and frame.
  std::int64_t file_bytes, spool_bytes;
  double frames_a_breath = 0;  // where it is not said how many; 0 leaves it to the frames a second
  bool numbers_only = false;   // has columns and no bodies
  bool instant = false;        // has the last frame alone
  std::function<std::unique_ptr<Recorder>(Settings settings)> make = {};
};

// The catalogue of motions: one row a format.
const std::vector<Format>& Formats();

// INVALID_ARGUMENT with the names there are.
absl::StatusOr<Format> FindFormat(const std::vector<Format>& formats, std::string_view name);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_RECORDER_H_
