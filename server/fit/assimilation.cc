#include "server/fit/assimilation.h"

namespace phrenic::fit {
namespace {

constexpr double kSoftContact = 5;  // [1/m]
constexpr double kWeight = 0.1;     // [m]

std::vector<int> IndicesOf(const Points& points, double gap, Side side) {
  std::vector<int> indices;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if ((points(0, i) > gap) == (side == kLeft)) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

}  // namespace

absl::StatusOr<Points> Assimilate(const LungTemplates& templates, const RegisteredLungs& registered,
                                  const Points& known, const Points& residual, const Points& at) {
  Points deformation = Points::Zero(3, at.cols());
  LungElasticity soft;
  soft.contact = kSoftContact;
  for (const Side side : {kRight, kLeft}) {
    const auto tissue = LungTissue::Make(registered.lungs[side].Apply(templates[side].surface()), soft);
    if (!tissue.ok()) return tissue.status();
    const std::vector<int> own = IndicesOf(known, registered.gap, side);
    const auto nodes = tissue->SolveThrough(known(Eigen::all, own), residual(Eigen::all, own), kWeight);
    if (!nodes.ok()) return nodes.status();
    for (const int i : IndicesOf(at, registered.gap, side)) {
      deformation.col(i) = tissue->DisplacementAt(*nodes, at.col(i));
    }
  }
  return deformation;
}

}  // namespace phrenic::fit
