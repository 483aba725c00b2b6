// The interior of the lungs at any moment of a run, relative to rest: what viewers and probes read while a session
// runs. No step computes it; it uses no memory until it is first read.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_LIVE_LUNGS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_LIVE_LUNGS_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/lung_responses.h"
#include "server/physiology/lung_drive.h"
#include "server/physiology/lung_regions.h"

namespace phrenic::physiology {

// One lung at one moment.
struct LungMoment {
  Eigen::VectorXd amplitudes;                    // of its shapes (LungResponses) [m]
  double volume = 0;                             // gained: the integral of div u [m^3]
  std::array<double, kLungRegions> caudal = {};  // mean descent [m]
  std::array<double, kLungRegions> gained = {};  // mean of div u: volume gained per volume at rest [1]
};

// Tissue at a place of a lung.
struct TissueReading {
  int lung;  // in LiveLungs::lungs()
  TissueAtPoint tissue;
};

// The lungs of a model. Refers to it. Immutable, thread-safe.
class LiveLungs {
 public:
  struct Lung {
    int body;  // in Model::bodies
    std::string name;
    LungResponses responses;
    // Of its shapes: RegionWeights times LungResponses::shapes().
    Eigen::MatrixXd caudal, gained;
    Eigen::RowVectorXd volume;
  };

  // Factorises and reduces both lungs under their weight in each posture: 3 to 5 s. Of lungs that LungModes moves
  // (persons' scenes), the tissue is exactly theirs, at once. FAILED_PRECONDITION if the scene has neither these nor
  // lungs, a simulated diaphragm and an inner wall of the cage; as LungTissue::Make; the status of `stop`.
  static absl::StatusOr<LiveLungs> Make(const Model& model, const StopCheck& stop = {});

  const std::vector<Lung>& lungs() const { return lungs_; }
  // Returns each lung in a state, moved as lung_drive.h says.
  std::vector<LungMoment> At(const State& state, const v1::Parameters& parameters) const;
  // Returns the tissue at a point, whose place is where it is at rest [m]; none outside the lungs. `moments` are of At.
  std::optional<TissueReading> Read(const std::vector<LungMoment>& moments, const Eigen::Vector3d& point) const;

 private:
  explicit LiveLungs(const Model& model) : model_(model) {}
  absl::Status AddDriven(const Parts& parts, const StopCheck& stop);
  void Add(int body, const Eigen::AlignedBox3d& box, LungResponses responses);
  std::vector<Eigen::VectorXd> AmplitudesAt(const State& state, const v1::Parameters& parameters) const;

  const Model& model_;
  std::optional<LungDrive> drive_;  // none: LungModes moves the lungs
  std::vector<Lung> lungs_;
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_LIVE_LUNGS_H_
