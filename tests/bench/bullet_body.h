// The same springs as a soft body of Bullet (position-based), from Debian's libbullet-dev: what others take.
#ifndef PHRENIC_TESTS_BENCH_BULLET_BODY_H_
#define PHRENIC_TESTS_BENCH_BULLET_BODY_H_

#include <memory>
#include <vector>

#include "server/mechanics/forces/spring_rows.h"

namespace phrenic::bench {

// Without gravity and collisions; vertices with an inverse mass of 0 are fixed.
class BulletBody {
 public:
  // `iterations` of its position solver a step.
  BulletBody(const Points& x, const Eigen::VectorXd& inverse_mass, const std::vector<Spring>& springs, int iterations);
  ~BulletBody();
  BulletBody(const BulletBody&) = delete;
  BulletBody& operator=(const BulletBody&) = delete;

  void Step(double dt);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_BULLET_BODY_H_
