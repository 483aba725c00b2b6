// Positions and velocities of the vertices of any body: simulated, moved by a pose, skinned (skin.h) or fixed.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_

#include <span>

#include "server/mechanics/model.h"

namespace phrenic {

// The points of one body as a function of the EvalContext only, for elements (which have no access to the model when
// they are evaluated), frames and exports. Refers to the model's bodies, skins and rest positions, which keep their
// addresses when the model is moved. Requires: the model has all its bodies, motions and skins. Immutable and
// thread-safe, for threads with scratch memory of their own.
class BodyPoints {
 public:
  BodyPoints(const Model& model, int body);

  // Positions [m] and velocities [m/s], 3 x vertices of the body.
  struct Moving {
    ConstPoints x, v;
  };
  // Returns both. They are valid as long as the context, and until the next call with the same scratch memory.
  // Allocates if this is the largest body located with that memory so far.
  Moving Locate(const EvalContext& at) const;
  // Returns positions only, at half the cost; for the layers of a sheet at that of a comparison, if the same scratch
  // memory placed them last, for the same positions of the sheet.
  ConstPoints Positions(const EvalContext& at) const;
  // Sets x to the positions, 3 x vertices of the body [m].
  void Place(const EvalContext& at, MutablePoints x) const;

  const Points& rest() const { return *rest_; }  // [m]
  // Index of its first vertex among the simulated ones; -1 if it is not simulated.
  int first_vertex() const { return first_vertex_; }

 private:
  template <bool kVelocities>
  void Follow(const EvalContext& at, MutablePoints x, MutablePoints v) const;
  const Points& OnSheet(const EvalContext& at) const;

  const Points* rest_;
  int first_vertex_ = -1;
  int pose_ = -1;
  const SkinWeights* weights_ = nullptr;  // null: it has no skin
  std::span<const TriangleBinding> triangles_;
  const DriverSheet* sheet_ = nullptr;  // to which triangles_ are bound; null if to flat triangles
  std::span<const std::shared_ptr<const SkinCorrection>> corrections_;
  const double* driver_rest_;  // the simulated vertices at rest [m]
};

// Sets `out`, 3 x vertices of the body, to the positions of all vertices of a body in a state [m]. Thread-safe, for
// threads with scratch memory of their own.
void PlaceBody(const Model& model, const State& state, int body, MutablePoints out, const Scratch& scratch = {});

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_BODY_POINTS_H_
