#include "server/mechanics/lungs/lung_responses.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

namespace phrenic {
namespace {

constexpr int kMostDegree = 5;
constexpr double kRidge = 1e-9;          // of the mean diagonal, in least squares
constexpr int kDegreeOfVertical = 5;     // of the diaphragm's vertical displacement, in x and y
constexpr int kDegreeOfHorizontal = 2;   // of its horizontal one
constexpr int kDegreeOfWall = 3;         // of each part of the wall's, in x, y and z
constexpr int kDegreeOfMediastinum = 1;  // of its sideways one, in x and y
constexpr int kDegreeOfRoot = 1;         // of its vertical one, in z

using Legendre = std::array<double, kMostDegree + 1>;

// Legendre's polynomials at a point of -1..1.
Legendre PolynomialsAt(double t) {
  Legendre p = {1, t};
  for (int n = 1; n < kMostDegree; ++n) p[n + 1] = ((2 * n + 1) * t * p[n] - n * p[n - 1]) / (n + 1);
  return p;
}

constexpr int kAlongNormal = 3;  // in place of an axis

// A component of a neighbour's displacement, as a product of polynomials.
struct Candidate {
  LungNeighbour of;
  int axis;
  Eigen::Vector3i degrees;
  bool at_root_alone = false;
};

void AddCandidates(LungNeighbour of, int axis, int degree, bool with_z, std::vector<Candidate>& candidates) {
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; a + b <= degree; ++b) {
      for (int c = 0; c <= (with_z ? degree - a - b : 0); ++c) candidates.push_back({of, axis, {a, b, c}});
    }
  }
}

std::vector<Candidate> AllCandidates() {
  std::vector<Candidate> candidates;
  AddCandidates(LungNeighbour::kDiaphragm, 0, kDegreeOfHorizontal, false, candidates);
  AddCandidates(LungNeighbour::kDiaphragm, 1, kDegreeOfHorizontal, false, candidates);
  AddCandidates(LungNeighbour::kDiaphragm, 2, kDegreeOfVertical, false, candidates);
  for (int axis = 0; axis < 3; ++axis) AddCandidates(LungNeighbour::kWall, axis, kDegreeOfWall, true, candidates);
  AddCandidates(LungNeighbour::kMediastinum, 0, kDegreeOfMediastinum, false, candidates);
  for (const LungNeighbour of : {LungNeighbour::kDiaphragm, LungNeighbour::kWall, LungNeighbour::kMediastinum}) {
    candidates.push_back({of, kAlongNormal, {0, 0, 0}});
  }
  for (int degree = 0; degree <= kDegreeOfRoot; ++degree) {
    candidates.push_back({LungNeighbour::kMediastinum, 2, {0, 0, degree}, true});
  }
  return candidates;
}

// Returns the displacement of each boundary point (row 3 point + axis) for each candidate.
Eigen::MatrixXd Displacements(const LungTissue& tissue, const std::vector<LungNeighbour>& neighbours) {
  const std::vector<Candidate> candidates = AllCandidates();
  const Eigen::AlignedBox3d& box = tissue.box();
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(3 * tissue.points().cols(), static_cast<Eigen::Index>(candidates.size()));
  for (Eigen::Index p = 0; p < tissue.points().cols(); ++p) {
    const Eigen::Vector3d at = (2 * tissue.points().col(p) - box.min() - box.max()).cwiseQuotient(box.sizes());
    const std::array<Legendre, 3> along = {PolynomialsAt(at.x()), PolynomialsAt(at.y()), PolynomialsAt(at.z())};
    for (Eigen::Index k = 0; k < d.cols(); ++k) {
      const auto& [of, axis, degrees, at_root_alone] = candidates[static_cast<size_t>(k)];
      if (of != neighbours[static_cast<size_t>(p)]) continue;
      if (at_root_alone && !tissue.rooted()[static_cast<size_t>(p)]) continue;
      const double value = along[0][degrees.x()] * along[1][degrees.y()] * along[2][degrees.z()];
      if (axis == kAlongNormal) d.col(k).segment<3>(3 * p) = value * tissue.normals().col(p);
      if (axis != kAlongNormal) d(3 * p + axis, k) = value;
    }
  }
  return d;
}

// Returns the matrix (candidates x rows) that fits the candidates to displacements by weighted least squares.
Eigen::MatrixXd LeastSquares(const Eigen::MatrixXd& g, const Eigen::VectorXd& areas) {
  const Eigen::MatrixXd weighted = (areas.asDiagonal() * g).transpose();
  Eigen::MatrixXd normal = weighted * g;
  normal.diagonal().array() += kRidge * normal.diagonal().mean();
  return normal.ldlt().solve(weighted);
}

// The leading eigenvectors of the Gram matrix of several responses (3 nodes x columns).
struct LeadingCombinations {
  Eigen::MatrixXd factors;  // all columns x shapes
  Eigen::VectorXd squares;  // |shape|^2
};

LeadingCombinations LeadingOf(const Eigen::MatrixXd& responses) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(responses.transpose() * responses);
  const double enough = (1 - LungResponses::kLeftOut) * gram.eigenvalues().sum();
  Eigen::Index count = 0;
  const Eigen::Index most = std::min<Eigen::Index>(LungResponses::kMostShapes, gram.eigenvalues().size());
  for (double sum = 0; count < most && sum < enough; ++count) {
    sum += gram.eigenvalues()[gram.eigenvalues().size() - 1 - count];
  }
  return {gram.eigenvectors().rightCols(count), gram.eigenvalues().tail(count)};
}

Eigen::MatrixXd SideBySide(const std::vector<Eigen::MatrixXd>& parts) {
  Eigen::MatrixXd all(parts[0].rows(), 0);
  for (const Eigen::MatrixXd& part : parts) {
    all.conservativeResize(Eigen::NoChange, all.cols() + part.cols());
    all.rightCols(part.cols()) = part;
  }
  return all;
}

}  // namespace

double TissueAtPoint::LargestStrain() const {
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(strain, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

LungResponses::LungResponses(const LungTissue& tissue, const std::vector<LungNeighbour>& neighbours)
    : grid_(tissue.grid()) {
  for (size_t p = 0; p < neighbours.size(); ++p) {
    if (neighbours[p] == LungNeighbour::kNone) continue;
    touching_.push_back(static_cast<Eigen::Index>(p));
    if (tissue.rooted()[p]) rooted_.push_back(static_cast<Eigen::Index>(p));
  }
  normals_ = tissue.normals()(Eigen::all, touching_);
}

void LungResponses::Reduce(const std::vector<Eigen::MatrixXd>& under_weights, const Eigen::MatrixXd& fit) {
  const Eigen::MatrixXd all = SideBySide(under_weights);
  const LeadingCombinations leading = LeadingOf(all);
  shapes_ = all * leading.factors;
  for (const Eigen::MatrixXd& responses : under_weights) {
    const Eigen::MatrixXd in_shapes = leading.squares.cwiseInverse().asDiagonal() * (shapes_.transpose() * responses);
    responses_.push_back({in_shapes.leftCols(fit.rows()) * fit, in_shapes.rightCols<1>()});
  }
}

absl::StatusOr<LungResponses> LungResponses::Make(const LungTissue& tissue,
                                                  const std::vector<LungNeighbour>& neighbours,
                                                  const std::vector<LungWeight>& weights, const StopCheck& stop) {
  LungResponses lung(tissue, neighbours);
  std::vector<bool> free;
  free.reserve(neighbours.size());
  for (const LungNeighbour neighbour : neighbours) free.push_back(neighbour == LungNeighbour::kNone);
  const Eigen::MatrixXd candidates = Displacements(tissue, neighbours);
  Eigen::MatrixXd with_pressure = Eigen::MatrixXd::Zero(candidates.rows(), candidates.cols() + 1);
  with_pressure.leftCols(candidates.cols()) = candidates;
  for (Eigen::Index p = 0; p < tissue.points().cols(); ++p) {
    if (free[static_cast<size_t>(p)]) with_pressure.col(candidates.cols()).segment<3>(3 * p) = tissue.normals().col(p);
  }
  std::vector<Eigen::MatrixXd> under_weights;
  for (const LungWeight& weight : weights) {
    absl::StatusOr<Eigen::MatrixXd> responses = tissue.Under(weight).SolveEach(with_pressure, free, stop);
    if (!responses.ok()) return responses.status();
    under_weights.push_back(*std::move(responses));
  }
  lung.Reduce(under_weights, lung.FitOf(candidates, tissue.areas()));
  return lung;
}

Eigen::VectorXd LungResponses::Amplitudes(const ConstPoints& displacement, size_t weight) const {
  return responses_[weight].projection * Followed(displacement);
}

Eigen::VectorXd LungResponses::Followed(const ConstPoints& displacement) const {
  const auto touching = static_cast<Eigen::Index>(touching_.size()), rooted = static_cast<Eigen::Index>(rooted_.size());
  Eigen::VectorXd g(touching + rooted);
  for (Eigen::Index i = 0; i < touching; ++i) {
    g[i] = normals_.col(i).dot(displacement.col(touching_[static_cast<size_t>(i)]));
  }
  for (Eigen::Index i = 0; i < rooted; ++i) g[touching + i] = displacement(2, rooted_[static_cast<size_t>(i)]);
  return g;
}

Eigen::MatrixXd LungResponses::FitOf(const Eigen::MatrixXd& candidates, const Eigen::VectorXd& areas) const {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(touching_.size() + rooted_.size()));
  weights << areas(touching_), areas(rooted_);
  Eigen::MatrixXd g(weights.size(), candidates.cols());
  for (Eigen::Index k = 0; k < g.cols(); ++k) g.col(k) = Followed(candidates.col(k).reshaped(3, areas.size()));
  return LeastSquares(g, weights);
}

Points LungResponses::Nodes(const Eigen::VectorXd& amplitudes) const {
  const Eigen::VectorXd nodes = shapes_ * amplitudes;
  return nodes.reshaped(3, grid_.nodes().cols());
}

TissueAtPoint LungResponses::At(const Eigen::VectorXd& amplitudes, const Eigen::Vector3d& point) const {
  const auto [brick, local] = grid_.Locate(point);
  Eigen::Matrix<double, 3, 8> corners;
  for (int c = 0; c < 8; ++c) {
    corners.col(c) = shapes_.middleRows<3>(3 * grid_.bricks()[static_cast<size_t>(brick)][c]) * amplitudes;
  }
  return {corners * WeightsAt(local), corners * GradientsAt(local).transpose() / grid_.edge()};
}

}  // namespace phrenic
