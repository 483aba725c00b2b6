// Vertices of a deformable body that are inserted on the inner wall of a free rib cage, and move with it:
//   x_i = x_i0 + d_i(k),  v_i = sum_j (dx_i/dk_j) k_j',
// d_i a quadratic in the cage's coordinates k where the vertex is (breathing/inner_wall.h). The forces f_i on them act
// on the cage, by virtual work: Q_j += sum_i f_i . dx_i/dk_j. Where the wall does not move with the bones the vertices
// are still.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_INSERTION_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_INSERTION_H_

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "server/mechanics/breathing/inner_wall.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// The wall of a free cage, the coordinates that move it, and the border of the sheet inserted on it.
struct CageWall {
  int body = 0;  // of the wall
  Coordinate pump, bucket;
  InnerWall wall;
  std::vector<int> border = {};                    // simulated vertices, in the order of their triangles' edges
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();  // of the cones by which volumes are measured [m]
  InnerWall::Volumes volumes = {};                 // inside the wall, above the border

  std::array<std::optional<Coordinate>, kCageParts> parts = {};  // those that the cage has

  CagePosition Position(const EvalContext& at) const;
  CagePosition Rate(const EvalContext& at) const;
  // True if forces move the part: in health the cage holds it. The sides move apart if a live parameter of one side
  // departs from its default, a segment if it is broken. Where forces are balanced at rest every part moves.
  bool Moves(size_t part, const EvalContext& at) const;
  MovingParts Moving(const EvalContext& at) const;
  // Returns the wall's table at a moment, valid until the next call with the same scratch memory. Those who ask at the
  // same position of the cage share it.
  const WallTable& TableAt(const EvalContext& at) const;
  // Adds generalised forces to the parts that move [J].
  void AddPartForces(const std::array<double, kCageParts>& force, const EvalContext& at, MutablePoints f) const;
};

class Insertion final : public Motion {
 public:
  // Fixes the vertices to the wall. Requires: the motions of the wall's bones, and its skin, come before.
  // INVALID_ARGUMENT if the ribs are not free, the wall is no polar grid (breathing/wall_grid.h) or is not skinned, or
  // the body is not deformable.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Insertion& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  void Drive(const EvalContext& at, State& state) const override;
  bool follows_coordinates() const override { return true; }
  void TransferForces(const EvalContext& at, MutablePoints f) const override;

  const std::shared_ptr<const CageWall>& wall() const { return wall_; }

 private:
  struct Inserted {
    int vertex;                // simulated
    Eigen::Vector3d rest;      // [m]
    InnerWall::Follower path;  // of the wall there
  };
  struct Paths;  // of all inserted vertices, at one position of the cage
  Insertion(std::string name, std::shared_ptr<const CageWall> wall) : Motion(std::move(name)), wall_(std::move(wall)) {}
  const Paths& PathsAt(const CagePosition& shared, const Scratch& scratch) const;

  const std::shared_ptr<const CageWall> wall_;
  std::vector<Inserted> inserted_;
};

// Returns the wall that an insertion of the scene has made of a body. INVALID_ARGUMENT with the path and the remedy if
// no insertion names the body.
absl::StatusOr<std::shared_ptr<const CageWall>> FindCageWall(const std::string& body, std::string_view path,
                                                             const ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_INSERTION_H_
