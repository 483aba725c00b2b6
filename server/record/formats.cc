#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/record/depl.h"
#include "server/record/msh.h"
#include "server/record/recorder.h"

namespace phrenic::record {

const std::vector<Format>& Formats() {
  static const auto* const formats = new std::vector<Format>{
      {"msh", "Gmsh 2.2 text: the mesh, and the motion as NodeData", &MakeMshRecorder},
      {"depl", "the thesis' text format: each vertex' first position and its changes", &MakeDeplRecorder},
  };
  return *formats;
}

absl::StatusOr<std::unique_ptr<Recorder>> MakeRecorder(std::string_view name, Sink sink) {
  std::vector<std::string> names;
  for (const Format& format : Formats()) {
    if (format.name == name) return format.make(std::move(sink));
    names.emplace_back(format.name);
  }
  return absl::InvalidArgumentError(
      absl::StrCat("format: there is no format \"", std::string(name), "\"; there are ", absl::StrJoin(names, ", ")));
}

}  // namespace phrenic::record
