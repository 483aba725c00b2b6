// The structures of a scene that a phantom has as labels: its closed bodies with a tissue.
#ifndef PHRENIC_SERVER_PHANTOM_STRUCTURES_H_
#define PHRENIC_SERVER_PHANTOM_STRUCTURES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fluoroscopy/attenuation.h"
#include "server/imaging/label_volume.h"
#include "server/mechanics/model.h"

namespace phrenic::phantom {

struct Structure {
  int body = 0;             // in Model::bodies
  imaging::Label number{};  // of its voxels: 1, 2, ... in the order of the bodies
  std::string name;         // of its label: "rib_left_1", "vertebrae_T8", "lung_right"
  v1::Anatomy anatomy;
  fluoroscopy::Tissue tissue{};
  std::string color;    // of its layer, "#a5483f"; empty without
  Triangles triangles;  // closed
};

struct Structures {
  std::vector<Structure> all;
  std::vector<std::string> open;  // bodies with a tissue but open surfaces: they have no inside and are left out
};

// Returns the structures of a scene. FAILED_PRECONDITION if it has none. Thread-safe.
absl::StatusOr<Structures> FindStructures(const Model& model);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_STRUCTURES_H_
