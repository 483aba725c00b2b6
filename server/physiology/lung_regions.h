// Means over regions of a lung's tissue as linear functions of its grid's nodes, so that they cost microseconds.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_LUNG_REGIONS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_LUNG_REGIONS_H_

#include <Eigen/Geometry>

#include "server/mechanics/lungs/brick_grid.h"

namespace phrenic::physiology {

// Regions of a lung at rest: thirds of its height; the posterior and the anterior third of its depth.
enum LungRegion { kLungBase, kLungMiddle, kLungApex, kLungBack, kLungFront, kLungRegions };

// Factors of the displacement of a grid's nodes, column 3 node + axis.
struct RegionWeights {
  Eigen::MatrixXd caudal;     // regions x 3 nodes: mean descent [1]
  Eigen::MatrixXd gained;     // regions x 3 nodes: mean of div u [1/m]
  Eigen::RowVectorXd volume;  // 1 x 3 nodes: integral of div u over the inside [m^2]
};

// Integrates over the parts of the bricks, each by its fraction inside. `box` is that of the surface [m]. Weights of a
// region without volume are 0.
RegionWeights WeightsOfRegions(const BrickGrid& grid, const Eigen::AlignedBox3d& box);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_LUNG_REGIONS_H_
