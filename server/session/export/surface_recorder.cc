#include "server/session/export/surface_recorder.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mesh/units.h"
#include "server/meshio/formats.h"

namespace phrenic::session {
namespace {

constexpr std::int64_t kBytesAVertex = 200;  // of the file, with its two triangles

// All bodies as one surface. Networks are in it only where no body has triangles: the formats hold the one or the
// other.
Mesh Joined(const std::vector<record::RecordedBody>& bodies, const Points& positions) {
  Mesh joined;
  joined.vertices = positions;
  int first = 0;
  for (const record::RecordedBody& body : bodies) {
    const auto append = [first](auto& all, const auto& some) {
      const Eigen::Index before = all.cols();
      all.conservativeResize(Eigen::NoChange, before + some.cols());
      all.rightCols(some.cols()) = some.array() + first;
    };
    append(joined.triangles, body.mesh.triangles);
    append(joined.edges, body.mesh.edges);
    first += static_cast<int>(body.mesh.vertices.cols());
  }
  if (joined.triangles.cols() > 0) joined.edges.resize(2, 0);
  return joined;
}

// Holds the last frame.
class SurfaceRecorder final : public record::Recorder {
 public:
  SurfaceRecorder(std::string ending, record::Sink sink) : ending_(std::move(ending)), sink_(std::move(sink)) {}

  absl::Status Begin(const record::Recording& recording) override {
    bodies_ = recording.bodies;
    return absl::OkStatus();
  }

  absl::Status AddFrame(const record::RecordedFrame& frame) override {
    positions_ = frame.positions;
    return absl::OkStatus();
  }

  absl::Status End(const std::function<absl::Status(double share)>& /*report*/) override {
    const auto bytes = meshio::Write("surface" + ending_, Joined(bodies_, positions_), kMillimetre);
    return bytes.ok() ? sink_(*bytes) : bytes.status();
  }

 private:
  const std::string ending_;
  const record::Sink sink_;
  std::vector<record::RecordedBody> bodies_;
  Points positions_;
};

record::Format SurfaceFormat(const std::string& ending) {
  return {.name = ending.substr(1),
          .ending = ending.substr(1),
          .description = absl::StrCat("the bodies at one instant, as `phrenic convert` writes ", ending),
          .file_bytes = kBytesAVertex,
          .spool_bytes = 0,
          .instant = true,
          .make = [ending](record::Settings settings) {
            return std::make_unique<SurfaceRecorder>(ending, std::move(settings.sink));
          }};
}

std::vector<record::Format> AllFormats() {
  std::vector<record::Format> all = record::Formats();
  for (const meshio::Format& surface : meshio::Formats()) {
    const std::string ending(surface.ending);
    const bool taken =
        std::any_of(all.begin(), all.end(), [&](const auto& format) { return "." + format.name == ending; });
    if (surface.write != nullptr && !taken) all.push_back(SurfaceFormat(ending));
  }
  return all;
}

}  // namespace

const std::vector<record::Format>& ExportFormats() {
  static const auto* const formats = new std::vector<record::Format>(AllFormats());
  return *formats;
}

}  // namespace phrenic::session
