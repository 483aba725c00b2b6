// Line integrals of the attenuation coefficient along the rays of a picture.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_PROJECTION_H_
#define PHRENIC_SERVER_FLUOROSCOPY_PROJECTION_H_

#include <Eigen/Core>
#include <vector>

#include "server/fluoroscopy/absorbers.h"
#include "server/fluoroscopy/c_arm.h"

namespace phrenic::fluoroscopy {

// Rows go down, columns to the right, seen from the detector.
using Picture = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Returns the line integrals sum(weight x thickness) along the rays through the middles of size x size pixels. A ray of
// intensity 1 arrives with exp(-integral). Each front face adds weight times its distance along the ray, each back face
// subtracts it: the page does the same by additive blending. A rule for pixels on an edge makes closed surfaces closed
// in the picture too, so that thickness is exact up to the triangles. Requires: closed surfaces, all in front of the
// source. Deterministic, thread-safe.
Picture LineIntegrals(const std::vector<Absorber>& absorbers, const Projection& projection, int size);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_PROJECTION_H_
