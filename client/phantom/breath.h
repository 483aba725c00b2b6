// Phantoms of a scene's breath: the part of `phrenic phantom` that runs a scene.
#ifndef PHRENIC_CLIENT_PHANTOM_BREATH_H_
#define PHRENIC_CLIENT_PHANTOM_BREATH_H_

#include <string>
#include <vector>

#include "client/cli/scene_argument.h"
#include "client/connection/context.h"

namespace phrenic::client {

struct BreathOptions {
  SceneOptions scene;
  std::string preset, data_dir;
  std::vector<std::string> settings;
  int phases = 10;   // of one breath
  double start = 0;  // time of the first phase [s]
  bool ct = false, field = false;
  double texture = 0;              // of the lungs' density
  std::vector<std::string> dicom;  // of "seg", "ct", "stl", "obj" and "all"
};

// Runs the scene and writes the phases of a breath, with voxels of `spacing_mm`, to the folder `out`, which is made if
// it does not exist. Returns the exit code.
int WriteBreath(const Context& context, const BreathOptions& options, double spacing_mm, const std::string& out);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PHANTOM_BREATH_H_
