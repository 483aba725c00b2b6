#include "server/calibrate/cage_markers.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/nearest.h"

namespace phrenic::calibrate {
namespace {

using fit::Part;
using physiology::Recording;

constexpr double kSwaySd = 0.005;                             // [m]
constexpr double kLeastScale = 0.6, kMostScale = 1.6;         // of a chest over the scene's
constexpr double kMostCageRms = 0.025, kLeastBreadth = 0.03;  // [m]
constexpr double kAmbiguous = 0.03;                           // [m]
constexpr int kMatches = 200;
constexpr int kFewestToHoldOut = 8, kHeldOutStride = 4;

struct Bone {
  int body;
  std::string name;
  Points points;  // at rest
  NearestSearch search;
};

std::vector<Bone> BonesOf(const physiology::Subject& subject) {
  std::vector<Bone> bones;
  const Model& model = subject.model;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const v1::Structure structure = model.bodies[b].anatomy.structure();
    const bool bone = structure == v1::STRUCTURE_RIB || structure == v1::STRUCTURE_STERNUM_BODY ||
                      structure == v1::STRUCTURE_MANUBRIUM || structure == v1::STRUCTURE_XIPHOID;
    const Points& points = model.bodies[b].mesh.vertices;
    if (bone && points.cols() > 0) {
      bones.push_back({static_cast<int>(b), model.bodies[b].name, points, NearestSearch(points)});
    }
  }
  return bones;
}

// Returns the bone whose name the marker's begins with: the longest, which a letter or digit does not follow.
const Bone* BoneOf(const std::string& marker, const std::vector<Bone>& bones) {
  const Bone* found = nullptr;
  for (const Bone& bone : bones) {
    if (!marker.starts_with(bone.name)) continue;
    if (marker.size() > bone.name.size() && std::isalnum(static_cast<unsigned char>(marker[bone.name.size()])) != 0) {
      continue;
    }
    if (found == nullptr || bone.name.size() > found->name.size()) found = &bone;
  }
  return found;
}

struct NamedMarkers {
  Points places;
  std::vector<const Bone*> bones;
  std::vector<int> vertices;  // of the bones; -1: any
};

// Returns the vertex of a bone that is foremost, outermost or hindmost.
int ExtremeOf(const Bone& bone, std::string_view which) {
  Eigen::Index at = -1;
  if (which.ends_with("front")) bone.points.row(1).minCoeff(&at);
  if (which.ends_with("back")) bone.points.row(1).maxCoeff(&at);
  if (which.ends_with("side")) bone.points.row(0).cwiseAbs().maxCoeff(&at);
  return static_cast<int>(at);
}

NamedMarkers NamedOnes(const fit::Markers& markers, const std::vector<Bone>& bones) {
  NamedMarkers named;
  std::vector<Eigen::Index> indices;
  for (size_t i = 0; i < markers.names.size(); ++i) {
    const Bone* bone = BoneOf(markers.names[i], bones);
    if (bone == nullptr) continue;
    indices.push_back(static_cast<Eigen::Index>(i));
    named.bones.push_back(bone);
    named.vertices.push_back(ExtremeOf(*bone, markers.names[i]));
  }
  named.places = markers.rest(Eigen::all, indices);
  return named;
}

struct Similarity {
  Eigen::Affine3d to_scene = Eigen::Affine3d::Identity();
  double rms = HUGE_VAL;
};

// Matches and moves in turn, from the first places on the bones.
Similarity MatchFrom(const NamedMarkers& named, const Points& first) {
  Similarity found;
  Points on_bones = first;
  for (int i = 0; i < kMatches; ++i) {
    const Eigen::Matrix4d moved = Eigen::umeyama(named.places, on_bones, true);
    if (!moved.allFinite()) return found;
    found.to_scene.matrix() = moved;
    const Points there = found.to_scene * named.places;
    const double before = found.rms;
    for (Eigen::Index k = 0; k < there.cols(); ++k) {
      const Bone& bone = *named.bones[static_cast<size_t>(k)];
      const int known = named.vertices[static_cast<size_t>(k)];
      on_bones.col(k) = bone.points.col(known >= 0 ? known : bone.search.Nearest(there.col(k)).vertex);
    }
    found.rms = std::sqrt((there - on_bones).colwise().squaredNorm().mean());
    if (std::abs(before - found.rms) < 1e-7) break;
  }
  return found;
}

// Matches from the bones' middles, foremost, hindmost and outermost points; the nearest match first.
std::vector<Similarity> Matches(const NamedMarkers& named) {
  std::vector<Similarity> matches;
  for (const char* start : {"", "front", "back", "side"}) {
    Points first(3, named.places.cols());
    for (Eigen::Index k = 0; k < first.cols(); ++k) {
      const Bone& bone = *named.bones[static_cast<size_t>(k)];
      const int known = named.vertices[static_cast<size_t>(k)], at = known >= 0 ? known : ExtremeOf(bone, start);
      first.col(k) = at < 0 ? Eigen::Vector3d(bone.points.rowwise().mean()) : Eigen::Vector3d(bone.points.col(at));
    }
    matches.push_back(MatchFrom(named, first));
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Similarity& a, const Similarity& b) { return a.rms < b.rms; });
  return matches;
}

absl::Status CheckNamed(const std::string& source, const NamedMarkers& named) {
  const std::set<const Bone*> bones(named.bones.begin(), named.bones.end());
  if (static_cast<int>(named.bones.size()) < kFewestNamedMarkers || bones.size() < 3) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: %d markers over %d bones are named after bones of the scene: name %d or more, over three "
                        "bones, after what "
                        "they lie over, such as \"rib-7-right\", \"rib-4-left front\", \"sternum-body\", so that the "
                        "others can be placed",
                        source, named.bones.size(), bones.size(), kFewestNamedMarkers));
  }
  const Points centred = named.places.colwise() - Eigen::Vector3d(named.places.rowwise().mean());
  const double breadth = Eigen::JacobiSVD<Eigen::MatrixXd>(centred).singularValues()[1];
  if (breadth / std::sqrt(static_cast<double>(centred.cols())) >= kLeastBreadth) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      source,
      ": the named markers lie almost on a line, which does not tell how the chest is turned: name others too"));
}

absl::Status CheckMatch(const std::string& source, const NamedMarkers& named, const std::vector<Similarity>& matches) {
  const Similarity& match = matches.front();
  NamedMarkers mirrored = named;
  mirrored.places.row(0) *= -1;
  if (Matches(mirrored).front().rms < 0.6 * match.rms) {
    return absl::InvalidArgumentError(absl::StrCat(
        source,
        ": the named markers are the mirror image of a chest: an axis has the wrong sign, or left and right are "
        "exchanged"));
  }
  const double scale = 1 / std::cbrt(match.to_scene.linear().determinant());
  if (!(scale >= kLeastScale && scale <= kMostScale)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: the named markers lie %.3g times as far apart as the scene's bones: are they in mm, and is each over the "
        "bone that it is named after?",
        source, scale));
  }
  for (const Similarity& other : matches) {
    const Points apart = other.to_scene * named.places - match.to_scene * named.places;
    if (other.rms > 1.5 * match.rms + 0.003 || std::sqrt(apart.colwise().squaredNorm().mean()) < kAmbiguous) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(source,
                     ": the named markers fit onto their bones in two ways: name where on a bone they are, such as "
                     "\"rib-7-right front\" (also side, back), or name markers over more bones of both sides"));
  }
  if (match.rms <= kMostCageRms) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s: the named markers lie %.3g mm from the bones they are named after, at best: is each over its bone?", source,
      1000 * match.rms));
}

const Bone& NearestBone(const Eigen::Vector3d& place, const std::vector<Bone>& bones) {
  const auto distance = [&place](const Bone& bone) { return bone.search.Nearest(place).distance; };
  return *std::min_element(bones.begin(), bones.end(),
                           [&](const Bone& a, const Bone& b) { return distance(a) < distance(b); });
}

// Sets the bone, its vertex and the wall's normal for each marker.
void PlaceOnBones(const physiology::Subject& subject, const std::vector<Bone>& bones, const fit::Markers& markers,
                  CageRegistration& cage) {
  const Mesh& wall = subject.model.bodies[static_cast<size_t>(subject.parts.wall)].mesh;
  Points normals = Points::Zero(3, wall.vertices.cols());
  for (const auto& triangle : wall.triangles.colwise()) {
    const Eigen::Vector3d a = wall.vertices.col(triangle[0]), b = wall.vertices.col(triangle[1]);
    const Eigen::Vector3d normal = (b - a).cross(Eigen::Vector3d(wall.vertices.col(triangle[2])) - a);
    for (int c = 0; c < 3; ++c) normals.col(triangle[c]) += normal;
  }
  const Eigen::Vector3d middle = wall.vertices.rowwise().mean();
  const NearestSearch on_wall(wall.vertices);
  const Points places = cage.to_scene * markers.rest;
  cage.normals.resize(3, places.cols());
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const Bone* bone = BoneOf(markers.names[static_cast<size_t>(i)], bones);
    if (bone == nullptr) bone = &NearestBone(places.col(i), bones);
    cage.bones.push_back(bone->body);
    cage.vertices.push_back(bone->search.Nearest(places.col(i)).vertex);
    const int vertex = on_wall.Nearest(places.col(i)).vertex;
    const Eigen::Vector3d normal = normals.col(vertex).stableNormalized();
    const Eigen::Vector3d outwards = Eigen::Vector3d(wall.vertices.col(vertex)) - middle;
    cage.normals.col(i) = normal.dot(outwards) < 0 ? Eigen::Vector3d(-normal) : normal;
  }
}

class CageMarkers final : public BreathData {
 public:
  CageMarkers(const physiology::Subject& subject, const fit::Evidence::MarkerFile& file, CageRegistration cage)
      : BreathData(file.kind), subject_(subject), cage_(std::move(cage)) {
    const Points motion = file.markers.motion;
    along_.resize(motion.cols());
    const Eigen::Matrix3d turn = cage_.to_scene.rotation();
    for (Eigen::Index i = 0; i < motion.cols(); ++i) along_[i] = cage_.normals.col(i).dot(turn * motion.col(i));
    const bool holds_out = motion.cols() >= kFewestToHoldOut;
    for (int i = 0; i < static_cast<int>(motion.cols()); ++i) {
      (holds_out && i % kHeldOutStride == kHeldOutStride - 1 ? held_out_ : fitting_).push_back(i);
    }
    Doubt(absl::StrFormat("%s: turned and scaled by %.3g onto the scene's ribs, %.1f mm off %d named markers",
                          file.kind.source, cage_.scale, 1000 * cage_.rms, cage_.named));
  }

  std::vector<OwnNumber> OwnNumbers() const override {
    return {{"sway x", "mm", 1e-3, kSwaySd}, {"sway y", "mm", 1e-3, kSwaySd}, {"sway z", "mm", 1e-3, kSwaySd}};
  }
  Eigen::VectorXd Values(Part part) const override { return along_(Of(part)); }
  Eigen::VectorXd Weights(Part part) const override {
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(Of(part).size()), 1 / (kind().sd * kind().sd));
  }

  Eigen::VectorXd Predict(const Recording& breath, const Eigen::VectorXd& own, Part part,
                          Eigen::MatrixXd* slopes) const override {
    const std::vector<int>& markers = Of(part);
    Eigen::VectorXd predicted(static_cast<Eigen::Index>(markers.size()));
    if (slopes != nullptr) slopes->resize(predicted.size(), 3);
    int placed = -1;
    Points moved;
    for (Eigen::Index k = 0; k < predicted.size(); ++k) {
      const auto i = static_cast<size_t>(markers[static_cast<size_t>(k)]);
      if (cage_.bones[i] != placed) {
        placed = cage_.bones[i];
        moved = physiology::Placed(subject_.model, breath.peak, placed) -
                physiology::Placed(subject_.model, breath.base, placed);
      }
      const Eigen::Vector3d normal = cage_.normals.col(static_cast<Eigen::Index>(i));
      predicted[k] = normal.dot(Eigen::Vector3d(moved.col(cage_.vertices[i])) + Eigen::Vector3d(own));
      if (slopes != nullptr) slopes->row(k) = normal.transpose();
    }
    return predicted;
  }

 private:
  const std::vector<int>& Of(Part part) const { return part == Part::kFitting ? fitting_ : held_out_; }

  const physiology::Subject& subject_;
  const CageRegistration cage_;
  Eigen::VectorXd along_;  // the normals
  std::vector<int> fitting_, held_out_;
};

}  // namespace

absl::StatusOr<CageRegistration> RegisterToCage(const physiology::Subject& subject, const std::string& source,
                                                const fit::Markers& markers) {
  const std::vector<Bone> bones = BonesOf(subject);
  if (bones.empty() || subject.parts.wall < 0) {
    return absl::FailedPreconditionError(
        "the scene has no ribs with an inner wall of the cage that markers could move");
  }
  const NamedMarkers named = NamedOnes(markers, bones);
  if (absl::Status status = CheckNamed(source, named); !status.ok()) return status;
  const std::vector<Similarity> matches = Matches(named);
  if (absl::Status status = CheckMatch(source, named, matches); !status.ok()) return status;
  const Similarity& match = matches.front();
  CageRegistration cage;
  cage.to_scene = match.to_scene;
  cage.scale = std::cbrt(match.to_scene.linear().determinant());
  cage.rms = match.rms;
  cage.named = static_cast<int>(named.bones.size());
  PlaceOnBones(subject, bones, markers, cage);
  return cage;
}

absl::StatusOr<std::unique_ptr<BreathData>> CageData(const physiology::Subject& subject,
                                                     const fit::Evidence::MarkerFile& file) {
  absl::StatusOr<CageRegistration> cage = RegisterToCage(subject, file.kind.source, file.markers);
  if (!cage.ok()) return cage.status();
  return std::make_unique<CageMarkers>(subject, file, *std::move(cage));
}

}  // namespace phrenic::calibrate
