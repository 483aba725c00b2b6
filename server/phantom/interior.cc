#include "server/phantom/interior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "server/mesh/normals.h"
#include "server/mesh/topology.h"

namespace phrenic::phantom {
namespace {

constexpr double kCompact = 0.007;  // volume by area [m] of what is not thin: a ball of 21 mm radius
constexpr double kRigid = 2e-5;     // largest error of a rigid motion [m]
constexpr double kClose = 1e-4;     // distance of boundary and surface below which iterations end [m]
constexpr int kIterations = 12;

// Returns the rigid motion from one set of points to another if it is one.
std::optional<Eigen::Isometry3d> RigidMotion(const Points& from, const Points& to) {
  if (from.cols() < 4) return std::nullopt;
  const Eigen::Isometry3d motion(Eigen::umeyama(from, to, false));
  if (((motion * from) - to).colwise().norm().maxCoeff() > kRigid) return std::nullopt;
  return motion;
}

// Returns the elastic tissue in a surface; nullopt where it is thin, or with an error in `made` where tissue cannot be
// made in it.
std::optional<LungTissue> TissueIn(const Mesh& surface, bool slides, absl::Status& made) {
  const double volume = std::abs(SignedVolume(surface.vertices, surface.triangles));
  if (volume < kCompact * VertexAreas(surface.vertices, surface.triangles).sum()) return std::nullopt;
  LungElasticity elasticity;
  if (!slides) elasticity.tangential = elasticity.contact;
  absl::StatusOr<LungTissue> tissue = LungTissue::Make(surface, elasticity);
  made = tissue.status();
  if (!made.ok()) return std::nullopt;
  return *std::move(tissue);
}

Points Centroids(const Points& vertices, const Triangles& triangles) {
  Points centroids(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    centroids.col(t) = vertices(Eigen::all, triangles.col(t)).rowwise().mean();
  }
  return centroids;
}

double Percentile95(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Interior::Interior(Mesh surface, bool slides)
    : surface_(std::move(surface)),
      slides_(slides),
      tissue_(TissueIn(surface_, slides, made_)),
      tree_(surface_.vertices, surface_.triangles),
      rigid_(Eigen::Isometry3d::Identity()) {
  tree_.Fit(surface_.vertices, boxes_);
}

void Interior::MoveTo(const Points& vertices) {
  misfit_ = 0;
  displacement_ = vertices - surface_.vertices;
  rigid_ = RigidMotion(surface_.vertices, vertices);
  if (tissue_ && !rigid_) FollowSurface(vertices);
}

// The springs at the boundary are linear in the normals before the motion. What they leave, and what the curvature of
// the moved surface adds, is added to what they pull to until the moved boundary lies on the moved surface.
void Interior::FollowSurface(const Points& vertices) {
  const TriangleTree tree(vertices, surface_.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(vertices, boxes);
  const Points goal = Centroids(vertices, surface_.triangles);
  const Points& start = tissue_->points();
  Points pull = goal - start;
  std::vector<double> distances(static_cast<std::size_t>(start.cols()));
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterations; ++i) {
    const Points nodes = tissue_->SolveVectors(pull);
    for (Eigen::Index p = 0; p < start.cols(); ++p) {
      const Eigen::Vector3d now = start.col(p) + tissue_->DisplacementAt(nodes, start.col(p));
      const Eigen::Vector3d left =
          slides_ ? tree.Nearest(vertices, boxes, now, std::numeric_limits<double>::infinity()).offset
                  : Eigen::Vector3d(goal.col(p) - now);
      distances[static_cast<std::size_t>(p)] = left.norm();
      pull.col(p) += left;
    }
    const double misfit = Percentile95(distances);
    if (misfit > before) break;  // the solution before was better
    nodes_ = nodes;
    misfit_ = before = misfit;
    if (misfit < kClose) break;
  }
}

Eigen::Vector3d Interior::DisplacementAt(const Eigen::Vector3d& point) const {
  if (rigid_) return *rigid_ * point - point;
  if (tissue_) return tissue_->DisplacementAt(nodes_, point);
  const SurfacePoint nearest = tree_.Nearest(surface_.vertices, boxes_, point, std::numeric_limits<double>::infinity());
  return displacement_(Eigen::all, tree_.triangle(nearest.triangle)) * nearest.weights;
}

Eigen::Vector3d Interior::OriginOf(const Eigen::Vector3d& place) const {
  if (rigid_) return rigid_->inverse() * place;
  constexpr double kEnough = 1e-6;  // [m]
  Eigen::Vector3d point = place - DisplacementAt(place);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector3d left = place - point - DisplacementAt(point);
    if (left.norm() < kEnough) break;
    if (!tissue_) {
      point += left;
      continue;
    }
    const Eigen::Matrix3d slope = Eigen::Matrix3d::Identity() + tissue_->GradientAt(nodes_, point);
    point += slope.determinant() > 0.1 ? Eigen::Vector3d(slope.inverse() * left) : left;
  }
  return point;
}

double Interior::VolumeRatioAt(const Eigen::Vector3d& point) const {
  if (rigid_ || !tissue_) return 1;
  return (Eigen::Matrix3d::Identity() + tissue_->GradientAt(nodes_, point)).determinant();
}

}  // namespace phrenic::phantom
