// Simulates a model to given moments and measures the distance of two such runs.
#ifndef PHRENIC_SERVER_STUDY_TRAJECTORY_H_
#define PHRENIC_SERVER_STUDY_TRAJECTORY_H_

#include <string>
#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// The states of a run at given moments.
struct Trajectory {
  std::vector<State> states;  // one per moment
  double cpu_s = 0;           // CPU time of this thread [s]
  double simulated_s = 0;     // simulated time [s]
  std::string problem;        // why the run ended early ("out of time at 0.2 s"); empty if it is complete
};

// Returns `count` equidistant moments, the last one at `seconds` [s].
std::vector<double> Moments(double seconds, int count);

// Simulates from rest with the subject's integrator and the step DividingStep(moments, dt). Ends early, with `problem`,
// if the run diverges or takes more CPU time than `most_cpu_s` [s]. CANCELLED if `progress` returns false. Requires:
// `moments` are those of Moments. Uses one thread.
absl::StatusOr<Trajectory> Simulate(const Subject& subject, const std::vector<double>& moments, double dt,
                                    double most_cpu_s, const Progress& progress);
// Returns the longest step that is at most `dt` and divides the time between moments [s].
double DividingStep(const std::vector<double>& moments, double dt);

// The distance of two trajectories.
struct Distance {
  double largest = 0;  // largest distance of a vertex at any moment [m]
  double rms = 0;      // RMS over vertices and moments [m]
  double probes = 0;   // largest distance of a probe [m]
  double energy = 0;   // largest difference of energy [J]
};

// Returns the distance over common moments and free vertices. Only vertices are compared: State::scalars count by the
// vertices that they move. Requires: both are trajectories of the subject's model.
Distance DistanceBetween(const Subject& subject, const Trajectory& a, const Trajectory& b);

// Returns the largest displacement of a vertex from rest [m].
double LargestDisplacement(const Model& model, const Trajectory& trajectory);

// Returns the RMS distance of the free vertices [m]; `a` and `b` are positions, 3 x n [m].
double RmsDistance(const Model& model, const Points& a, const Points& b);

// Returns the kinetic energy plus the potential energy of all conservative forces [J].
double Energy(const Subject& subject, const State& state);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_TRAJECTORY_H_
