#include "server/imaging/cage_frame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "absl/strings/str_format.h"

namespace phrenic::imaging {
namespace {

constexpr int kT12 = 12, kL1 = 13;

struct Bounds {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
};

Bounds BoundsOf(const LabelVolume& volume, const Mask& mask) {
  Bounds bounds;
  double count = 0;
  for (std::size_t at = 0; at < mask.inside.size(); ++at) {
    if (mask.inside[at] != 1) continue;
    const Eigen::Vector3d position = mask.Position(volume, at);
    bounds.box.extend(position);
    bounds.mean += position;
    ++count;
  }
  bounds.mean /= count;
  return bounds;
}

struct Landmarks {
  std::map<int, Bounds> vertebrae;
  Eigen::AlignedBox3d lower_ribs, sternum, lungs;
  Eigen::AlignedBox3d right, left;  // lungs and lower ribs of a side
};

Landmarks Find(const LabelVolume& volume, const std::vector<Part>& parts) {
  Landmarks marks;
  for (const Part& part : parts) {
    const int number = part.anatomy.number();
    if (part.Is(v1::STRUCTURE_VERTEBRA)) marks.vertebrae[number] = BoundsOf(volume, part.mask);
    const bool rib = part.Is(v1::STRUCTURE_RIB) && number >= 6, lung = part.Is(v1::STRUCTURE_LUNG);
    if (rib || lung) {
      const Eigen::AlignedBox3d box = BoundsOf(volume, part.mask).box;
      (rib ? marks.lower_ribs : marks.lungs).extend(box);
      if (part.anatomy.side() == v1::SIDE_RIGHT) marks.right.extend(box);
      if (part.anatomy.side() == v1::SIDE_LEFT) marks.left.extend(box);
    }
    if (part.Is(v1::STRUCTURE_STERNUM_BODY) || part.Is(v1::STRUCTURE_XIPHOID) || part.Is(v1::STRUCTURE_MANUBRIUM)) {
      marks.sternum.extend(BoundsOf(volume, part.mask).box);
    }
  }
  return marks;
}

// Sets the heights of L1 to L3. A missing one is extrapolated at the spacing of its neighbours.
void SetLumbarHeights(const Landmarks& marks, CageFrame& frame, Fallbacks& fallbacks) {
  const auto& [last, last_bounds] = *marks.vertebrae.rbegin();
  const auto& [first, first_bounds] = *marks.vertebrae.begin();
  constexpr double kUsual = 33;  // typical distance between the centres of lumbar vertebrae [mm]
  frame.vertebra_height = kUsual * frame.width / 262;
  const auto above = marks.vertebrae.find(last - 1);
  if (above != marks.vertebrae.end()) frame.vertebra_height = above->second.mean.z() - last_bounds.mean.z();
  for (int l = 0; l < 3; ++l) {
    const auto found = marks.vertebrae.find(kL1 + l);
    const bool below = kL1 + l > last;
    const double from = below ? last_bounds.mean.z() - (kL1 + l - last) * frame.vertebra_height
                              : first_bounds.mean.z() + (first - kL1 - l) * frame.vertebra_height;
    frame.lumbar[l] = found != marks.vertebrae.end() ? found->second.mean.z() : from;
    if (found == marks.vertebrae.end()) {
      fallbacks.push_back({absl::StrFormat("no L%d: assumed %.0f mm from the next vertebra to place the crura", l + 1,
                                           frame.vertebra_height),
                           v1::ASSUMPTION_KIND_LUMBAR,
                           {},
                           {l + 1.0, frame.vertebra_height}});
    }
  }
}

// Returns y of the anterior face of T12, or of the vertebra nearest to it in number.
double SpineFront(const Landmarks& marks) {
  const auto nearest = std::min_element(
      marks.vertebrae.begin(), marks.vertebrae.end(),
      [](const auto& a, const auto& b) { return std::abs(a.first - kT12) < std::abs(b.first - kT12); });
  return nearest->second.box.min().y();
}

// Sets where the cage ends above. Requires: the centre is known.
void SetTop(const Landmarks& marks, CageFrame& frame) {
  const auto& [number, first] = *marks.vertebrae.begin();
  frame.top = number == 1 || marks.lungs.isEmpty() ? first.box.max().z() : marks.lungs.max().z();
  const double front = marks.sternum.isEmpty() ? frame.centre.y() : marks.sternum.max().y();
  frame.top_centre = (front + first.box.min().y()) / 2;
}

// FAILED_PRECONDITION if an axis is reversed: the left side must lie at larger x than the right one, and the spine
// behind the middle of the cage. Up and down are a matter of the proportions.
absl::Status CheckAxes(const Landmarks& marks, const Eigen::AlignedBox3d& cage) {
  constexpr char kRemedy[] = "check the volume's affine (NIfTI is RAS, Phrenic and DICOM are LPS) and the label map";
  double spine = 0;
  for (const auto& [number, bounds] : marks.vertebrae) {
    spine += bounds.mean.y() / static_cast<double>(marks.vertebrae.size());
  }
  if (spine < cage.center().y() - 0.1 * cage.sizes().y()) {
    return absl::FailedPreconditionError(
        absl::StrFormat("the spine lies %.0f mm in front of the middle of the cage: front and back are exchanged; %s",
                        cage.center().y() - spine, kRemedy));
  }
  if (marks.left.isEmpty() || marks.right.isEmpty()) return absl::OkStatus();
  const double apart = marks.left.center().x() - marks.right.center().x();
  if (apart > 0) return absl::OkStatus();
  return absl::FailedPreconditionError(
      absl::StrFormat("the parts named left lie %.0f mm to the right of those named right: the sides are exchanged; %s",
                      -apart, kRemedy));
}

// FAILED_PRECONDITION if the landmarks are not those of a person, lying or standing, in a volume of LPS millimetres.
absl::Status CheckProportions(const CageFrame& frame, const Eigen::AlignedBox3d& cage) {
  constexpr double kNarrowest = 60, kWidest = 800, kTallest = 900;  // cage [mm]
  constexpr double kLowest = 5, kHighest = 100;                     // vertebra [mm]
  const double depth = frame.spine_front - cage.min().y();
  const bool human = frame.width >= kNarrowest && frame.width <= kWidest && frame.vertebra_height >= kLowest &&
                     frame.vertebra_height <= kHighest && depth > 0 && depth < kWidest && frame.centre.allFinite() &&
                     frame.lumbar[0] > frame.lumbar[1] && frame.lumbar[1] > frame.lumbar[2] &&
                     frame.top > frame.lumbar[2] && frame.top - frame.lumbar[2] < kTallest &&
                     std::abs(frame.sternum_end - frame.lumbar[0]) < kWidest;
  if (human) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrFormat(
      "these are not the proportions of a thorax: the cage is %.0f mm wide, its front is %.0f mm before the spine, its "
      "top %.0f mm above L3, vertebrae are %.0f mm apart from the top; check the label map, the volume's spacing and "
      "which way is up",
      frame.width, depth, frame.top - frame.lumbar[2], frame.vertebra_height));
}

}  // namespace

Ray CageFrame::RayOf(const Eigen::Vector2d& p) const {
  const double s = p.norm();
  const Eigen::Vector2d azimuth = s > 1e-9 ? Eigen::Vector2d(p / s) : Eigen::Vector2d(0, -1);
  if (s > 1) {
    return {centre - Eigen::Vector3d(0, 0, (s - 1) * wall_length), {azimuth.x(), azimuth.y(), 0}};
  }
  const double angle = s * std::numbers::pi / 2, across = std::sin(angle);
  return {centre, {across * azimuth.x(), across * azimuth.y(), std::cos(angle)}};
}

Eigen::Vector2d CageFrame::PlaneOf(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d from = point - centre;
  const double across = from.head<2>().norm();
  if (across < 1e-9) return {0, 0};
  const double s = from.z() < 0 ? 1 - from.z() / wall_length : std::atan2(across, from.z()) / (std::numbers::pi / 2);
  return s / across * from.head<2>();
}

Eigen::Vector2d CageFrame::Axis(double z) const {
  const double up = top > sternum_end ? std::clamp((z - sternum_end) / (top - sternum_end), 0.0, 1.0) : 0;
  return {centre.x(), centre.y() + up * (top_centre - centre.y())};
}

absl::StatusOr<CageFrame> FindCageFrame(const LabelVolume& volume, const std::vector<Part>& parts,
                                        Fallbacks& fallbacks) {
  const Landmarks marks = Find(volume, parts);
  if (marks.vertebrae.empty() || (marks.lower_ribs.isEmpty() && marks.lungs.isEmpty())) {
    return absl::FailedPreconditionError(
        "cannot derive a diaphragm: labels of vertebrae, and of ribs 6-12 or lungs, are needed to locate it");
  }
  CageFrame frame;
  const Eigen::AlignedBox3d& cage = marks.lower_ribs.isEmpty() ? marks.lungs : marks.lower_ribs;
  if (marks.lower_ribs.isEmpty()) {
    fallbacks.push_back(
        {"no ribs 6-12: the width of the lungs is used as the width of the cage", v1::ASSUMPTION_KIND_CAGE_WIDTH});
  }
  frame.width = cage.sizes().x();
  double middle = 0;
  for (const auto& [number, bounds] : marks.vertebrae) {
    middle += bounds.mean.x() / static_cast<double>(marks.vertebrae.size());
  }
  SetLumbarHeights(marks, frame, fallbacks);
  frame.sternum_end = marks.sternum.isEmpty() ? frame.lumbar[0] + 3.3 * frame.vertebra_height : marks.sternum.min().z();
  if (marks.sternum.isEmpty()) {
    fallbacks.push_back(
        {"no sternum: the front of the rim is estimated from the spine", v1::ASSUMPTION_KIND_NO_STERNUM});
  }
  frame.spine_front = SpineFront(marks);
  const double front = marks.sternum.isEmpty() ? cage.min().y() : marks.sternum.min().y() + 8;
  // Anterior, so that rays reach the gutters beside the spine; low, so that they reach both domes.
  frame.centre = {middle, front + 0.3 * (frame.spine_front - front), frame.sternum_end - 0.3 * frame.width};
  frame.wall_length = 0.65 * frame.width;
  SetTop(marks, frame);
  if (absl::Status status = CheckProportions(frame, cage); !status.ok()) return status;
  if (absl::Status status = CheckAxes(marks, cage); !status.ok()) return status;
  return frame;
}

}  // namespace phrenic::imaging
