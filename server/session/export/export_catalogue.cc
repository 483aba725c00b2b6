#include "server/session/export/export_catalogue.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/meshio/formats.h"
#include "server/session/export/surface_recorder.h"

namespace phrenic::session {
namespace {

constexpr std::int64_t kBytesPerVertex = 200;  // of a surface file, with the vertex' two triangles

record::Format SurfaceFormat(const std::string& ending) {
  return {.name = ending.substr(1),
          .ending = ending.substr(1),
          .description = absl::StrCat("the bodies at one instant, as `phrenic convert` writes ", ending),
          .file_bytes = kBytesPerVertex,
          .spool_bytes = 0,
          .instant = true,
          .make = [ending](record::Settings settings) {
            return std::make_unique<SurfaceRecorder>(ending, std::move(settings.sink));
          }};
}

// Frames within 1 mm have about 0.3 bytes per vertex; memory holds them with three finer bounds.
record::Format PageFormat() {
  return {.name = "html",
          .ending = "html",
          .description = "one page that plays a breath without a server: rotation, cuts, layers, graphs",
          .file_bytes = 4,
          .spool_bytes = 0,
          .frames_a_breath = 80,
          .page = true};
}

std::vector<record::Format> AllFormats() {
  std::vector<record::Format> all = record::Formats();
  all.push_back(PageFormat());
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
