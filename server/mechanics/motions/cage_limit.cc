#include "server/mechanics/motions/cage_limit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mesh/nearest.h"

namespace phrenic {
namespace {

constexpr int kPutBackRounds = 2;
constexpr double kLeastLimit = 0.002;                  // of the gap [m]
constexpr double kWhollyHeld = 0.02, kNotHeld = 0.04;  // distances from the obstacle with h = 1 and 0 [m]
constexpr double kLateral = 0.05, kMedial = 0.03;      // distances from the midsagittal plane, likewise [m]

// Returns the place of `value` between `none` and `whole`, from 0 to 1.
double ShareOf(double value, double none, double whole) {
  return std::clamp((value - none) / (whole - none), 0.0, 1.0);
}

}  // namespace

CageLimit::CageLimit(std::shared_ptr<const CageWall> wall, int obstacle, const ModelBuilder& builder,
                     const Points& rest)
    : wall_(std::move(wall)) {
  const State state = builder.model.InitialState();
  const EvalContext at = MakeEvalContext(builder.model, builder.model.parameters, state);
  const WallTable& table = wall_->TableAt(at);
  const NearestSearch& search = builder.Search(obstacle);
  for (int i = 0; i < static_cast<int>(rest.cols()) && !builder.stop.Stopped(); ++i) {
    const Neighbour nearest = search.Nearest(rest.col(i), kNotHeld);
    if (nearest.vertex < 0) continue;
    const double hold =
        ShareOf(nearest.distance, kNotHeld, kWhollyHeld) * ShareOf(std::abs(rest(0, i)), kMedial, kLateral);
    if (hold == 0) continue;
    vertices_.push_back({i, std::max(kLeastLimit, wall_->wall.GapAlone(table, rest.col(i))), hold});
  }
}

template <bool kVelocities>
void CageLimit::PutBack(const EvalContext& at, MutablePoints x, MutablePoints v) const {
  const WallTable& table = wall_->TableAt(at);
  const CagePosition rate = kVelocities ? wall_->Rate(at) : CagePosition{};
  for (const Vertex& vertex : vertices_) {
    const int i = vertex.index;
    for (int round = 0; round < kPutBackRounds; ++round) {
      if (wall_->wall.IsFarInside(table, x.col(i), 0)) break;
      const double excess = wall_->wall.GapAlone(table, x.col(i)) - vertex.limit;
      if (!(excess > 0)) break;
      const WallGap gap = wall_->wall.Gap(table, x.col(i));
      const Eigen::Vector3d way = vertex.hold / gap.gradient.squaredNorm() * gap.gradient;
      x.col(i) -= excess * way;
      if constexpr (!kVelocities) continue;
      v.col(i) -= (gap.gradient.dot(v.col(i)) + gap.by_pump * rate.pump + gap.by_bucket * rate.bucket) * way;
    }
  }
}

void CageLimit::Place(const EvalContext& at, MutablePoints x) const { PutBack<false>(at, x, x); }

void CageLimit::Move(const EvalContext& at, MutablePoints x, MutablePoints v) const { PutBack<true>(at, x, v); }

absl::Status AddCageLimit(const v1::Skin& scene, std::string_view path, ModelBuilder& builder) {
  if (scene.wall().empty()) return absl::OkStatus();
  const auto wall = FindCageWall(scene.wall(), absl::StrCat(std::string(path), ".wall"), builder);
  if (!wall.ok()) return wall.status();
  const auto bodies = builder.Bodies(scene.bodies(), path);
  if (!bodies.ok()) return bodies.status();
  if (scene.obstacle().empty()) {
    return FieldError(absl::StrCat(std::string(path), ".wall"),
                      "needs an obstacle, near which it holds; set `obstacle`");
  }
  const auto obstacle = builder.Body(scene.obstacle(), absl::StrCat(std::string(path), ".obstacle"));
  if (!obstacle.ok()) return obstacle.status();
  for (const int b : *bodies) {
    const BodyModel& seen = builder.model.bodies[b];
    builder.model.skins[seen.skin].corrections.push_back(
        std::make_shared<CageLimit>(*wall, *obstacle, builder, seen.mesh.vertices));
  }
  return absl::OkStatus();
}

}  // namespace phrenic
