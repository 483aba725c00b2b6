#include "server/anatomy/diaphragm_sheet.h"

#include <algorithm>
#include <vector>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"

namespace phrenic::anatomy {
namespace {

// A ball in which edges are at most `edge_length` long; outside, the limit grows by a third of the distance to it.
struct FineBall {
  Eigen::Vector3d centre;
  double radius, edge_length;
};

FineBall AroundOpening(const PlaneLoop& loop) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& p : loop) centre += DiaphragmPoint(p) / static_cast<double>(loop.size());
  double radius = 0;
  for (const Eigen::Vector2d& p : loop) radius = std::max(radius, (DiaphragmPoint(p) - centre).norm());
  return {centre, radius, radius / 2};
}

SheetDomain Domain(double edge_length) {
  SheetDomain domain;
  domain.map = DiaphragmPoint;
  domain.loops = {DiaphragmRim(), CavalOpening(), OesophagealOpening()};
  std::vector<FineBall> fine = {AroundOpening(domain.loops[1]), AroundOpening(domain.loops[2])};
  for (const double z : {30.0, 60.0, 90.0, 115.0}) {  // the crura
    fine.push_back({{0, SpineFront(z), z}, 28, 5});
  }
  domain.edge_length = [edge_length, fine](const Eigen::Vector3d& x) {
    double length = edge_length;
    for (const FineBall& ball : fine) {
      const double outside = std::max(0.0, (x - ball.centre).norm() - ball.radius);
      length = std::min(length, ball.edge_length + outside / 3);
    }
    return length;
  };
  return domain;
}

}  // namespace

Sheet DiaphragmSheet(double edge_length) { return MeshSheet(Domain(edge_length)); }

}  // namespace phrenic::anatomy
