#include "server/fit/landmarks.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/meshio/text.h"

namespace phrenic::fit {

absl::StatusOr<Landmarks> PairLandmarks(const Landmarks& exhale, const Landmarks& inhale) {
  if (exhale.paired() || inhale.paired()) {
    return absl::InvalidArgumentError("two files were given, and one has pairs already: give it alone");
  }
  if (exhale.size() != inhale.size()) {
    return absl::InvalidArgumentError(absl::StrCat("the file of end exhale has ", exhale.size(),
                                                   " points, that of end inhale ", inhale.size(),
                                                   ": they must be the same points in the same order"));
  }
  for (size_t i = 0; i < std::min(exhale.labels.size(), inhale.labels.size()); ++i) {
    const std::string &a = exhale.labels[i], &b = inhale.labels[i];
    if (a == b || a.empty() || b.empty()) continue;
    return absl::InvalidArgumentError(absl::StrCat("point ", i + 1, " is ", meshio::Quoted(a), " at end exhale and ",
                                                   meshio::Quoted(b), " at end inhale: bring them into one order"));
  }
  return Landmarks{exhale.exhale, inhale.exhale - exhale.exhale, exhale.labels};
}

Landmarks Select(const Landmarks& landmarks, const std::vector<int>& indices) {
  Landmarks selected = {landmarks.exhale(Eigen::all, indices), Points(3, 0)};
  if (landmarks.paired()) selected.motion = landmarks.motion(Eigen::all, indices);
  if (landmarks.phase.size() > 0) selected.phase = landmarks.phase(indices);
  return selected;
}

}  // namespace phrenic::fit
