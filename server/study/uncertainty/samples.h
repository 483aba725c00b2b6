// Points in the unit cube at which a function of several inputs is evaluated. The same arguments give the same bits on
// every machine.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_SAMPLES_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_SAMPLES_H_

#include <Eigen/Core>
#include <cstdint>

namespace phrenic::study {

// One point per row, inputs x points within 0 to 1; a row is contiguous.
using UnitPoints = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Returns the first points of Sobol's sequence (Joe and Kuo's directions), shifted digitally by random bits of `seed`:
// count x inputs, each strictly within 0 and 1.
UnitPoints SobolPoints(Eigen::Index count, Eigen::Index inputs, std::uint64_t seed);

// Morris' trajectories (Technometrics 1991;33:161): inputs + 1 points each, from one to the next of which one input
// moves by kMorrisStep, in random order from a random point of a grid of four levels.
inline constexpr double kMorrisStep = 2.0 / 3;
UnitPoints MorrisPoints(Eigen::Index trajectories, Eigen::Index inputs, std::uint64_t seed);

// Saltelli's design (Comput Phys Commun 2010;181:259): for each of `samples` base points the rows A, B and, for each
// input i, A with the i-th coordinate of B: samples * (inputs + 2) points.
UnitPoints SaltelliPoints(Eigen::Index samples, Eigen::Index inputs, std::uint64_t seed);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_SAMPLES_H_
