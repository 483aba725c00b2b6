#include "client/thesis_figures.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"

namespace phrenic::client {
namespace {

enum class Kind { kCube, kPerfect, kPatient };

struct Row {
  const char* figure;
  Kind kind;
  int vertices;
  double with_links, without_links;  // iterations a second
};

// Figures 5.10 (100,000 iterations) and 5.24 (all forces).
constexpr Row kRows[] = {
    {"fig. 5.10, cube", Kind::kCube, 8, 1e5 / 4.2654, 1e5 / 3.345},
    {"fig. 5.24, perfect model, low", Kind::kPerfect, 12047, 12.79, 13.07},
    {"fig. 5.24, perfect model, medium", Kind::kPerfect, 16023, 10.41, 10.69},
    {"fig. 5.24, perfect model, high", Kind::kPerfect, 20909, 8.13, 8.56},
    {"fig. 5.24, patient model, low", Kind::kPatient, 5185, 19.39, 19.69},
    {"fig. 5.24, patient model, medium", Kind::kPatient, 10162, 12.05, 12.60},
    {"fig. 5.24, patient model, high", Kind::kPatient, 20740, 6.37, 6.84},
};

bool IsOfAPatient(const v1::Scene& scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(),
                     [](const v1::Body& body) { return body.role() == v1::ROLE_DEFORMABLE && body.has_file(); });
}

}  // namespace

ThesisFigure NearestThesisFigure(const v1::Scene& scene, const v1::CompileReport& report) {
  const auto distance = [&report](const Row& row) {
    return std::abs(std::log((1.0 + static_cast<double>(report.simulated_vertices())) / (1.0 + row.vertices)));
  };
  const bool patient = IsOfAPatient(scene);
  const Row* nearest = nullptr;
  for (const Row& row : kRows) {
    if ((row.kind == Kind::kPatient) != patient) continue;
    if (nearest == nullptr || distance(row) < distance(*nearest)) nearest = &row;
  }
  const bool links = report.rigid_links() > 0;
  return {absl::StrFormat("%s, %d vertices, %s", nearest->figure, nearest->vertices,
                          links ? "with rigid links" : "springs alone"),
          links ? nearest->with_links : nearest->without_links};
}

}  // namespace phrenic::client
