// What a radiologist measures on a thorax that breathes.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Of one model, between rest and a state. Bodies are found by their anatomy, muscle and tendon by the diaphragm's
// regions "tendon" and "rim". A measure is not there where the model lacks what it is taken on. Immutable; any number
// of threads may call. The model must outlive it.
class ThoraxMetrics {
 public:
  // FAILED_PRECONDITION where no deformable body is a diaphragm.
  static absl::StatusOr<ThoraxMetrics> Of(const Model& model);

  // How much lower the highest point of a dome is, more than 35 mm from the midline [m].
  double DomeDescent(const State& state, v1::Side side) const;
  // Mean descent of the back half of the upper face over that of the front half.
  double PosteriorOverAnterior(const State& state) const;
  // 1 - length/length at rest, mean over the shortest ways on the sheet from the rim to the tendon.
  std::optional<double> FibreShortening(const State& state) const;
  // |area/area at rest - 1| of the tendon.
  std::optional<double> TendonAreaChange(const State& state) const;
  // |stretch across the fibres - 1| of the muscle: its area's change over its length's.
  std::optional<double> StrainAcrossFibres(const State& state) const;
  // Volume over area of the closed sheet, over the same at rest.
  double ThicknessRatio(const State& state) const;
  // Mean displacement of the sternum's body [m].
  std::optional<Eigen::Vector3d> SternumShift(const State& state) const;
  // The way of the outermost point of ribs 7 to 10 to its own side, mean of all [m].
  std::optional<double> LowerRibShift(const State& state) const;
  // Volume that the upper face of the diaphragm leaves above itself [m^3].
  double SweptVolume(const State& state) const;
  // Change of the lungs' volume [m^3].
  std::optional<double> LungVolumeChange(const State& state) const;

 private:
  explicit ThoraxMetrics(const Model& model) : model_(model) {}
  void FindUpperFace();
  void FindFibres();
  Points Placed(const State& state, int body) const;
  ConstPoints Sheet(const State& state) const;
  double FibreLength(const ConstPoints& x) const;
  double Area(const ConstPoints& x, const std::vector<int>& triangles) const;
  std::vector<int> BodiesOf(v1::Structure structure) const;

  const Model& model_;
  int diaphragm_ = 0;
  std::vector<int> upper_;            // triangles that look up at rest
  std::vector<int> tendon_, muscle_;  // triangles
  Edges fibres_;                      // edges of all ways from rim to tendon
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_
