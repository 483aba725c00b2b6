#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/record/csv.h"
#include "server/record/depl.h"
#include "server/record/gltf.h"
#include "server/record/msh.h"
#include "server/record/pvd.h"
#include "server/record/recorder.h"

namespace phrenic::record {

const std::vector<Format>& Formats() {
  constexpr Values kPositions = Values::kPositions, kDisplacements = Values::kDisplacements;
  static const auto* const formats = new std::vector<Format>{
      {.name = "msh",
       .ending = "msh",
       .description = "Gmsh 2.2 text: the mesh, and the motion as NodeData",
       .values = {kDisplacements, kPositions},
       .file_bytes = 40,
       .spool_bytes = 0,
       .make = &MakeMshRecorder},
      {.name = "depl",
       .ending = "depl",
       .description = "the thesis' text format: each vertex' first position and its changes from frame to frame",
       .file_bytes = 30,
       .spool_bytes = 24,
       .make = &MakeDeplRecorder},
      {.name = "pvd",
       .ending = "zip",
       .description = "ParaView: one .vtp per frame and a .pvd with their times, in one archive",
       .values = {kPositions, kDisplacements},
       .file_bytes = 54,
       .spool_bytes = 0,
       .make = &MakePvdRecorder},
      {.name = "glb",
       .ending = "glb",
       .description = "glTF 2.0, for slides and any viewer: the motion as an animation of morph targets",
       .file_bytes = 12,
       .spool_bytes = 0,
       .frames_a_breath = 24,
       .make = &MakeGltfRecorder},
      {.name = "csv",
       .ending = "csv",
       .description = "positions of the probes and the measures, one row per frame",
       .file_bytes = 0,
       .spool_bytes = 0,
       .numbers_only = true,
       .make = &MakeCsvRecorder},
  };
  return *formats;
}

absl::StatusOr<Format> FindFormat(const std::vector<Format>& formats, std::string_view name) {
  std::vector<std::string> names;
  for (const Format& format : formats) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  return absl::InvalidArgumentError(
      absl::StrCat("format: there is no format \"", std::string(name), "\"; there are ", absl::StrJoin(names, ", ")));
}

}  // namespace phrenic::record
