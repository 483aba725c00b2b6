// Skinned bodies that stay inside the inner wall of a free rib cage (Skin.wall).
//
// A vertex p has the gap g (breathing/inner_wall.h), positive outside. Where it exceeds its limit, the gap at rest but
// at least 2 mm, the vertex is put back, twice, since the gap is not linear:
//   p -> p - h (g - limit) grad g / |grad g|^2,   v -> v - h (grad g . v + sum_j (dg/dk_j) k_j') grad g / |grad g|^2,
// k the coordinates of the cage. h falls from 1 to 0 with the distance at rest from the skin's obstacle, between 20 and
// 40 mm, since lungs follow the ribs alone above, and with that from the midsagittal plane, between 50 and 30 mm, since
// the gap, measured from the cage's axis, means little beside spine and sternum. So the margin of a lung, which a sheet
// pulls on as well, leaves the cage no further than at rest where ribs come down on it. All lengths are chosen.
//
// This is geometry of what is seen: no force acts, and no step computes it. Velocities leave out that the gradient
// turns, and the parts of the cage (sides, segments).
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_CAGE_LIMIT_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_CAGE_LIMIT_H_

#include <memory>
#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mechanics/motions/insertion.h"

namespace phrenic {

class CageLimit final : public SkinCorrection {
 public:
  // Of a body at `rest` (3 x n) [m], near the vertices of `obstacle`, a deformable body. The builder's model is at
  // rest.
  CageLimit(std::shared_ptr<const CageWall> wall, int obstacle, const ModelBuilder& builder, const Points& rest);

  void Place(const EvalContext& at, MutablePoints x) const override;
  void Move(const EvalContext& at, MutablePoints x, MutablePoints v) const override;

 private:
  struct Vertex {
    int index = 0;     // of the body
    double limit = 0;  // of its gap [m]
    double hold = 0;   // h
  };
  template <bool kVelocities>
  void PutBack(const EvalContext& at, MutablePoints x, MutablePoints v) const;

  const std::shared_ptr<const CageWall> wall_;
  std::vector<Vertex> vertices_;  // those with h above 0
};

// Adds the limit by the wall of the scene's skin, if it names one, to the skins of its bodies, which AddSkins has made.
// INVALID_ARGUMENT if no insertion before names that wall, or the skin has no obstacle; `path` is the scene's message.
absl::Status AddCageLimit(const v1::Skin& scene, std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_CAGE_LIMIT_H_
