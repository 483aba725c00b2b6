#include "client/thesis_figures.h"

#include <cmath>

#include "absl/strings/str_format.h"

namespace phrenic::client {
namespace {

struct Row {
  const char* figure;
  int vertices;
  double with_links, without_links;  // iterations a second
};

// Figures 5.10 (100,000 iterations) and 5.24 (all forces).
constexpr Row kRows[] = {
    {"fig. 5.10, cube", 8, 1e5 / 4.2654, 1e5 / 3.345},      {"fig. 5.24, patient model, low", 5185, 19.39, 19.69},
    {"fig. 5.24, perfect model, low", 12047, 12.79, 13.07}, {"fig. 5.24, perfect model, medium", 16023, 10.41, 10.69},
    {"fig. 5.24, perfect model, high", 20909, 8.13, 8.56},
};

}  // namespace

ThesisFigure NearestThesisFigure(const v1::CompileReport& report) {
  const auto distance = [&report](const Row& row) {
    return std::abs(std::log((1.0 + static_cast<double>(report.simulated_vertices())) / (1.0 + row.vertices)));
  };
  const Row* nearest = &kRows[0];
  for (const Row& row : kRows) {
    if (distance(row) < distance(*nearest)) nearest = &row;
  }
  const bool links = report.rigid_links() > 0;
  return {absl::StrFormat("%s, %d vertices, %s", nearest->figure, nearest->vertices,
                          links ? "with rigid links" : "springs alone"),
          links ? nearest->with_links : nearest->without_links};
}

}  // namespace phrenic::client
