// Points that carriers carry along: u = sum_c w_c u_c, u_c the displacement that carrier c gives the point. A carrier
// is a pose (it moves the point as part of the rigid body) or a simulated vertex (it lends its own displacement); what
// is missing to a sum of 1 stands still. Or points that keep their place in a triangle (motions/mapping.h).
#ifndef PHRENIC_SERVER_MECHANICS_SKIN_H_
#define PHRENIC_SERVER_MECHANICS_SKIN_H_

#include <vector>

#include "server/mechanics/state.h"

namespace phrenic {

// One vertex's share of one carrier.
struct SkinWeight {
  int vertex = 0;             // of the riding body
  int pose = -1;              // the carrier: a pose, or ...
  int simulated_vertex = -1;  // ... a simulated vertex
  double weight = 0;          // between 0 and 1
};

// A vertex's place in a triangle of simulated vertices: x = sum_i weights_i x_i + height n, n the unit normal.
struct TriangleBinding {
  Eigen::Vector3i corners = Eigen::Vector3i::Zero();
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  // barycentric: their sum is 1
  double height = 0;                                  // [m]
};

// A body that is only seen and rides on others.
struct Skin {
  int body = 0;
  std::vector<SkinWeight> shares;          // sorted by vertex; or ...
  std::vector<TriangleBinding> triangles;  // ... one a vertex of the body
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKIN_H_
