#include "server/anatomy/airways.h"

#include <algorithm>
#include <vector>

#include "server/anatomy/meshing/implicit_surface.h"

namespace phrenic::anatomy {
namespace {

struct Branch {
  Eigen::Vector3d from, to;
  double from_radius, to_radius;  // [mm]
};

const Branch kBranches[] = {{{-1.5, 11, 378}, {-2, 14, 360}, 8.5, 8.5}, {{-2, 14, 360}, {-3, 20, 330}, 8.5, 8.5},
                            {{-3, 20, 330}, {-3, 23, 306}, 8.5, 9},     {{-3, 23, 304}, {-22, 23, 284}, 8, 7.2},
                            {{-22, 23, 284}, {-42, 28, 268}, 7.2, 6.2}, {{-3, 23, 304}, {17, 15, 289}, 7.2, 6.5},
                            {{17, 15, 289}, {44, 19, 276}, 6.5, 5.8}};

}  // namespace

Mesh Trachea(double edge_length) {
  constexpr double kMaxEdge = 6, kDetail = 4, kBlend = 3;
  const Field field = [](const Eigen::Vector3d& x) {
    double distance = 1e3;
    for (const Branch& branch : kBranches) {
      const double other = Capsule(x, branch.from, branch.to, branch.from_radius, branch.to_radius);
      distance = SmoothMin(distance, other, kBlend);
    }
    return distance;
  };
  return ImplicitSurface(field, {{-54, -5, 258}, {56, 40, 408}}, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
