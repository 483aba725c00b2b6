#include "server/mechanics/body_points.h"

#include <Eigen/Geometry>
#include <vector>

namespace phrenic {
namespace {

// Memory that keeps its capacity from body to body.
Eigen::Map<Points> Fit(std::vector<double>& memory, const Points& like) {
  memory.resize(static_cast<size_t>(like.size()));
  return {memory.data(), 3, like.cols()};
}

// a x . [1/s] as a matrix
Eigen::Matrix3d Cross(const Eigen::Vector3d& a) {
  return Eigen::Matrix3d{{0, -a.z(), a.y()}, {a.z(), 0, -a.x()}, {-a.y(), a.x(), 0}};
}

// What a pose adds to a point of its rest: displacement [m] and velocity [m/s].
struct Affine {
  Eigen::Matrix3d linear, rate;
  Eigen::Vector3d offset, velocity;

  Affine() = default;
  explicit Affine(const Pose& pose) : offset(pose.translation), velocity(pose.velocity) {
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    linear = rotation - Eigen::Matrix3d::Identity();
    rate = Cross(pose.angular_velocity) * rotation;
  }
};

// Once a call, not once a vertex.
const std::vector<Affine>& ByPose(const Instant& at) {
  thread_local std::vector<Affine> affines;
  affines.resize(at.poses.size());
  for (size_t i = 0; i < affines.size(); ++i) affines[i] = Affine(at.poses[i]);
  return affines;
}

// 3 x vertices: x [m], and v [m/s] where kVelocities.
struct Placed {
  MutablePoints x, v;
};

template <bool kVelocities>
void Carry(const Affine& pose, double weight, const Points& rest, Eigen::Index i, Placed& out) {
  const Eigen::Vector3d moved = pose.linear * rest.col(i) + pose.offset;
  out.x.col(i) += weight * moved;
  if constexpr (!kVelocities) return;
  const Eigen::Vector3d velocity = pose.rate * rest.col(i) + pose.velocity;
  out.v.col(i) += weight * velocity;
}

template <bool kVelocities>
void CarryAll(const Affine& pose, const Points& rest, Placed& out) {
  for (Eigen::Index i = 0; i < rest.cols(); ++i) Carry<kVelocities>(pose, 1, rest, i, out);
}

template <bool kVelocities>
void CarryShares(std::span<const RideShare> shares, const Points& rest, const ConstPoints& carriers, const Instant& at,
                 Placed& out) {
  const std::vector<Affine>& by_pose = ByPose(at);
  for (const auto& [vertex, pose, carrier, weight] : shares) {
    if (pose >= 0) {
      Carry<kVelocities>(by_pose[pose], weight, rest, vertex, out);
      continue;
    }
    out.x.col(vertex) += weight * (at.x.col(carrier) - carriers.col(carrier));
    if (kVelocities) out.v.col(vertex) += weight * at.v.col(carrier);
  }
}

// The corners of a triangle, or their velocities.
struct Corners {
  Eigen::Vector3d a, b, c;
  Corners(const ConstPoints& of, const TriangleShare& share)
      : a(of.col(share.corners[0])), b(of.col(share.corners[1])), c(of.col(share.corners[2])) {}
  Eigen::Vector3d Weighted(const Eigen::Vector3d& weights) const {
    return weights[0] * a + weights[1] * b + weights[2] * c;
  }
};

// Of the area vector N = (b - a) x (c - a), n = N/|N| turns at dn/dt = (dN/dt - n (n . dN/dt))/|N|.
template <bool kVelocities>
void PlaceOnTriangle(const TriangleShare& share, const Instant& at, Eigen::Index i, Placed& out) {
  const Corners x(at.x, share);
  const Eigen::Vector3d area = (x.b - x.a).cross(x.c - x.a), normal = area.stableNormalized();
  out.x.col(i) = x.Weighted(share.weights) + share.height * normal;
  if constexpr (!kVelocities) return;
  const Corners v(at.v, share);
  out.v.col(i) = v.Weighted(share.weights);
  const double size = area.stableNorm();
  if (!(size > 0)) return;
  const Eigen::Vector3d rate = (v.b - v.a).cross(x.c - x.a) + (x.b - x.a).cross(v.c - v.a);
  out.v.col(i) += share.height / size * (rate - normal * normal.dot(rate));
}

template <bool kVelocities>
void PlaceOnTriangles(std::span<const TriangleShare> shares, const Instant& at, Placed& out) {
  for (size_t i = 0; i < shares.size(); ++i) {
    PlaceOnTriangle<kVelocities>(shares[i], at, static_cast<Eigen::Index>(i), out);
  }
}

}  // namespace

BodyPoints::BodyPoints(const Model& model, int body)
    : rest_(&model.bodies[body].mesh.vertices),
      first_vertex_(model.bodies[body].first_vertex),
      pose_(model.bodies[body].pose),
      carriers_(model.rest.data(), 3, model.rest.cols()) {
  const int ride = model.bodies[body].ride;
  if (ride < 0) return;
  shares_ = model.rides[ride].shares;
  triangles_ = model.rides[ride].triangles;
}

// Without velocities, v is not written.
template <bool kVelocities>
void BodyPoints::Follow(const Instant& at, MutablePoints x, MutablePoints v) const {
  Placed out{x, v};
  if (!triangles_.empty()) return PlaceOnTriangles<kVelocities>(triangles_, at, out);
  x = *rest_;
  if (kVelocities) v.setZero();
  if (pose_ >= 0) return CarryAll<kVelocities>(Affine(at.poses[pose_]), *rest_, out);
  CarryShares<kVelocities>(shares_, *rest_, carriers_, at, out);
}

void BodyPoints::Place(const Instant& at, MutablePoints x) const {
  if (first_vertex_ >= 0) {
    x = at.x.middleCols(first_vertex_, rest_->cols());
  } else {
    Follow<false>(at, x, x);
  }
}

ConstPoints BodyPoints::Positions(const Instant& at) const {
  if (first_vertex_ >= 0) return at.x.middleCols(first_vertex_, rest_->cols());
  thread_local std::vector<double> memory;
  Eigen::Map<Points> x = Fit(memory, *rest_);
  Follow<false>(at, x, x);
  return x;
}

BodyPoints::Moving BodyPoints::Locate(const Instant& at) const {
  const Eigen::Index n = rest_->cols();
  if (first_vertex_ >= 0) return {at.x.middleCols(first_vertex_, n), at.v.middleCols(first_vertex_, n)};
  thread_local std::vector<double> positions, velocities;
  Eigen::Map<Points> x = Fit(positions, *rest_), v = Fit(velocities, *rest_);
  Follow<true>(at, x, v);
  return {x, v};
}

}  // namespace phrenic
