// One triangle of muscle, tendon or passive tissue, in double precision: its energy, stiffness and viscosity
// (forces/muscle.h has the equations). Forces are computed many triangles at a time (forces/muscle_kernel.h).
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_TRIANGLE_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_TRIANGLE_H_

#include <Eigen/Core>
#include <vector>

#include "server/mechanics/breathing/muscle_law.h"
#include "server/mechanics/stiffness.h"

namespace phrenic {

struct MuscleTriangle {
  Eigen::Vector3i vertices = Eigen::Vector3i::Zero();  // simulated
  Eigen::Vector3d along = Eigen::Vector3d::Zero();     // of each vertex: f.g, g the gradient of its shape function
  Eigen::Vector3d across = Eigen::Vector3d::Zero();    // and c.g [1/m]
  Eigen::Vector3d f = Eigen::Vector3d::Zero(), c = f;  // unit vectors along and across the fibres at rest
  double area = 0;                                     // at rest [m^2]; 0 if degenerate
  double resting_along = 0, resting_across = 0;        // resting tensions [N/m]
  Tissue tissue = Tissue::kPassive;
  int bundle = 0;  // of fibres; 0 if it is not muscle
};

// Returns the triangle of these vertices, with f along the gradient of `height` (of each vertex); if that is constant,
// as in tendon, as near as possible to the x axis, or to the y axis if the triangle faces x. Resting tensions are 0.
MuscleTriangle MakeMuscleTriangle(const ConstPoints& rest, const Eigen::Vector3i& vertices,
                                  const Eigen::Vector3d& height);

struct Stretches {
  double along, across;  // l, m
};
Stretches StretchesOf(const MuscleTriangle& triangle, const ConstPoints& x);

// `active` is the active tension at force-length 1 [N/m]; only muscle has it.
double EnergyOf(const MuscleTriangle& triangle, const MuscleLaw& law, double active, const ConstPoints& x);
// Adds the stiffness without its negative terms [N/m].
void AddStiffnessOf(const MuscleTriangle& triangle, const MuscleLaw& law, double active, const ConstPoints& x,
                    StiffnessSink& sink);
// Adds a bound of the stiffness that `active` would add to muscle.
void AddActiveStiffnessOf(const MuscleTriangle& triangle, double active, const ConstPoints& x, StiffnessSink& sink);
// Adds the blocks of Force::AddViscosity [N s/m].
void AddViscosityOf(const MuscleTriangle& triangle, const MuscleLaw& law, const ConstPoints& x, StiffnessSink& blocks);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_MUSCLE_TRIANGLE_H_
