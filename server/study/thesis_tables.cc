#include "server/study/thesis_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "absl/strings/str_format.h"

namespace phrenic::study {
namespace {

enum class Kind { kCube, kPerfect, kPatient };

struct Size {
  Kind kind;
  ThesisSize size;
};

constexpr double kCubes = 1e5, kThoraces = 100;  // iterations of a trial

// Figures 5.10 (100,000 iterations; section 5.3.1: 27 %), 5.24 (all forces) and 5.27 (links and percentages).
constexpr Size kSizes[] = {
    {Kind::kCube, {"cube", 8, 0, kCubes / 4.2654, kCubes / 3.345, 27, "fig. 5.10"}},
    {Kind::kPerfect, {"perfect model, low", 12047, 602, 12.79, 13.07, 2.21, "fig. 5.24"}},
    {Kind::kPerfect, {"perfect model, medium", 16023, 1022, 10.41, 10.69, 2.71, "fig. 5.24"}},
    {Kind::kPerfect, {"perfect model, high", 20909, 1663, 8.13, 8.56, 5.24, "fig. 5.24"}},
    {Kind::kPatient, {"patient model, low", 5185, 940, 19.39, 19.69, 3.85, "fig. 5.24"}},
    {Kind::kPatient, {"patient model, medium", 10162, 648, 12.05, 12.60, 2.71, "fig. 5.24"}},
    {Kind::kPatient, {"patient model, high", 20740, 4858, 6.37, 6.84, 3.65, "fig. 5.24"}},
};

struct TrialRow {
  Kind kind;
  ThesisTrial trial;
  int vertices;
  double rate;
  const char* what;
};

// Trials with a part left out, all with rigid links.
constexpr TrialRow kTrials[] = {
    {Kind::kPerfect, ThesisTrial::kNoAttachments, 20859, kThoraces / 12.2994, "fig. 5.12, no rib/sternum attachment"},
    {Kind::kPerfect, ThesisTrial::kNoRibs, 11359, kThoraces / 12.1572, "fig. 5.12, no rib kinematics"},
    {Kind::kPerfect, ThesisTrial::kNoRibs, 20909, 9.68, "fig. 5.24, diaphragm only, high"},
    {Kind::kPerfect, ThesisTrial::kNoRibs, 16023, 11.76, "fig. 5.24, diaphragm only, medium"},
    {Kind::kPerfect, ThesisTrial::kNoRibs, 12047, 14.70, "fig. 5.24, diaphragm only, low"},
    {Kind::kPerfect, ThesisTrial::kNoMuscles, 20909, 8.24, "fig. 5.24, rib kinematics only, high"},
    {Kind::kPerfect, ThesisTrial::kNoMuscles, 16023, 10.93, "fig. 5.24, rib kinematics only, medium"},
    {Kind::kPerfect, ThesisTrial::kNoMuscles, 12047, 13.27, "fig. 5.24, rib kinematics only, low"},
};

bool IsOfAPatient(const v1::Scene& scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(),
                     [](const v1::Body& body) { return body.role() == v1::ROLE_DEFORMABLE && body.has_file(); });
}

bool HasDiaphragm(const v1::Scene& scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(), [](const v1::Body& body) {
    return body.role() == v1::ROLE_DEFORMABLE && body.anatomy().structure() == v1::STRUCTURE_DIAPHRAGM;
  });
}

// |log(a/b)| of two numbers of vertices.
double LogRatio(int64_t a, int64_t b) {
  return std::abs(std::log((1.0 + static_cast<double>(a)) / (1.0 + static_cast<double>(b))));
}

// True if the value is one of two, `low` and `high`.
bool IsEither(double value, double low, double high) { return value == low || value == high; }

// True if the body's vertices are the eight corners of a box.
bool IsBox(const v1::Polyhedron& shape) {
  if (shape.vertices_size() != 8) return false;
  std::set<std::array<double, 3>> corners;
  std::array<double, 3> low, high;
  low.fill(HUGE_VAL), high.fill(-HUGE_VAL);
  for (const v1::Vector& vertex : shape.vertices()) {
    const std::array<double, 3> at = {vertex.x(), vertex.y(), vertex.z()};
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
    corners.insert(at);
  }
  return corners.size() == 8 && std::all_of(corners.begin(), corners.end(), [&](const auto& at) {
           return IsEither(at[0], low[0], high[0]) && IsEither(at[1], low[1], high[1]) &&
                  IsEither(at[2], low[2], high[2]);
         });
}

bool IsCube(const v1::Scene& scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(), [](const v1::Body& body) {
    return body.role() == v1::ROLE_DEFORMABLE && IsBox(body.polyhedron());
  });
}

std::optional<Kind> LikeModel(const v1::Scene& scene, int64_t vertices) {
  if (vertices == 8 && IsCube(scene)) return Kind::kCube;
  if (!HasDiaphragm(scene)) return std::nullopt;
  return IsOfAPatient(scene) ? Kind::kPatient : Kind::kPerfect;
}

ThesisFigure FigureOf(const ThesisSize& size, bool links) {
  return {absl::StrFormat("%s, %s, %d vertices, %s", size.figure, size.what, size.vertices,
                          links ? "with rigid links" : "springs alone"),
          links ? size.with_links : size.without_links};
}

}  // namespace

std::optional<ThesisFigure> LikeThesisFigure(const v1::Scene& scene, int64_t vertices, ThesisTrial trial) {
  const std::optional<Kind> like = LikeModel(scene, vertices);
  if (!like.has_value()) return std::nullopt;
  std::optional<ThesisFigure> figure;
  double nearest = std::log(2.0);
  const auto take = [&](int of, const ThesisFigure& found) {
    if (LogRatio(vertices, of) > nearest) return;
    nearest = LogRatio(vertices, of);
    figure = found;
  };
  const bool whole = trial == ThesisTrial::kFull || trial == ThesisTrial::kNoLinks;
  for (const Size& row : kSizes) {
    if (whole && row.kind == *like) take(row.size.vertices, FigureOf(row.size, trial == ThesisTrial::kFull));
  }
  for (const TrialRow& row : kTrials) {
    if (row.trial != trial || row.kind != *like) continue;
    take(row.vertices, {absl::StrFormat("%s, %d vertices", row.what, row.vertices), row.rate});
  }
  return figure;
}

std::vector<ThesisSize> LikeThesisSizes(const v1::Scene& scene, int64_t vertices) {
  std::vector<ThesisSize> sizes;
  const std::optional<Kind> like = LikeModel(scene, vertices);
  for (const Size& row : kSizes) {
    if (like == row.kind) sizes.push_back(row.size);
  }
  return sizes;
}

}  // namespace phrenic::study
