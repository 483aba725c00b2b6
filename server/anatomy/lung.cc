#include "server/anatomy/lung.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/implicit_surface.h"

namespace phrenic::anatomy {
namespace {

constexpr double kPleura = 9;     // from the ribs' centrelines to the lung
constexpr double kAboveDome = 7;  // from the sheet's middle to the lung's base
constexpr double kTop = 396;      // of the cupola

double SmoothMax(double a, double b, double k) { return -SmoothMin(-a, -b, k); }

// The chest wall and the cupola of the pleura.
double InsideCage(const Eigen::Vector3d& x) {
  const double z = std::min(x.z(), 380.0);
  const Eigen::Vector2d q = CageSection(z, kPleura).DiscCoordinates(x.head<2>());
  return (q.norm() - 1) * 62;
}

double BelowCupola(const Eigen::Vector3d& x) {
  const Eigen::Vector3d centre(0, 22, kTop - 70);
  const Eigen::Vector3d u = (x - centre).cwiseQuotient(Eigen::Vector3d(72, 66, 70));
  return x.z() < centre.z() ? (std::hypot(u.x(), u.y()) - 1.3) * 60 : (u.norm() - 1) * 66;
}

double AboveDiaphragm(const Eigen::Vector3d& x) {
  const double z = std::clamp(x.z(), 100.0, 230.0);
  const Eigen::Vector2d q = CageSection(z, kDiaphragmInset).DiscCoordinates(x.head<2>());
  const double over = DomeHeight(q) + kAboveDome - x.z();
  const double slope = 1 + 1.2 * std::pow(std::min(1.0, q.norm()), 4);  // the dome steepens towards the wall
  return over / slope;
}

// Heart, great vessels and spine; `side` is +1 on the left.
double OutsideMediastinum(const Eigen::Vector3d& x, double side) {
  const double across = side * x.x();
  const double in_front = std::clamp((20 - x.y()) / 60, 0.0, 1.0);
  const double wall = 19 - 9 * in_front - across;
  const Eigen::Vector3d heart(18, -42, 248);
  const Eigen::Vector3d reach(side > 0 ? 52 : 62, 44, 62);
  const double beside_heart = (1 - (x - heart).cwiseQuotient(reach).norm()) * 46;
  const double spine_front = SpineFront(x.z());
  const double spine = 24 - std::hypot(x.x(), x.y() - spine_front - 16);
  return SmoothMax(SmoothMax(wall, beside_heart, 14), spine, 10);
}

Mesh Lung(double side, double edge_length) {
  const Field field = [side](const Eigen::Vector3d& x) {
    const double chest = SmoothMax(InsideCage(x), BelowCupola(x), 10);
    const double seated = SmoothMax(chest, AboveDiaphragm(x), 9);
    return SmoothMax(seated, OutsideMediastinum(x, side), 10);
  };
  const Box box{{side > 0 ? 0.0 : -135.0, -105, 95}, {side > 0 ? 135.0 : 0.0, 110, 405}};
  return ImplicitSurface(field, box, edge_length);
}

}  // namespace

Mesh LeftLung(double edge_length) { return Lung(1, edge_length); }

Mesh RightLung(double edge_length) { return Lung(-1, edge_length); }

}  // namespace phrenic::anatomy
