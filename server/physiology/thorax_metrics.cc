#include "server/physiology/thorax_metrics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/tissue_bodies.h"
#include "server/mesh/topology.h"

namespace phrenic::physiology {
namespace {

constexpr double kBesideMidline = 0.035;  // [m]
constexpr double kUpwards = 0.3;          // least z of a unit normal of the upper face; the steep rim has less

// Normal of a triangle with the length of its area [m^2].
Eigen::Vector3d AreaNormal(const ConstPoints& x, const Triangles& triangles, int t) {
  const Eigen::Vector3d a = x.col(triangles(0, t)), b = x.col(triangles(1, t)), c = x.col(triangles(2, t));
  return (b - a).cross(c - a) / 2;
}

double TotalArea(const ConstPoints& x, const Triangles& triangles) {
  double area = 0;
  for (int t = 0; t < triangles.cols(); ++t) area += AreaNormal(x, triangles, t).norm();
  return area;
}

// Dijkstra's shortest paths along the edges from the vertices `from`. Returns the predecessor of each vertex on its
// path; -1 for the vertices of `from` and for unreachable ones.
std::vector<int> Predecessors(const Points& x, const Edges& edges, const std::vector<int>& from) {
  const auto n = static_cast<size_t>(x.cols());
  std::vector<std::vector<int>> neighbours(n);
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    neighbours[edges(0, e)].push_back(edges(1, e));
    neighbours[edges(1, e)].push_back(edges(0, e));
  }
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  std::vector<int> before(n, -1);
  for (const int i : from) distance[i] = 0, queue.emplace(0, i);
  while (!queue.empty()) {
    const auto [so_far, i] = queue.top();
    queue.pop();
    if (so_far > distance[i]) continue;
    for (const int j : neighbours[i]) {
      const double length = so_far + (x.col(j) - x.col(i)).norm();
      if (length >= distance[j]) continue;
      distance[j] = length, before[j] = i;
      queue.emplace(length, j);
    }
  }
  return before;
}

}  // namespace

absl::StatusOr<ThoraxMetrics> ThoraxMetrics::Of(const Model& model) {
  ThoraxMetrics metrics(model);
  for (const int body : TissueBodies(model)) {
    if (model.bodies[body].anatomy.structure() != v1::STRUCTURE_DIAPHRAGM) continue;
    metrics.diaphragm_ = body;
    metrics.FindUpperFace();
    metrics.FindFibres();
    return metrics;
  }
  return absl::FailedPreconditionError(
      "the scene has no deformable body with the anatomy STRUCTURE_DIAPHRAGM, so there is nothing to compare with a "
      "person's breath");
}

std::vector<int> ThoraxMetrics::BodiesOf(v1::Structure structure) const {
  std::vector<int> found;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].anatomy.structure() == structure) found.push_back(b);
  }
  return found;
}

Points ThoraxMetrics::Placed(const State& state, int body) const {
  Points placed(3, model_.bodies[body].mesh.vertices.cols());
  PlaceBody(model_, state, body, placed);
  return placed;
}

Points ThoraxMetrics::Sheet(const State& state) const { return Placed(state, diaphragm_); }

void ThoraxMetrics::FindUpperFace() {
  const Mesh& mesh = model_.bodies[diaphragm_].mesh;
  for (int t = 0; t < mesh.triangles.cols(); ++t) {
    if (AreaNormal(mesh.vertices, mesh.triangles, t).normalized().z() > kUpwards) upper_.push_back(t);
  }
}

void ThoraxMetrics::FindFibres() {
  const Mesh& mesh = model_.bodies[diaphragm_].mesh;
  const auto tendon = mesh.regions.find("tendon"), rim = mesh.regions.find("rim");
  if (tendon == mesh.regions.end() || rim == mesh.regions.end()) return;
  std::vector<bool> in_tendon(mesh.vertices.cols(), false);
  for (const int i : tendon->second) in_tendon[i] = true;
  for (int t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const bool inside = in_tendon[corners[0]] && in_tendon[corners[1]] && in_tendon[corners[2]];
    (inside ? tendon_ : muscle_).push_back(t);
  }
  const std::vector<int> before = Predecessors(mesh.vertices, SpringEdges(mesh), tendon->second);
  std::vector<Eigen::Vector2i> edges;
  for (const int start : rim->second) {
    for (int i = start; before[i] >= 0; i = before[i]) edges.emplace_back(i, before[i]);
  }
  fibres_.resize(2, static_cast<Eigen::Index>(edges.size()));
  for (size_t e = 0; e < edges.size(); ++e) fibres_.col(static_cast<Eigen::Index>(e)) = edges[e];
}

double ThoraxMetrics::DomeDescent(const State& state, v1::Side side) const {
  const Points& rest = model_.bodies[diaphragm_].mesh.vertices;
  const double left = side == v1::SIDE_LEFT ? 1 : -1;
  const auto top = [&](const ConstPoints& x) {
    double highest = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (left * rest(0, i) > kBesideMidline) highest = std::max(highest, x(2, i));
    }
    return highest;
  };
  return top(rest) - top(Sheet(state));
}

double ThoraxMetrics::PosteriorOverAnterior(const State& state) const {
  const Mesh& mesh = model_.bodies[diaphragm_].mesh;
  const Points now = Sheet(state);
  const double middle = (mesh.vertices.row(1).minCoeff() + mesh.vertices.row(1).maxCoeff()) / 2;
  double descent[2] = {0, 0}, area[2] = {0, 0};
  for (const int t : upper_) {
    const double weight = AreaNormal(mesh.vertices, mesh.triangles, t).z();
    double y = 0, fall = 0;
    for (const int i : mesh.triangles.col(t)) {
      y += mesh.vertices(1, i) / 3;
      fall += (mesh.vertices(2, i) - now(2, i)) / 3;
    }
    const int half = y > middle ? 1 : 0;
    descent[half] += weight * fall, area[half] += weight;
  }
  return descent[1] / area[1] / (descent[0] / area[0]);
}

double ThoraxMetrics::FibreLength(const ConstPoints& x) const {
  double length = 0;
  for (Eigen::Index e = 0; e < fibres_.cols(); ++e) length += (x.col(fibres_(1, e)) - x.col(fibres_(0, e))).norm();
  return length;
}

double ThoraxMetrics::Area(const ConstPoints& x, const std::vector<int>& triangles) const {
  double area = 0;
  for (const int t : triangles) area += AreaNormal(x, model_.bodies[diaphragm_].mesh.triangles, t).norm();
  return area;
}

std::optional<double> ThoraxMetrics::FibreShortening(const State& state) const {
  if (fibres_.cols() == 0) return std::nullopt;
  return 1 - FibreLength(Sheet(state)) / FibreLength(model_.bodies[diaphragm_].mesh.vertices);
}

std::optional<double> ThoraxMetrics::TendonAreaChange(const State& state) const {
  if (tendon_.empty()) return std::nullopt;
  return std::abs(Area(Sheet(state), tendon_) / Area(model_.bodies[diaphragm_].mesh.vertices, tendon_) - 1);
}

std::optional<double> ThoraxMetrics::StrainAcrossFibres(const State& state) const {
  if (muscle_.empty() || fibres_.cols() == 0) return std::nullopt;
  const double area = Area(Sheet(state), muscle_) / Area(model_.bodies[diaphragm_].mesh.vertices, muscle_);
  return std::abs(area / (1 - *FibreShortening(state)) - 1);
}

double ThoraxMetrics::ThicknessRatio(const State& state) const {
  const Mesh& mesh = model_.bodies[diaphragm_].mesh;
  const auto thickness = [&mesh](const ConstPoints& x) {
    return SignedVolume(x, mesh.triangles) / TotalArea(x, mesh.triangles);
  };
  return thickness(Sheet(state)) / thickness(mesh.vertices);
}

std::optional<Eigen::Vector3d> ThoraxMetrics::SternumShift(const State& state) const {
  const std::vector<int> bodies = BodiesOf(v1::STRUCTURE_STERNUM_BODY);
  if (bodies.empty()) return std::nullopt;
  return (Placed(state, bodies.front()) - model_.bodies[bodies.front()].mesh.vertices).rowwise().mean();
}

std::optional<double> ThoraxMetrics::LowerRibShift(const State& state) const {
  double sum = 0;
  int ribs = 0;
  for (const int b : BodiesOf(v1::STRUCTURE_RIB)) {
    const v1::Anatomy& anatomy = model_.bodies[b].anatomy;
    if (anatomy.number() < 7 || anatomy.number() > 10) continue;
    const double side = anatomy.side() == v1::SIDE_LEFT ? 1 : -1;
    Eigen::Index outermost = 0;
    (side * model_.bodies[b].mesh.vertices.row(0)).maxCoeff(&outermost);
    sum += side * (Placed(state, b)(0, outermost) - model_.bodies[b].mesh.vertices(0, outermost));
    ++ribs;
  }
  if (ribs == 0) return std::nullopt;
  return sum / ribs;
}

double ThoraxMetrics::SweptVolume(const State& state) const {
  const Mesh& mesh = model_.bodies[diaphragm_].mesh;
  const Points now = Sheet(state);
  double volume = 0;
  for (const int t : upper_) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const Eigen::Vector3d shift = (now(Eigen::all, corners) - mesh.vertices(Eigen::all, corners)).rowwise().mean();
    volume -= shift.dot(AreaNormal(mesh.vertices, mesh.triangles, t));
  }
  return volume;
}

std::optional<double> ThoraxMetrics::LungVolumeChange(const State& state) const {
  const std::vector<int> lungs = BodiesOf(v1::STRUCTURE_LUNG);
  if (lungs.empty()) return std::nullopt;
  double change = 0;
  for (const int b : lungs) {
    const Mesh& mesh = model_.bodies[b].mesh;
    change += SignedVolume(Placed(state, b), mesh.triangles) - SignedVolume(mesh.vertices, mesh.triangles);
  }
  return change;
}

}  // namespace phrenic::physiology
