// The registration of the generated thorax, the template, to what a label volume shows of a person.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_FIT_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_FIT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/segmented_parts.h"

namespace phrenic::imaging {

// p = scale * q + shift for each axis apart, from a place q in the template to p in the volume [mm]; no rotation.
struct TemplateFit {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones(), shift = Eigen::Vector3d::Zero();
  double residual = 0;  // root mean square distance of the landmarks after the fit [mm]
  int landmarks = 0;

  Eigen::Vector3d ToPerson(const Eigen::Vector3d& generated) const { return scale.cwiseProduct(generated) + shift; }
  Eigen::Vector3d ToTemplate(const Eigen::Vector3d& placed) const { return (placed - shift).cwiseQuotient(scale); }
};

// Fits by weighted least squares to landmarks of each part that the template has too and the border of the volume does
// not cut: the least, the mean and the greatest coordinates of a rib and of the lung of a side, the mean of a vertebra.
// Heights of lungs, which depend on the breath, have a smaller weight. With `soft`, only the lungs count if there are
// two. FAILED_PRECONDITION if there are neither two lungs nor four ribs of each side, or a scale is not between 0.5 and
// 2: the parts are not those of a thorax. Pure function, thread-safe.
absl::StatusOr<TemplateFit> FitTemplate(const LabelVolume& volume, const std::vector<Part>& parts, bool soft);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_FIT_H_
