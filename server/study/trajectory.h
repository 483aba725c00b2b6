// Where a model is at given moments, how it was got there, and how far two such motions are apart.
#ifndef PHRENIC_SERVER_STUDY_TRAJECTORY_H_
#define PHRENIC_SERVER_STUDY_TRAJECTORY_H_

#include <string>
#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

struct Trajectory {
  std::vector<State> states;  // one a moment
  double cpu_s = 0;           // CPU time of this thread [s]
  double simulated_s = 0;     // [s]
  std::string problem;        // why there are fewer states than moments ("out of time at 0.2 s"); or empty
};

// `count` moments, evenly spaced, the last one at `seconds`.
std::vector<double> Moments(double seconds, int count);

// Steps from rest by the parameters' integrator with the longest step that is no longer than `dt` and divides the time
// between moments (Moments' spacing). Ends early, with `problem`, where the run diverges or takes more than
// `most_cpu_s`. CANCELLED as soon as `progress` says so.
absl::StatusOr<Trajectory> Simulate(const Subject& subject, const std::vector<double>& moments, double dt,
                                    double most_cpu_s, const Progress& progress);
// The step that Simulate takes for `dt` [s].
double DividingStep(const std::vector<double>& moments, double dt);

struct Distance {
  double largest = 0;  // of any vertex at any moment [m]
  double rms = 0;      // over vertices and moments [m]
  double probes = 0;   // the largest of any probe [m]
  double energy = 0;   // the largest difference of energy [J]
};

// Compares vertices only: State::scalars counts by the vertices that it moves. Over the moments that both have, and the
// vertices that forces move; equal models.
Distance DistanceBetween(const Subject& subject, const Trajectory& a, const Trajectory& b);

// How far any vertex came from rest [m].
double LargestWay(const Model& model, const Trajectory& trajectory);

// RMS distance of the vertices that forces move [m]; positions 3 x n.
double RmsApart(const Model& model, const Points& a, const Points& b);

// Kinetic energy and that of every force that has one [J].
double Energy(const Subject& subject, const State& state);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_TRAJECTORY_H_
