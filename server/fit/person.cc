#include "server/fit/person.h"

namespace phrenic::fit {

absl::StatusOr<RegisteredLungs> RegisterLungs(const LungTemplates& templates, const Points& exhale) {
  const absl::StatusOr<LungSides> sides = FindSides(exhale);
  if (!sides.ok()) return sides.status();
  RegisteredLungs registered;
  registered.gap = sides->gap;
  registered.doubts = sides->doubts;
  for (const Side side : {kRight, kLeft}) {
    const std::vector<int> indices = PointsOf(*sides, side);
    const absl::StatusOr<Registration> lung = Register(templates[side], exhale(Eigen::all, indices));
    if (!lung.ok()) return lung.status();
    registered.lungs[side] = *lung;
    registered.points[side] = static_cast<int>(indices.size());
  }
  return registered;
}

absl::StatusOr<Person> Person::Make(const LungTemplates& templates, const RegisteredLungs& registered,
                                    const std::vector<Amplitude>& amplitudes, const LungElasticity& elasticity,
                                    const std::function<bool()>& stop) {
  std::vector<LungTissue> tissues;
  for (const Side side : {kRight, kLeft}) {
    auto tissue = LungTissue::Make(registered.lungs[side].Apply(templates[side].surface()), elasticity);
    if (!tissue.ok()) return tissue.status();
    tissues.push_back(*std::move(tissue));
  }
  Person person(registered, amplitudes, std::move(tissues));
  for (const Side side : {kRight, kLeft}) {
    for (size_t a = 0; a < amplitudes.size(); ++a) {
      if (stop && stop()) return absl::CancelledError("interrupted");
      Points& field = person.fields_[side].emplace_back(3, 0);
      if (!person.Moves(a, side)) continue;
      const BoundaryMode& mode = BoundaryModes()[static_cast<size_t>(amplitudes[a].mode)];
      field = ResponseTo(mode, person.tissues_[side], side == kLeft ? 1 : -1);
    }
  }
  return person;
}

Points Person::PlacesAt(const Points& points) const {
  Points places(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Side side = SideOf(points.col(i));
    const Eigen::AlignedBox3d& box = tissues_[side].box();
    const Eigen::Vector3d at = (2 * points.col(i) - box.min() - box.max()).cwiseQuotient(box.sizes());
    places.col(i) << (side == kLeft ? at.x() : -at.x()), at.y(), (at.z() + 1) / 2;
  }
  return places;
}

std::vector<bool> Person::LeftOnes(const Points& points) const {
  std::vector<bool> left;
  for (const auto& point : points.colwise()) left.push_back(SideOf(point) == kLeft);
  return left;
}

Eigen::MatrixXd Person::Responses(const Points& points) const {
  Eigen::MatrixXd responses = Eigen::MatrixXd::Zero(3 * points.cols(), static_cast<Eigen::Index>(amplitudes_.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Side side = SideOf(points.col(i));
    const BrickGrid& grid = tissues_[side].grid();
    const auto [brick, local] = grid.Locate(points.col(i));
    const BrickWeights weights = WeightsAt(local);
    for (size_t a = 0; a < amplitudes_.size(); ++a) {
      if (!Moves(a, side)) continue;
      responses.block<3, 1>(3 * i, static_cast<Eigen::Index>(a)) =
          fields_[side][a](Eigen::all, grid.bricks()[static_cast<size_t>(brick)]) * weights;
    }
  }
  return responses;
}

Eigen::VectorXd Person::VolumeResponses() const {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(amplitudes_.size()));
  for (const Side side : {kRight, kLeft}) {
    const LungTissue& tissue = tissues_[side];
    for (size_t a = 0; a < amplitudes_.size(); ++a) {
      if (!Moves(a, side)) continue;
      for (Eigen::Index i = 0; i < tissue.points().cols(); ++i) {
        volumes[static_cast<Eigen::Index>(a)] += tissue.areas()[i] * tissue.normals().col(i).dot(tissue.DisplacementAt(
                                                                         fields_[side][a], tissue.points().col(i)));
      }
    }
  }
  return volumes;
}

Points Person::NodesAt(Side side, const Eigen::VectorXd& amplitudes) const {
  Points nodes = Points::Zero(3, tissues_[side].grid().nodes().cols());
  for (size_t a = 0; a < amplitudes_.size(); ++a) {
    if (Moves(a, side)) nodes += amplitudes[static_cast<Eigen::Index>(a)] * fields_[side][a];
  }
  return nodes;
}

}  // namespace phrenic::fit
