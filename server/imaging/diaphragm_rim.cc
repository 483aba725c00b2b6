#include "server/imaging/diaphragm_rim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "absl/strings/str_format.h"

namespace phrenic::imaging {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kKnotSpacing = 10;     // between knots on the costal margin [degrees]
constexpr double kHalfSternum = 8;   // [degrees]
constexpr double kLastCostal = 140;  // from the front [degrees]; the arcuate ligaments begin behind it
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr int kDirections = 360 / kKnotSpacing;

struct Knot {
  double degrees, z;  // azimuth from the front, positive to the left; height [mm]
};

// True for what the margin of the sheet follows: the diaphragm's own label, else ribs 7 to 12 and cartilages.
bool IsMargin(const Part& part, bool labelled) {
  if (labelled) return part.Is(v1::STRUCTURE_DIAPHRAGM);
  const bool rib = part.Is(v1::STRUCTURE_RIB) && part.anatomy.number() >= 7;
  return rib || part.Is(v1::STRUCTURE_COSTAL_CARTILAGE);
}

// Returns the height of the lowest point of the margin in each direction; infinity where none was found. Bones are
// apart, so all within a direction count; of the labelled diaphragm, whose margin is steep, those within 1.5 degrees.
std::vector<double> CostalMargin(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame) {
  constexpr double kNarrow = 1.5;  // [degrees]
  const bool labelled = std::ranges::any_of(parts, [](const Part& part) { return part.Is(v1::STRUCTURE_DIAPHRAGM); });
  std::vector<double> lowest(kDirections, kUnknown);
  for (const Part& part : parts) {
    if (!IsMargin(part, labelled)) continue;
    for (std::size_t at = 0; at < part.mask.inside.size(); ++at) {
      if (part.mask.inside[at] != 1) continue;
      const Eigen::Vector3d position = part.mask.Position(volume, at), from = position - frame.centre;
      const double degrees = std::atan2(from.x(), -from.y()) / kDegree;
      const auto nearest = std::lround(degrees / kKnotSpacing);
      if (labelled && std::abs(degrees - static_cast<double>(kKnotSpacing * nearest)) > kNarrow) continue;
      const auto direction = (nearest + kDirections) % kDirections;
      lowest[direction] = std::min(lowest[direction], position.z());
    }
  }
  return lowest;
}

// Returns the costal margin of one side from front to back. Skips directions without bone; the spline bridges them.
std::vector<Knot> CostalKnots(const std::vector<double>& lowest, const CageFrame& frame, double side, int* bridged) {
  const double highest = frame.sternum_end;  // beside the xiphoid the margin is higher, but in front of the sheet
  std::vector<Knot> known = {{0, frame.sternum_end}};
  for (int degrees = kKnotSpacing; degrees <= kLastCostal; degrees += kKnotSpacing) {
    const auto direction = (static_cast<int>(side) * degrees / kKnotSpacing + kDirections) % kDirections;
    if (lowest[direction] < kUnknown) {
      known.push_back({static_cast<double>(degrees), std::min(highest, lowest[direction])});
    } else {
      ++*bridged;
    }
  }
  for (Knot& knot : known) knot.degrees *= side;
  known.front().degrees = side * kHalfSternum / 2;
  return known;
}

// Where the rim turns from the costal margin into a crus.
struct CrusEnds {
  double lateral, tip;  // heights of its lateral edge and of its tip [mm]
};

constexpr double kLateral = 28;  // of the lateral edge, from the back [degrees]

// Returns those of the labelled diaphragm if it reaches below L1 there, else the usual ones.
CrusEnds FindCrusEnds(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                      v1::Side side) {
  constexpr double kBeside = 1.5;  // [degrees]
  const double l1 = frame.lumbar[0], h = frame.vertebra_height, sign = side == v1::SIDE_LEFT ? 1 : -1;
  CrusEnds lowest{kUnknown, l1};
  for (const Part& part : parts) {
    if (!part.Is(v1::STRUCTURE_DIAPHRAGM)) continue;
    for (std::size_t at = 0; at < part.mask.inside.size(); ++at) {
      if (part.mask.inside[at] != 1) continue;
      const Eigen::Vector3d position = part.mask.Position(volume, at), from = position - frame.centre;
      const double degrees = std::atan2(sign * from.x(), from.y()) / kDegree;  // from the back
      if (std::abs(degrees - kLateral) < kBeside) lowest.lateral = std::min(lowest.lateral, position.z());
      if (InCrus(frame, position, side)) lowest.tip = std::min(lowest.tip, position.z());
    }
  }
  if (lowest.lateral == kUnknown) lowest.lateral = l1 + 0.3 * h;
  if (lowest.tip >= l1) lowest.tip = side == v1::SIDE_RIGHT ? frame.lumbar[2] : frame.lumbar[1] - 0.2 * h;
  return lowest;
}

// Returns the crus from its lateral edge around the tip to the median arcuate ligament, in degrees from the back.
std::vector<Knot> CrusKnots(const CageFrame& frame, const CrusEnds& ends) {
  const double l1 = frame.lumbar[0], h = frame.vertebra_height, tip = ends.tip;
  return {{kLateral, ends.lateral},
          {20, l1 + 0.2 * h},
          {15, l1 - 0.4 * h},
          {12, (l1 + tip) / 2 - 0.3 * h},
          {9, tip},
          {6, (l1 + tip) / 2 - 0.3 * h},
          {4, l1},
          {2, l1 + h}};
}

// Returns the knots of the whole rim from the front, counter-clockwise seen from above: left side first.
std::vector<Knot> Knots(const std::vector<double>& lowest, const CrusEnds& left_crus, const CrusEnds& right_crus,
                        const CageFrame& frame, Fallbacks& fallbacks) {
  int bridged = 0;
  std::vector<Knot> knots = CostalKnots(lowest, frame, 1, &bridged);
  for (const Knot& knot : CrusKnots(frame, left_crus)) knots.push_back({180 - knot.degrees, knot.z});
  knots.push_back({180, frame.lumbar[0] + 1.3 * frame.vertebra_height});
  std::vector<Knot> right = CostalKnots(lowest, frame, -1, &bridged);
  for (const Knot& knot : CrusKnots(frame, right_crus)) right.push_back({knot.degrees - 180, knot.z});
  for (auto knot = right.rbegin(); knot != right.rend(); ++knot) knots.push_back({knot->degrees + 360, knot->z});
  if (bridged > 0) {
    fallbacks.push_back(
        {absl::StrFormat("costal margin: no rib or cartilage 7-12 in %d of 28 directions; interpolated", bridged),
         v1::ASSUMPTION_KIND_MARGIN,
         {},
         {static_cast<double>(bridged)}});
  }
  return knots;
}

// Evaluates the uniform cubic B-spline.
Knot Spline(const std::vector<Knot>& knots, std::size_t span, double t) {
  const std::size_t n = knots.size();
  const double u = 1 - t;
  const double weights[4] = {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                             t * t * t / 6};
  Knot at{0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const Knot& knot = knots[(span + n + k - 1) % n];
    const double unwrapped = knot.degrees + 360 * std::round((knots[span].degrees - knot.degrees) / 360);
    at.degrees += weights[k] * unwrapped;
    at.z += weights[k] * knot.z;
  }
  return at;
}

}  // namespace

anatomy::PlaneLoop FindRim(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                           const SmoothSheet& sheet, Fallbacks& fallbacks) {
  constexpr int kSamplesASpan = 12;
  const CrusEnds left = FindCrusEnds(volume, parts, frame, v1::SIDE_LEFT);
  const CrusEnds right = FindCrusEnds(volume, parts, frame, v1::SIDE_RIGHT);
  const std::vector<Knot> knots = Knots(CostalMargin(volume, parts, frame), left, right, frame, fallbacks);
  anatomy::PlaneLoop rim;
  for (std::size_t span = 0; span < knots.size(); ++span) {
    for (int i = 0; i < kSamplesASpan; ++i) {
      const Knot at = Spline(knots, span, static_cast<double>(i) / kSamplesASpan);
      const double angle = at.degrees * kDegree;
      rim.push_back(sheet.AtHeight({std::sin(angle), -std::cos(angle)}, at.z));
    }
  }
  return rim;
}

bool InCrus(const CageFrame& frame, const Eigen::Vector3d& point, v1::Side side) {
  const double across = (point.x() - frame.centre.x()) * (side == v1::SIDE_LEFT ? 1 : -1);
  return point.y() > frame.centre.y() && across > 0 && across < 0.115 * frame.width &&
         point.z() < frame.lumbar[0] + 0.5 * frame.vertebra_height;
}

}  // namespace phrenic::imaging
