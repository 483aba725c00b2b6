// A 4D digital phantom: label volumes, CT-like volumes and the true displacement of a scene at phases of its breath.
#ifndef PHRENIC_SERVER_PHANTOM_BREATHING_PHANTOM_H_
#define PHRENIC_SERVER_PHANTOM_BREATHING_PHANTOM_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"
#include "server/mechanics/model.h"
#include "server/phantom/interior.h"
#include "server/phantom/structures.h"

namespace phrenic::phantom {

struct PhantomRequest {
  double spacing_mm = 2;  // edge of the voxels
  bool ct = false;        // volumes like a CT's
  bool field = false;     // displacement fields
  // Unevenness of the density of lungs at rest, 0 to 0.9: the density is 1 + `texture` times GrainAt that of rest, and
  // moves with the tissue, so that registration has contrast inside lungs.
  double texture = 0;
};

inline constexpr double kMostPhantomVoxels = 2.5e7;  // of a volume: 1.5 GB of memory with a field

// What a label volume has of a structure.
struct StructureVoxels {
  double enclosed_mm3 = 0;   // by the surface
  std::size_t inside = 0;    // voxels whose centre is inside the surface
  std::size_t labelled = 0;  // of these, with its label: the others are in a smaller structure
};

struct PhantomPhase {
  double time = 0;               // of the run [s]
  imaging::LabelVolume labels;   // size and frame of all volumes
  std::vector<std::int16_t> ct;  // [HU]; empty unless requested
  // Displacement [mm, LPS] of what is at each voxel in the first phase, to this phase: 3 x voxels, 0 where the first
  // phase has no label. Empty unless requested, and in the first phase, where all is 0.
  Points field;
  std::vector<StructureVoxels> structures;  // in the order of Structures::all
};

// Called before each structure of a volume; an error ends the work.
using GoOn = std::function<absl::Status()>;

// The breath of a scene at successive states. Displacements refer to the first one, which is the scene at rest if its
// time is 0. Refers to the model. Not thread-safe. Deterministic.
class BreathingPhantom {
 public:
  // INVALID_ARGUMENT without states, if the volumes would have more than kMostPhantomVoxels, with the smallest spacing
  // that has fewer, or if a lung whose inside is needed has a surface that no tissue can be made in; the errors of
  // FindStructures.
  static absl::StatusOr<BreathingPhantom> Make(const Model& model, std::vector<State> phases,
                                               const PhantomRequest& request);

  std::size_t phases() const { return phases_.size(); }
  const Structures& structures() const { return structures_; }
  // Returns a phase's volumes. The errors of `go_on`.
  absl::StatusOr<PhantomPhase> Render(std::size_t phase, const GoOn& go_on);
  // Returns the names of compact structures that no elastic tissue can be made in: their insides move with the nearest
  // point of the surface, as those of thin structures do.
  const std::vector<std::string>& without_tissue() const { return without_tissue_; }
  // Returns a structure's surface in a phase [m].
  Mesh SurfaceOf(const Structure& structure, std::size_t phase) const;
  // The largest Interior::misfit() of the last phase with a field or a CT [m].
  double misfit() const { return misfit_; }

 private:
  BreathingPhantom(const Model& model, std::vector<State> phases, const PhantomRequest& request)
      : model_(model), phases_(std::move(phases)), request_(request) {}

  absl::Status MakeGrid();
  absl::Status AddInterior(const Structure& structure, Mesh surface);
  absl::Status Label(std::size_t phase, const GoOn& go_on, PhantomPhase& rendered) const;
  absl::Status MoveInteriors(std::size_t phase, const GoOn& go_on);
  absl::Status FillField(const GoOn& go_on, PhantomPhase& rendered) const;
  absl::Status FillCt(std::size_t phase, const GoOn& go_on, PhantomPhase& rendered) const;
  void AddTrunk(std::size_t phase, PhantomPhase& rendered) const;
  Eigen::Vector3d Place(std::size_t voxel) const;  // [m]

  const Model& model_;
  std::vector<State> phases_;
  PhantomRequest request_;
  Structures structures_;
  std::vector<int> smallest_first_;                 // indices of structures
  imaging::LabelVolume grid_;                       // of all volumes, without labels
  std::vector<imaging::Label> first_;               // labels of the first phase; empty without fields
  std::vector<std::optional<Interior>> interiors_;  // of each structure; nullopt where neither field nor CT needs it
  std::vector<std::string> without_tissue_;
  double misfit_ = 0;
};

// Returns the smallest spacing [mm] at which a box of these sizes [mm] has at most kMostPhantomVoxels, rounded up to a
// tenth.
double SmallestSpacing(const Eigen::Vector3d& sizes);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_BREATHING_PHANTOM_H_
