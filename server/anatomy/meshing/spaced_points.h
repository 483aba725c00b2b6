// Dart throwing: a set of points with a minimum distance (in a hash grid), and the quasi-random sequence of candidates.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_SPACED_POINTS_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_SPACED_POINTS_H_

#include <Eigen/Core>
#include <cstdint>

#include "absl/container/flat_hash_map.h"
#include "absl/container/inlined_vector.h"

namespace phrenic::anatomy {

// Returns point i of the R2 low-discrepancy sequence in the unit square: the additive recurrence of the plastic number
// (Roberts 2018; Martin, Craster and Kearney for the plastic number's property).
Eigen::Vector2d QuasiRandom(int64_t i);

// Each point has its own target spacing. Two points conflict if their distance is below `apart` times the smaller of
// their spacings. Not thread-safe.
class SpacedPoints {
 public:
  // `largest` and `smallest` bound the spacings.
  SpacedPoints(double largest, double apart, double smallest);

  void Add(const Eigen::Vector3d& point, double spacing);
  // Adds the point unless it conflicts with one added before. Returns whether it was added.
  bool TryAdd(const Eigen::Vector3d& point, double spacing);

 private:
  struct Entry {
    Eigen::Vector3d point;
    double spacing;
  };
  int64_t Key(const Eigen::Vector3i& cell) const;
  Eigen::Vector3i Cell(const Eigen::Vector3d& point) const;

  double cell_, apart_;
  absl::flat_hash_map<int64_t, absl::InlinedVector<Entry, 2>> cells_;
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_SPACED_POINTS_H_
