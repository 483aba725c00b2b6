// Where the vertices of any body are and how they move: simulated, carried by a pose, riding or still.
#ifndef PHRENIC_SERVER_MECHANICS_BODY_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_BODY_POINTS_H_

#include <span>

#include "server/mechanics/model.h"

namespace phrenic {

// Of one body, by the instant alone, for elements, which do not see the model while they act. Refers to the body's mesh
// and ride: for the model's own elements, once all its bodies and motions are there. Immutable; any number of threads
// may call.
class BodyPoints {
 public:
  BodyPoints(const Model& model, int body);

  // 3 x vertices of the body, x [m] and v [m/s].
  struct Moving {
    ConstPoints x, v;
  };
  // Valid while the instant is, and until this thread locates another body. Allocates only while the largest body that
  // this thread has located grows.
  Moving Locate(const Instant& at) const;
  // The same for x alone, at half the price.
  ConstPoints Positions(const Instant& at) const;

  const Points& rest() const { return *rest_; }  // [m]
  // Place of its first vertex among the simulated ones; -1 where it is not simulated.
  int first_vertex() const { return first_vertex_; }

 private:
  template <bool kVelocities>
  Moving Place(const Instant& at) const;

  const Points* rest_;  // of the model, whose bodies stay where they are when it is moved
  int first_vertex_ = -1;
  int pose_ = -1;
  std::span<const RideShare> shares_;  // of the model
  Points carriers_;                    // simulated carriers at rest, one a share [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BODY_POINTS_H_
