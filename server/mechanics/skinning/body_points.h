// Where the vertices of any body are and how they move: simulated, carried by a pose, riding or still.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_

#include <span>

#include "server/mechanics/model.h"

namespace phrenic {

// Of one body, by the instant alone, for elements, which do not see the model while they act; what is seen and exported
// is placed by the same. Refers to the model's bodies, rides and points at rest, which stay where they are when it is
// moved: for the model's own elements, once all its bodies and motions are there. Immutable; any number of threads may
// call.
class BodyPoints {
 public:
  BodyPoints(const Model& model, int body);

  // 3 x vertices of the body, x [m] and v [m/s].
  struct Moving {
    ConstPoints x, v;
  };
  // Valid while the instant is, and until this thread locates another body. Allocates only while the largest body that
  // this thread has located grows.
  Moving Locate(const EvalContext& at) const;
  // The same for x alone, at half the price.
  ConstPoints Positions(const EvalContext& at) const;
  // Into memory of one's own.
  void Place(const EvalContext& at, MutablePoints x) const;

  const Points& rest() const { return *rest_; }  // [m]
  // Place of its first vertex among the simulated ones; -1 where it is not simulated.
  int first_vertex() const { return first_vertex_; }

 private:
  template <bool kVelocities>
  void Follow(const EvalContext& at, MutablePoints x, MutablePoints v) const;

  const Points* rest_;
  int first_vertex_ = -1;
  int pose_ = -1;
  std::span<const SkinWeight> shares_;
  std::span<const TriangleBinding> triangles_;
  const double* carriers_;  // the simulated vertices at rest [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_
