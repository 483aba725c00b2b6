// How lung tissue moves in a breath, driven by the diaphragm, the wall and the mediastinum (mechanics/lungs/), and
// where air goes.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_LUNG_BREATH_H_
#define PHRENIC_SERVER_PHYSIOLOGY_LUNG_BREATH_H_

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/lung_field.h"
#include "server/physiology/bones.h"
#include "server/physiology/lung_drive.h"
#include "server/physiology/lung_regions.h"
#include "server/physiology/recording.h"

namespace phrenic::physiology {

// One lung in one breath, from its beginning to its peak.
struct LungReading {
  std::string lung;                              // the body's name
  double volume = 0;                             // gained by the tissue [m^3]
  std::array<double, kLungRegions> caudal = {};  // mean descent [m]
  std::array<double, kLungRegions> gained = {};  // mean of div u: volume gained per volume at rest [1]
  double back_over_front = 0;                    // descent of the thirds of the depth, in the lower half [1]
  double upwards = 0;                            // part of the volume that moves up, 0..1
};

// The lungs of a scene as tissue. Refers to the subject's model. Immutable, thread-safe.
class BreathingLungs {
 public:
  // FAILED_PRECONDITION if the scene lacks lungs, a simulated diaphragm or an inner wall; as LungTissue::Make.
  static absl::StatusOr<BreathingLungs> Make(const Subject& subject, const LungElasticity& elasticity = DrivenLungs(),
                                             LungCauses causes = {});

  // Returns the motion of each lung in a breath (lung_drive.h). Factorises each lung.
  std::vector<LungMotion> Motions(const Recording& breath) const;
  // Returns the readings of these motions.
  std::vector<LungReading> Readings(const std::vector<LungMotion>& motions) const;
  // The part of the surface of a lung that touches a neighbour, 0..1.
  double Share(size_t lung, LungNeighbour neighbour) const { return drive_.surroundings(lung).Share(neighbour); }

 private:
  BreathingLungs(std::vector<std::string> names, std::vector<LungTissue> tissues, LungDrive drive)
      : names_(std::move(names)), tissues_(std::move(tissues)), drive_(std::move(drive)) {}

  std::vector<std::string> names_;
  std::vector<LungTissue> tissues_;
  LungDrive drive_;
};

// Returns the motion of each lung that LungModes moves, from the end of expiration to that of inspiration. Empty for a
// scene without that motion. As LungTissue::Make.
absl::StatusOr<std::vector<LungMotion>> MotionsOfModes(const Model& model, const v1::Parameters& parameters);
// Returns what each lung does, without its name.
std::vector<LungReading> ReadingsOf(const std::vector<LungMotion>& motions);

// Returns points inside the lungs' tissue 6 mm apart, and how far they move down in the breath, as landmarks of CT do;
// points of the seen surfaces where the scene has no tissue (BreathingLungs::Make), empty without lungs.
LoweredPoints LoweredInBreath(const Recording& breath);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_LUNG_BREATH_H_
