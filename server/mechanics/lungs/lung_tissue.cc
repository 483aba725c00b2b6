#include "server/mechanics/lungs/lung_tissue.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/lungs/brick_element.h"
#include "server/mesh/tetrahedra.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

constexpr double kOutsideStiffness = 1e-3;  // stiffness of what is outside the lung, relative to its tissue
constexpr double kRegularisation = 1e-9;    // of the mean of the diagonal

using Entries = std::vector<Eigen::Triplet<double>>;

// Checks a number of LungElasticity. NaN is outside every range.
absl::Status CheckNumber(const char* field, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": ", value, " is outside ", low, " to ", high, unit, "; set a number within"));
}

absl::Status CheckElasticity(const LungElasticity& e) {
  constexpr double kMostRise = 20;  // [1/m]: e^20 a metre
  for (const absl::Status& status :
       {CheckNumber("edge", e.edge, 1e-4, 1, " m"), CheckNumber("poisson", e.poisson, 0, 0.49, ""),
        CheckNumber("contact", e.contact, 1e-3, 1e6, " 1/m"), CheckNumber("tangential", e.tangential, 0, 1e6, " 1/m"),
        CheckNumber("weight.rise", e.weight.rise.norm(), 0, kMostRise, " 1/m"),
        CheckNumber("weight.room", e.weight.room, 0, 100, "")}) {
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Adds the lower triangle of a brick's stiffness.
void AddBrick(const BrickCorners& corners, const BrickMatrix& stiffness, Entries& entries) {
  for (int i = 0; i < 24; ++i) {
    const int row = 3 * corners[i / 3] + i % 3;
    for (int j = 0; j < 24; ++j) {
      const int column = 3 * corners[j / 3] + j % 3;
      if (row >= column) entries.emplace_back(row, column, stiffness(i, j));
    }
  }
}

// Adds N^T k N of a spring k at a point of a brick.
void AddSpring(const Eigen::Vector3d& local, const Eigen::Matrix3d& spring, BrickMatrix& stiffness) {
  const BrickWeights weights = WeightsAt(local);
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) stiffness.block<3, 3>(3 * a, 3 * b) += weights[a] * weights[b] * spring;
  }
}

// Which columns are NaN, and the vectors with 0 in their place.
std::pair<std::vector<bool>, Points> Held(const ConstPoints& displacement) {
  std::pair<std::vector<bool>, Points> held = {{}, displacement};
  held.first.reserve(static_cast<size_t>(displacement.cols()));
  for (auto at : held.second.colwise()) {
    held.first.push_back(at.hasNaN());
    if (held.first.back()) at.setZero();
  }
  return held;
}

}  // namespace

absl::Status CheckLungSurface(const Mesh& surface, double edge) {
  if (absl::Status status = Validate(surface); !status.ok()) return status;
  if (surface.triangles.cols() == 0 || !AnalyseTopology(surface).watertight()) {
    return absl::InvalidArgumentError(
        "surface: the surface of a lung must be closed; see its holes with phrenic inspect, and fill them with phrenic "
        "convert --repair holes");
  }
  if (SignedVolume(surface.vertices, surface.triangles) <= 0) {
    return absl::InvalidArgumentError(
        "surface: the surface of a lung must face outwards; reverse its triangles with phrenic convert --repair "
        "orient");
  }
  const Eigen::Vector3d size = surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff();
  const double bricks = (size / edge).array().ceil().prod();
  if (bricks <= LungTissue::kMostBricks) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("edge: a lung has up to ", LungTissue::kMostBricks, " bricks, not ",
                                                 bricks, "; make their edge longer, or check the surface's unit"));
}

LungTissue::LungTissue(const Mesh& surface, const LungElasticity& elasticity)
    : elasticity_(elasticity), surface_(surface), grid_(surface, elasticity.edge) {
  const Eigen::Index count = surface.triangles.cols();
  points_.resize(3, count);
  normals_.resize(3, count);
  areas_.resize(count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const Eigen::Matrix3d x = surface.vertices(Eigen::all, surface.triangles.col(t));
    const Eigen::Vector3d area = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)) / 2;
    points_.col(t) = x.rowwise().mean();
    areas_[t] = area.norm();
    normals_.col(t) = area.stableNormalized();
    places_.push_back(grid_.Locate(points_.col(t)));
    rooted_.push_back(elasticity.root.Holds(points_.col(t), normals_.col(t)));
  }
  for (const auto& vertex : surface.vertices.colwise()) box_.extend(vertex);
}

absl::StatusOr<LungTissue> LungTissue::Make(const Mesh& surface, const LungElasticity& elasticity,
                                            const StopCheck& stop) {
  if (absl::Status status = CheckElasticity(elasticity); !status.ok()) return status;
  if (absl::Status status = CheckLungSurface(surface, elasticity.edge); !status.ok()) return status;
  LungTissue tissue(surface, elasticity);
  if (stop.Stopped()) return stop.status();
  std::optional<LayeredCholesky> factors = tissue.Factorise(std::vector<bool>(tissue.places_.size(), false), stop);
  if (stop.Stopped()) return stop.status();
  if (!factors) {
    return absl::InvalidArgumentError(
        "surface: the stiffness of a lung with it cannot be factorised; look for slivers with phrenic inspect");
  }
  tissue.factors_ = std::make_shared<const LayeredCholesky>(*std::move(factors));
  return tissue;
}

bool LungTissue::Contains(const Eigen::Vector3d& point) const {
  return box_.contains(point) && WindingNumber(surface_, point) > 0.5;
}

Eigen::Matrix3d LungTissue::SpringOf(Eigen::Index point) const {
  const Eigen::Matrix3d along_normal = normals_.col(point) * normals_.col(point).transpose();
  const double kt = rooted_[static_cast<size_t>(point)] ? elasticity_.contact : elasticity_.tangential;
  return areas_[point] * ((elasticity_.contact - kt) * along_normal + kt * Eigen::Matrix3d::Identity());
}

LungTissue::Matrix LungTissue::Stiffness(const std::vector<bool>& free) const {
  const BrickElement element(elasticity_.edge, elasticity_.poisson);
  std::vector<BrickMatrix> bricks;
  bricks.reserve(grid_.bricks().size());
  for (size_t b = 0; b < grid_.bricks().size(); ++b) {
    const Eigen::Vector3d middle = grid_.nodes().col(grid_.bricks()[b][0]).array() + grid_.edge() / 2;
    const double modulus = elasticity_.weight.ModulusAt(middle);
    bricks.push_back(modulus * element.Stiffness(grid_.fractions()[b], kOutsideStiffness));
  }
  for (size_t p = 0; p < places_.size(); ++p) {
    if (!free[p]) AddSpring(places_[p].local, SpringOf(static_cast<Eigen::Index>(p)), bricks[places_[p].brick]);
  }
  Entries entries;
  entries.reserve(300 * bricks.size());
  for (size_t b = 0; b < bricks.size(); ++b) AddBrick(grid_.bricks()[b], bricks[b], entries);
  Matrix stiffness(3 * grid_.nodes().cols(), 3 * grid_.nodes().cols());
  stiffness.setFromTriplets(entries.begin(), entries.end());
  stiffness.diagonal().array() += kRegularisation * stiffness.diagonal().mean();
  return stiffness;
}

Eigen::VectorXd LungTissue::Forces(const ConstPoints& displacement) const {
  Points forces = Points::Zero(3, grid_.nodes().cols());
  for (Eigen::Index p = 0; p < displacement.cols(); ++p) {
    const auto& [brick, local] = places_[p];
    const Eigen::Vector3d force = SpringOf(p) * displacement.col(p);
    const BrickWeights weights = WeightsAt(local);
    for (int c = 0; c < 8; ++c) forces.col(grid_.bricks()[brick][c]) += weights[c] * force;
  }
  return forces.reshaped();
}

std::vector<int> LungTissue::LayerStarts() const {
  std::vector<int> starts;
  for (const int node : grid_.layers()) starts.push_back(3 * node);
  return starts;
}

std::optional<LayeredCholesky> LungTissue::Factorise(const std::vector<bool>& free, const StopCheck& stop) const {
  return LayeredCholesky::Make(Stiffness(free), LayerStarts(), stop);
}

std::shared_ptr<const LayeredCholesky> LungTissue::FactorsWith(const std::vector<bool>& free,
                                                               const StopCheck& stop) const {
  if (factors_ != nullptr && std::find(free.begin(), free.end(), true) == free.end()) return factors_;
  std::optional<LayeredCholesky> factors = Factorise(free, stop);  // positive definite as the first one was
  return factors ? std::make_shared<const LayeredCholesky>(*std::move(factors)) : nullptr;
}

LungTissue LungTissue::Under(const LungWeight& weight) const {
  LungTissue tissue = *this;
  tissue.elasticity_.weight = weight;
  tissue.factors_ = nullptr;
  return tissue;
}

Points LungTissue::Solve(const Eigen::VectorXd& g) const { return SolveVectors(normals_ * g.asDiagonal()); }

Points LungTissue::SolveVectors(const ConstPoints& displacement) const {
  const auto [free, held] = Held(displacement);
  return FactorsWith(free, {})->Solve(Forces(held)).reshaped(3, grid_.nodes().cols());
}

PressedLung LungTissue::SolvePressed(const ConstPoints& displacement) const {
  const auto [free, held] = Held(displacement);
  Eigen::MatrixXd forces(3 * grid_.nodes().cols(), 2);
  forces.col(0) = Forces(held);
  Points pulled = normals_;  // springs along the normal
  for (size_t p = 0; p < free.size(); ++p) {
    if (!free[p]) pulled.col(static_cast<Eigen::Index>(p)).setZero();
  }
  forces.col(1) = Forces(pulled) / elasticity_.contact;
  const Eigen::MatrixXd nodes = FactorsWith(free, {})->Solve(forces);
  return {nodes.col(0).reshaped(3, grid_.nodes().cols()), nodes.col(1).reshaped(3, grid_.nodes().cols())};
}

absl::StatusOr<Eigen::MatrixXd> LungTissue::SolveEach(const Eigen::MatrixXd& displacements,
                                                      const std::vector<bool>& free, const StopCheck& stop) const {
  Eigen::MatrixXd forces(3 * grid_.nodes().cols(), displacements.cols());
  for (Eigen::Index c = 0; c < displacements.cols(); ++c) {
    if (stop.Stopped()) return stop.status();
    forces.col(c) = Forces(displacements.col(c).reshaped(3, points_.cols()));
  }
  const std::shared_ptr<const LayeredCholesky> factors = FactorsWith(free, stop);
  if (stop.Stopped()) return stop.status();
  return factors->Solve(forces);
}

absl::StatusOr<Points> LungTissue::SolveThrough(const ConstPoints& points, const ConstPoints& vectors,
                                                double weight) const {
  std::vector<BrickMatrix> bricks(grid_.bricks().size(), BrickMatrix::Zero());
  Points forces = Points::Zero(3, grid_.nodes().cols());
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    const auto [brick, local] = grid_.Locate(points.col(p));
    AddSpring(local, weight * Eigen::Matrix3d::Identity(), bricks[brick]);
    forces(Eigen::all, grid_.bricks()[brick]) += weight * vectors.col(p) * WeightsAt(local).transpose();
  }
  Entries entries;
  for (size_t b = 0; b < bricks.size(); ++b) AddBrick(grid_.bricks()[b], bricks[b], entries);
  Matrix springs(forces.size(), forces.size());
  springs.setFromTriplets(entries.begin(), entries.end());
  const auto factors =
      LayeredCholesky::Make(Stiffness(std::vector<bool>(places_.size(), false)) + springs, LayerStarts(), {});
  if (factors && forces.allFinite()) return factors->Solve(forces.reshaped()).reshaped(3, grid_.nodes().cols());
  return absl::InvalidArgumentError(
      "points: the deformation through them cannot be solved for; check that their places and displacements are finite "
      "and of a lung's size");
}

double LungTissue::Energy(const Points& nodes, const ConstPoints& displacement) const {
  const Eigen::VectorXd u = nodes.reshaped();
  const Matrix stiffness = Stiffness(std::vector<bool>(places_.size(), false));
  double energy = u.dot(stiffness.selfadjointView<Eigen::Lower>() * u) / 2 - u.dot(Forces(displacement));
  for (Eigen::Index p = 0; p < displacement.cols(); ++p) {
    energy += displacement.col(p).dot(SpringOf(p) * displacement.col(p)) / 2;
  }
  return energy;
}

Eigen::Vector3d LungTissue::DisplacementAt(const Points& nodes, const Eigen::Vector3d& point) const {
  const auto [brick, local] = grid_.Locate(point);
  return nodes(Eigen::all, grid_.bricks()[brick]) * WeightsAt(local);
}

Eigen::Matrix3d LungTissue::GradientAt(const Points& nodes, const Eigen::Vector3d& point) const {
  const auto [brick, local] = grid_.Locate(point);
  return nodes(Eigen::all, grid_.bricks()[brick]) * GradientsAt(local).transpose() / elasticity_.edge;
}

}  // namespace phrenic
