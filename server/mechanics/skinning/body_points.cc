#include "server/mechanics/skinning/body_points.h"

#include <Eigen/Geometry>
#include <cstring>
#include <iterator>
#include <vector>

#include "server/mechanics/skinning/displacements.h"
#include "server/mechanics/skinning/sheet_points.h"
#include "server/mechanics/skinning/skin_kernel.h"

namespace phrenic {
namespace {

// Scratch memory, which keeps its capacity from one body to the next.
struct Placements {
  std::vector<double> positions, moving_positions, moving_velocities;
};

// The layers that were placed last: a frame, its probes and its measures are about the same ones.
struct PlacedLayers {
  const TriangleBinding* bindings = nullptr;  // null: none were placed
  Points sheet;                               // where its vertices were [m]
  Points x;                                   // [m]
};

bool SameBits(const Points& a, const ConstPoints& b) {
  return a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

Eigen::Map<Points> Fit(std::vector<double>& memory, const Points& like) {
  memory.resize(static_cast<size_t>(like.size()));
  return {memory.data(), 3, like.cols()};
}

// Output arrays x [m] and, with kVelocities, v [m/s].
struct Placed {
  MutablePoints x, v;
};

template <bool kVelocities>
void MoveRigidly(const Pose& pose, const Points& rest, Placed& out) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const Eigen::Vector3d turned = rotation * rest.col(i);
    out.x.col(i) = turned + pose.translation;
    if (kVelocities) out.v.col(i) = pose.velocity + pose.angular_velocity.cross(turned);
  }
}

// The corners of a triangle, or their velocities.
struct Corners {
  Eigen::Vector3d a, b, c;
  Corners(const ConstPoints& of, const TriangleBinding& binding)
      : a(of.col(binding.corners[0])), b(of.col(binding.corners[1])), c(of.col(binding.corners[2])) {}
  Eigen::Vector3d Weighted(const Eigen::Vector3d& weights) const {
    return weights[0] * a + weights[1] * b + weights[2] * c;
  }
};

// With the area vector N = (b - a) x (c - a) and n = N/|N|: dn/dt = (dN/dt - n (n . dN/dt))/|N|.
template <bool kVelocities>
void PlaceOnTriangle(const TriangleBinding& binding, const EvalContext& at, Eigen::Index i, Placed& out) {
  const Corners x(at.x, binding);
  const Eigen::Vector3d area = (x.b - x.a).cross(x.c - x.a), normal = area.stableNormalized();
  out.x.col(i) = x.Weighted(binding.weights) + binding.height * normal;
  if constexpr (!kVelocities) return;
  const Corners v(at.v, binding);
  out.v.col(i) = v.Weighted(binding.weights);
  const double size = area.stableNorm();
  if (!(size > 0)) return;
  const Eigen::Vector3d rate = (v.b - v.a).cross(x.c - x.a) + (x.b - x.a).cross(v.c - v.a);
  out.v.col(i) += binding.height / size * (rate - normal * normal.dot(rate));
}

template <bool kVelocities>
void PlaceOnTriangles(std::span<const TriangleBinding> bindings, const EvalContext& at, Placed& out) {
  for (size_t i = 0; i < bindings.size(); ++i) {
    PlaceOnTriangle<kVelocities>(bindings[i], at, static_cast<Eigen::Index>(i), out);
  }
}

}  // namespace

BodyPoints::BodyPoints(const Model& model, int body)
    : rest_(&model.bodies[body].mesh.vertices),
      first_vertex_(model.bodies[body].first_vertex),
      pose_(model.bodies[body].pose),
      driver_rest_(model.rest.data()) {
  const int skin = model.bodies[body].skin;
  if (skin < 0) return;
  weights_ = &model.skins[skin].weights;
  triangles_ = model.skins[skin].triangles;
  sheet_ = model.skins[skin].sheet.get();
  corrections_ = model.skins[skin].corrections;
}

// Does not write v without kVelocities.
template <bool kVelocities>
void BodyPoints::Follow(const EvalContext& at, MutablePoints x, MutablePoints v) const {
  if (sheet_ != nullptr) {
    if (kVelocities) return MoveOnSheet(*sheet_, triangles_, at, x, v);
    x = OnSheet(at);
    return;
  }
  Placed out{x, v};
  if (!triangles_.empty()) return PlaceOnTriangles<kVelocities>(triangles_, at, out);
  if (pose_ >= 0) return MoveRigidly<kVelocities>(at.poses[pose_], *rest_, out);
  const bool all_weighed = weights_ != nullptr && std::ssize(weights_->rows) == rest_->cols();
  if (!all_weighed) {
    x = *rest_;
    if (kVelocities) v.setZero();
  }
  if (weights_ == nullptr) return;
  const DriverState drivers = {PoseMatricesOf(at),
                               weights_->follow_simulated ? DisplacementsOf(at, driver_rest_) : nullptr, at.v.data()};
  ApplySkinWeights(*weights_, drivers, rest_->data(), x.data(), kVelocities ? v.data() : nullptr);
  for (const auto& correction : corrections_) kVelocities ? correction->Move(at, x, v) : correction->Place(at, x);
}

const Points& BodyPoints::OnSheet(const EvalContext& at) const {
  PlacedLayers& last = at.scratch.Get<PlacedLayers>();
  const ConstPoints sheet = at.x.middleCols(sheet_->first_vertex, sheet_->rest_areas.size());
  if (last.bindings == triangles_.data() && SameBits(last.sheet, sheet)) return last.x;
  last.bindings = nullptr;
  last.x.resize(3, rest_->cols());
  PlaceOnSheet(*sheet_, triangles_, at, last.x);
  last.sheet = sheet;
  last.bindings = triangles_.data();
  return last.x;
}

void BodyPoints::Place(const EvalContext& at, MutablePoints x) const {
  if (first_vertex_ >= 0) {
    x = at.x.middleCols(first_vertex_, rest_->cols());
  } else {
    Follow<false>(at, x, x);
  }
}

ConstPoints BodyPoints::Positions(const EvalContext& at) const {
  if (first_vertex_ >= 0) return at.x.middleCols(first_vertex_, rest_->cols());
  if (sheet_ != nullptr) return OnSheet(at);
  Eigen::Map<Points> x = Fit(at.scratch.Get<Placements>().positions, *rest_);
  Follow<false>(at, x, x);
  return x;
}

BodyPoints::Moving BodyPoints::Locate(const EvalContext& at) const {
  const Eigen::Index n = rest_->cols();
  if (first_vertex_ >= 0) return {at.x.middleCols(first_vertex_, n), at.v.middleCols(first_vertex_, n)};
  Placements& memory = at.scratch.Get<Placements>();
  Eigen::Map<Points> x = Fit(memory.moving_positions, *rest_), v = Fit(memory.moving_velocities, *rest_);
  Follow<true>(at, x, v);
  return {x, v};
}

void PlaceBody(const Model& model, const State& state, int body, MutablePoints out, const Scratch& scratch) {
  BodyPoints(model, body).Place(MakeEvalContext(model, model.parameters, state, scratch), out);
}

}  // namespace phrenic
