// The prestress of muscle: resting tensions of its triangles, along and across the fibres, that hold a load at rest. A
// bounded least-squares problem: with R_i the sum of load, tensions and contact on a vertex and a_i its area, minimise
//   sum |R_i|^2 / a_i + sum s (T - T0)^2,  least <= T <= greatest,  s the triangle's share of the area of all,
// while contacts push against their normals with pressures N_i >= 0. By FISTA (Beck and Teboulle 2009) in single
// precision: tensions need no more, since what is left of the load is carried by a constant load. The second term,
// which keeps tensions smooth, and so what is left of the load depend little on the mesh.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_PRESTRESS_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_PRESTRESS_H_

#include <Eigen/Core>
#include <vector>

#include "server/mechanics/breathing/muscle_triangle.h"
#include "server/mechanics/stop_check.h"

namespace phrenic {

// Of the vertices of one body; `first` is its first simulated vertex. 3 x its vertices where it is a matrix.
struct RestingLoad {
  int first = 0;
  ConstPoints load;      // [N]
  ConstPoints normals;   // of contacts, into the surface; 0 for vertices that touch nothing
  Eigen::VectorXd area;  // around each vertex [m^2]
  std::vector<bool> free;
};

struct PrestressReport {
  int iterations = 0;
  double along = 0, across = 0;  // means by area, of muscle [N/m]
  Eigen::VectorXd contact;       // pressures N [Pa]
};

// Sets the resting tensions of the triangles, which hold those to begin with (T0). `greatest` is the greatest tension
// along the fibres [N/m]. Leaves early when `stop` has stopped.
PrestressReport ChoosePrestress(const RestingLoad& resting, double greatest, const StopCheck& stop,
                                std::vector<MuscleTriangle>& triangles);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_PRESTRESS_H_
