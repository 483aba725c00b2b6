// Measures of a breathing thorax as a radiologist takes them.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Measures the change of a model between rest and a state. Axes: +x left, +y posterior, +z cranial. Bodies are found by
// their anatomy; muscle, tendon and fibres by the regions "tendon" and "rim" of the diaphragm. A measure is nullopt if
// the model lacks the body or region that it needs. Immutable and thread-safe. Requires: the model outlives it.
class ThoraxMetrics {
 public:
  // FAILED_PRECONDITION if no deformable body is a diaphragm.
  static absl::StatusOr<ThoraxMetrics> Of(const Model& model);

  // Descent of the highest point of a dome, among points more than 35 mm from the midline at rest [m].
  double DomeDescent(const State& state, v1::Side side) const;
  // Mean descent of the posterior half of the upper face over that of the anterior half, weighted by area [1].
  double PosteriorOverAnterior(const State& state) const;
  // 1 - L/L0, L the total length of the shortest paths along mesh edges from the rim to the tendon [1].
  std::optional<double> FibreShortening(const State& state) const;
  // |A/A0 - 1| of the tendon's area [1].
  std::optional<double> TendonAreaChange(const State& state) const;
  // |(A/A0)/(L/L0) - 1| of the muscle: its stretch across the fibres minus 1 [1].
  std::optional<double> StrainAcrossFibres(const State& state) const;
  // Mean thickness (volume over area of the closed sheet) over that at rest [1].
  double ThicknessRatio(const State& state) const;
  // Mean displacement of the body of the sternum [m].
  std::optional<Eigen::Vector3d> SternumShift(const State& state) const;
  // Mean lateral displacement of the outermost points of ribs 7 to 10 [m].
  std::optional<double> LowerRibShift(const State& state) const;
  // Volume swept caudally by the upper face of the diaphragm [m^3].
  double SweptVolume(const State& state) const;
  // Change of the volume of the lungs [m^3].
  std::optional<double> LungVolumeChange(const State& state) const;

 private:
  explicit ThoraxMetrics(const Model& model) : model_(model) {}
  void FindUpperFace();
  void FindFibres();
  // Vertices of a body in the state, 3 x n [m].
  Points Placed(const State& state, int body) const;
  // Vertices of the diaphragm in the state, 3 x n [m].
  Points Sheet(const State& state) const;
  double FibreLength(const ConstPoints& x) const;
  double Area(const ConstPoints& x, const std::vector<int>& triangles) const;
  std::vector<int> BodiesOf(v1::Structure structure) const;

  const Model& model_;
  int diaphragm_ = 0;
  std::vector<int> upper_;            // triangles that face up at rest
  std::vector<int> tendon_, muscle_;  // triangles
  Edges fibres_;                      // edges of all paths from rim to tendon, 2 x m
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_THORAX_METRICS_H_
