#include "server/mechanics/lungs/lung_root.h"

namespace phrenic {
namespace {

constexpr double kLeastTowardsMidline = 0.5;  // part of the normal

}  // namespace

bool LungRoot::Holds(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  if (outwards == 0 || -outwards * normal.x() < kLeastTowardsMidline) return false;
  const Eigen::Vector3d at = (2 * point - box.min() - box.max()).cwiseQuotient(box.sizes());
  const double back = (at.y() - kHilumDepth) / kHilumHalfDepth;
  const double up = ((at.z() + 1) / 2 - kHilumHeight) / kHilumHalfHeight;
  return back * back + up * up <= 1;
}

}  // namespace phrenic
