#include "server/imaging/patient/template_fit.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/anatomy/anatomy.h"
#include "server/imaging/patient/border.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kResolution = 10;         // of the template's parts, of which only extents count [mm]
constexpr double kLungHeight = 0.1;        // weight of a lung's height beside bones
constexpr double kMostCut = 2;             // area of a part on the border that still counts as whole [cm^2]
constexpr int kLastVertebra = 15;          // L3, the last that the template has
constexpr int kFewestRibs = 4;             // of each side, without lungs
constexpr double kLeast = 0.5, kMost = 2;  // scale

// A part's extent along each axis [mm].
struct PartExtent {
  Eigen::Vector3d low, mean, high;
};

PartExtent ExtentOfMask(const LabelVolume& volume, const std::vector<const Part*>& parts) {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const Part* part : parts) {
    for (std::size_t at = 0; at < part->mask.inside.size(); ++at) {
      if (part->mask.inside[at] != 1) continue;
      const Eigen::Vector3d position = part->mask.Position(volume, at);
      box.extend(position);
      sum += position;
      ++count;
    }
  }
  return {box.min(), sum / count, box.max()};
}

// Returns the extent of a closed surface; its mean is that of the volume inside.
PartExtent ExtentOfMesh(const Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
    const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t)), c = mesh.vertices.col(mesh.triangles(2, t));
    const double cone = a.dot(b.cross(c));
    sum += cone * (a + b + c) / 4;
    volume += cone;
  }
  return {mesh.vertices.rowwise().minCoeff() / kMillimetre, sum / volume / kMillimetre,
          mesh.vertices.rowwise().maxCoeff() / kMillimetre};
}

struct Landmark {
  Eigen::Vector3d generated, placed, weight;
};

void AddLandmarks(const PartExtent& generated, const PartExtent& placed, const Eigen::Vector3d& weight, bool ends,
                  std::vector<Landmark>& landmarks) {
  landmarks.push_back({generated.mean, placed.mean, weight});
  if (!ends) return;
  landmarks.push_back({generated.low, placed.low, weight});
  landmarks.push_back({generated.high, placed.high, weight});
}

// The parts of the volume that one part of the template is compared with.
struct Counterpart {
  v1::Anatomy anatomy;
  std::vector<const Part*> parts;
};

// Returns the ribs, vertebrae and lungs that are whole; the lobes of a side are one lung.
std::vector<Counterpart> Counterparts(const LabelVolume& volume, const std::vector<Part>& parts) {
  std::vector<Counterpart> all;
  for (const Part& part : parts) {
    const bool lung = part.Is(v1::STRUCTURE_LUNG), rib = part.Is(v1::STRUCTURE_RIB);
    const bool vertebra = part.Is(v1::STRUCTURE_VERTEBRA) && part.anatomy.number() <= kLastVertebra;
    if (!lung && !rib && !vertebra) continue;
    v1::Anatomy anatomy = part.anatomy;
    if (lung) anatomy.clear_number();
    const auto same = std::find_if(all.begin(), all.end(), [&anatomy](const Counterpart& other) {
      return other.anatomy.SerializeAsString() == anatomy.SerializeAsString();
    });
    if (same != all.end()) {
      same->parts.push_back(&part);
    } else {
      all.push_back({anatomy, {&part}});
    }
  }
  std::erase_if(all, [&volume](const Counterpart& one) {
    return std::any_of(one.parts.begin(), one.parts.end(),
                       [&volume](const Part* part) { return LargestCut(volume, *part).area > kMostCut; });
  });
  return all;
}

int CountOf(const std::vector<Counterpart>& all, v1::Structure structure, v1::Side side) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), [&](const Counterpart& one) {
    return one.anatomy.structure() == structure && one.anatomy.side() == side;
  }));
}

absl::StatusOr<std::vector<Landmark>> FindLandmarks(const LabelVolume& volume, const std::vector<Part>& parts,
                                                    bool soft) {
  const std::vector<Counterpart> all = Counterparts(volume, parts);
  const bool lungs =
      CountOf(all, v1::STRUCTURE_LUNG, v1::SIDE_RIGHT) > 0 && CountOf(all, v1::STRUCTURE_LUNG, v1::SIDE_LEFT) > 0;
  const int ribs =
      std::min(CountOf(all, v1::STRUCTURE_RIB, v1::SIDE_RIGHT), CountOf(all, v1::STRUCTURE_RIB, v1::SIDE_LEFT));
  if (!lungs && ribs < kFewestRibs) {
    return absl::FailedPreconditionError(absl::StrFormat(
        "the template is registered to two whole lungs, or to %d whole ribs of each side, and the volume has neither",
        kFewestRibs));
  }
  const bool bones = std::any_of(all.begin(), all.end(),
                                 [](const Counterpart& one) { return one.anatomy.structure() != v1::STRUCTURE_LUNG; });
  std::vector<Landmark> landmarks;
  for (const Counterpart& one : all) {
    const bool lung = one.anatomy.structure() == v1::STRUCTURE_LUNG;
    if (soft && lungs && !lung) continue;
    const absl::StatusOr<Mesh> generated = anatomy::Generate(one.anatomy, kResolution);
    if (!generated.ok()) continue;
    const Eigen::Vector3d weight(1, 1, lung && bones && !soft ? kLungHeight : 1);
    AddLandmarks(ExtentOfMesh(*generated), ExtentOfMask(volume, one.parts), weight,
                 one.anatomy.structure() != v1::STRUCTURE_VERTEBRA, landmarks);
  }
  return landmarks;
}

// Fits one axis by weighted least squares.
void FitAxis(const std::vector<Landmark>& landmarks, int axis, TemplateFit& fit) {
  double weight = 0, q = 0, p = 0, qq = 0, qp = 0;
  for (const Landmark& mark : landmarks) {
    weight += mark.weight[axis];
    q += mark.weight[axis] * mark.generated[axis];
    p += mark.weight[axis] * mark.placed[axis];
  }
  q /= weight;
  p /= weight;
  for (const Landmark& mark : landmarks) {
    qq += mark.weight[axis] * (mark.generated[axis] - q) * (mark.generated[axis] - q);
    qp += mark.weight[axis] * (mark.generated[axis] - q) * (mark.placed[axis] - p);
  }
  fit.scale[axis] = qp / qq;
  fit.shift[axis] = p - fit.scale[axis] * q;
}

}  // namespace

absl::StatusOr<TemplateFit> FitTemplate(const LabelVolume& volume, const std::vector<Part>& parts, bool soft) {
  const auto landmarks = FindLandmarks(volume, parts, soft);
  if (!landmarks.ok()) return landmarks.status();
  TemplateFit fit;
  for (int axis = 0; axis < 3; ++axis) FitAxis(*landmarks, axis, fit);
  for (const Landmark& mark : *landmarks) {
    const Eigen::Vector3d off = fit.ToPerson(mark.generated) - mark.placed;
    fit.residual += off.cwiseProduct(mark.weight).squaredNorm() / static_cast<double>(landmarks->size());
  }
  fit.residual = std::sqrt(fit.residual);
  fit.landmarks = static_cast<int>(landmarks->size());
  const bool plausible = (fit.scale.array() >= kLeast && fit.scale.array() <= kMost).all();
  if (plausible) return fit;
  return absl::FailedPreconditionError(absl::StrFormat(
      "the template would be scaled by %.2f, %.2f and %.2f along x, y and z, which no person has: check the label map",
      fit.scale.x(), fit.scale.y(), fit.scale.z()));
}

}  // namespace phrenic::imaging
