#include "server/fit/surface_residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/point_residuals.h"
#include "server/mesh/triangle_tree.h"
#include "server/meshio/meshio.h"

namespace phrenic::fit {
namespace {

constexpr double kReach = 0.04, kSurfaceBlock = 0.04;  // [m]
constexpr double kAgree = 0.5;                         // cosine between normals
constexpr int kFewestMatched = 20, kFewestBlocks = 20;
constexpr Eigen::Index kPointsPerLung = 1200;

// A surface of a file, searched for its nearest points. Immutable.
class TargetSurface {
 public:
  explicit TargetSurface(Mesh mesh) : mesh_(std::move(mesh)), tree_(mesh_.vertices, mesh_.triangles) {
    tree_.Fit(mesh_.vertices, boxes_);
  }

  // The plane of the surface at its point nearest to p, with the normal on the side of `normal`.
  struct Plane {
    Eigen::Vector3d place, normal;
  };
  // Returns nothing if no point is within reach, the nearest is on an open border, or the normals disagree.
  std::optional<Plane> PlaneAt(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const {
    const SurfacePoint nearest = tree_.Nearest(mesh_.vertices, boxes_, p, kReach);
    if (nearest.triangle < 0 || nearest.on_boundary) return std::nullopt;
    const Eigen::Vector3i corners = tree_.triangle(nearest.triangle);
    const Eigen::Vector3d a = mesh_.vertices.col(corners[0]), b = mesh_.vertices.col(corners[1]),
                          c = mesh_.vertices.col(corners[2]);
    const Eigen::Vector3d own = (b - a).cross(c - a).normalized();
    if (!(std::abs(own.dot(normal)) >= kAgree)) return std::nullopt;
    return Plane{p + nearest.offset, own.dot(normal) < 0 ? Eigen::Vector3d(-own) : own};
  }

 private:
  Mesh mesh_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

// Points of the lungs' surfaces.
struct ModelPoints {
  Points places, normals;
  Eigen::MatrixXd responses;
};

// A point that is compared.
struct MatchedPoint {
  Eigen::Index point;
  TargetSurface::Plane plane;
};

class SurfaceResiduals final : public Residuals {
 public:
  SurfaceResiduals(KindOfData kind, ModelPoints points, const BreathSurfaces& surfaces, std::uint64_t split)
      : Residuals(std::move(kind)),
        points_(std::move(points)),
        inhale_(surfaces.inhale),
        offset_(Eigen::VectorXd::Zero(points_.places.cols())) {
    if (surfaces.exhale) FindOffsets(TargetSurface(*surfaces.exhale));
    HoldOut(split);
  }

  void Match(const Eigen::VectorXd& numbers) override {
    const Points moved = Moved(numbers);
    fitting_.clear();
    held_out_.clear();
    for (Eigen::Index i = 0; i < moved.cols(); ++i) {
      if (std::isnan(offset_[i])) continue;
      const auto plane = inhale_.PlaneAt(moved.col(i), points_.normals.col(i));
      if (plane) (held_[static_cast<size_t>(i)] ? held_out_ : fitting_).push_back({i, *plane});
    }
    std::vector<int> among;
    for (const MatchedPoint& each : fitting_) among.push_back(static_cast<int>(each.point));
    alike_ = AlikeOnes(points_.places, among);
  }

  int matched() const { return static_cast<int>(fitting_.size() + held_out_.size()); }

  Rows At(const Eigen::VectorXd& numbers, Part part) const override {
    const std::vector<MatchedPoint>& own = part == Part::kFitting ? fitting_ : held_out_;
    const auto count = static_cast<Eigen::Index>(own.size());
    const Points moved = Moved(numbers);
    const double sd = kind().sd;
    Rows rows = {Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::MatrixXd::Zero(count, numbers.size())};
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto& [i, plane] = own[static_cast<size_t>(k)];
      rows.residual[k] = plane.normal.dot(plane.place - moved.col(i)) - offset_[i];
      rows.weight[k] = 1 / (sd * sd * alike_[i]);
      rows.slope.row(k).head(points_.responses.cols()) =
          plane.normal.transpose() * points_.responses.middleRows<3>(3 * i);
    }
    return rows;
  }

 private:
  Points Moved(const Eigen::VectorXd& numbers) const {
    return points_.places +
           (points_.responses * numbers.head(points_.responses.cols())).reshaped(3, points_.places.cols());
  }

  // The distances at rest; NaN for points that the surface at end exhale does not reach.
  void FindOffsets(const TargetSurface& exhale) {
    for (Eigen::Index i = 0; i < offset_.size(); ++i) {
      const auto plane = exhale.PlaneAt(points_.places.col(i), points_.normals.col(i));
      offset_[i] = plane ? plane->normal.dot(plane->place - points_.places.col(i)) : std::nan("");
    }
  }

  // Holds out half of the blocks, whole ones.
  void HoldOut(std::uint64_t split) {
    std::map<std::array<int, 3>, std::vector<Eigen::Index>> blocks;
    for (Eigen::Index i = 0; i < points_.places.cols(); ++i) {
      const Eigen::Vector3i cell = (points_.places.col(i) / kSurfaceBlock).array().floor().cast<int>();
      blocks[{cell.x(), cell.y(), cell.z()}].push_back(i);
    }
    held_.assign(static_cast<size_t>(points_.places.cols()), false);
    if (blocks.size() < kFewestBlocks) return;
    const Halves halves = SplitInHalves(static_cast<int>(blocks.size()), split);
    int at = 0;
    for (const auto& [cell, indices] : blocks) {
      const bool out = std::binary_search(halves.held_out.begin(), halves.held_out.end(), at++);
      for (const Eigen::Index i : indices) held_[static_cast<size_t>(i)] = out;
    }
  }

  const ModelPoints points_;
  const TargetSurface inhale_;
  Eigen::VectorXd offset_;  // at rest [m]
  std::vector<bool> held_;
  std::vector<MatchedPoint> fitting_, held_out_;
  Eigen::VectorXd alike_;
};

// Returns evenly chosen points of the lungs' surfaces, of the bases alone for a diaphragm.
ModelPoints PointsOfLungs(const Person& person, SurfaceOf of) {
  std::vector<Eigen::Vector3d> places, normals;
  for (const Side side : {kRight, kLeft}) {
    const LungTissue& tissue = person.tissue(side);
    std::vector<Eigen::Index> own;
    for (Eigen::Index i = 0; i < tissue.points().cols(); ++i) {
      if (!(tissue.normals().col(i).squaredNorm() > 0.5)) continue;
      const BoundaryPlace place =
          PlaceOf(tissue.points().col(i), tissue.normals().col(i), tissue.box(), side == kLeft ? 1 : -1);
      if (of == SurfaceOf::kLungs || place.base > 0.5) own.push_back(i);
    }
    const auto count = static_cast<Eigen::Index>(own.size()), used = std::min(count, kPointsPerLung);
    for (Eigen::Index k = 0; k < used; ++k) {
      const Eigen::Index i = own[static_cast<size_t>(k * count / used)];
      places.emplace_back(tissue.points().col(i));
      normals.emplace_back(tissue.normals().col(i));
    }
  }
  ModelPoints points = {Points(3, static_cast<Eigen::Index>(places.size())), {}, {}};
  points.normals.resize(3, points.places.cols());
  for (size_t i = 0; i < places.size(); ++i) {
    points.places.col(static_cast<Eigen::Index>(i)) = places[i];
    points.normals.col(static_cast<Eigen::Index>(i)) = normals[i];
  }
  points.responses = person.Responses(points.places);
  return points;
}

}  // namespace

absl::StatusOr<Mesh> ParseBreathSurface(std::string_view name, std::string_view bytes) {
  absl::StatusOr<Mesh> mesh = meshio::Parse(name, bytes, 0.001);
  if (!mesh.ok()) return mesh;
  const auto refuse = [&](const std::string& text) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": ", text));
  };
  if (mesh->triangles.cols() == 0) return refuse("has no triangles: export the structure as a surface");
  constexpr double kLeast = 60, kMost = 600;  // [mm]
  const double extent = 1000 * (mesh->vertices.rowwise().maxCoeff() - mesh->vertices.rowwise().minCoeff()).maxCoeff();
  if (extent >= kLeast && extent <= kMost) return mesh;
  return refuse(absl::StrFormat("extends %.4g mm, a diaphragm or a lung %g to %g: coordinates must be in mm%s", extent,
                                kLeast, kMost, extent < kLeast ? " (multiply metres by 1000, centimetres by 10)" : ""));
}

absl::Status AddSurface(const KindOfData& kind, const BreathSurfaces& surfaces, const Person& person,
                        std::uint64_t split, AllResiduals& all, const FitSpace& space) {
  auto residuals = std::make_unique<SurfaceResiduals>(kind, PointsOfLungs(person, surfaces.of), surfaces, split);
  residuals->Match(space.Mean());
  if (residuals->matched() < kFewestMatched) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: %d points of the lungs' %s lie within %g mm of the surface: it must be in mm and LPS, in the frame of the "
        "other data, and cover the %s",
        kind.source, residuals->matched(), surfaces.of == SurfaceOf::kLungs ? "surfaces" : "bases", 1000 * kReach,
        surfaces.of == SurfaceOf::kLungs ? "lungs" : "domes below both lungs"));
  }
  all.push_back(std::move(residuals));
  return absl::OkStatus();
}

}  // namespace phrenic::fit
