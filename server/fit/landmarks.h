// Points in a person's lungs, at end exhale alone or paired with their places at end inhale.
#ifndef PHRENIC_SERVER_FIT_LANDMARKS_H_
#define PHRENIC_SERVER_FIT_LANDMARKS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::fit {

// In metres, one column per landmark.
struct Landmarks {
  Points exhale;
  Points motion;                         // inhale - exhale; as many columns as `exhale`, or none
  std::vector<std::string> labels = {};  // of a Slicer file; empty otherwise
  // Of each pair: 1 at the end of inspiration, less on the way there, up to 2 on the way back; empty: 1 for all.
  Eigen::VectorXd phase = {};

  Eigen::Index size() const { return exhale.cols(); }
  bool paired() const { return motion.cols() > 0; }
};

inline constexpr double kFarthest = 100;  // [m] a coordinate may be from 0

// Pairs the points of two files, one of end exhale and one of end inhale, in their order. INVALID_ARGUMENT if their
// numbers differ, a file has pairs already, or two labels differ.
absl::StatusOr<Landmarks> PairLandmarks(const Landmarks& exhale, const Landmarks& inhale);

// Returns the landmarks with these indices.
Landmarks Select(const Landmarks& landmarks, const std::vector<int>& indices);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_LANDMARKS_H_
