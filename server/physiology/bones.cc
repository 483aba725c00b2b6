#include "server/physiology/bones.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "server/mesh/topology.h"

namespace phrenic::physiology {
namespace {

// The mean of what is added to it.
struct Mean {
  double sum = 0;
  int count = 0;
  void Add(double value) { sum += value, ++count; }
  double Value() const { return count > 0 ? sum / count : kNone; }
};

// Returns what a share of the points is below on an axis at rest.
double Quantile(std::vector<double> values, double share) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// Returns how far the outermost point of a rib has moved outwards from rest [m].
double OutwardShift(const Model& model, const State& state, int rib) {
  const BodyModel& body = model.bodies[rib];
  const double side = body.anatomy.side() == v1::SIDE_LEFT ? 1 : -1;
  Eigen::Index outermost = 0;
  (side * body.mesh.vertices.row(0)).maxCoeff(&outermost);
  return side * (Placed(model, state, rib)(0, outermost) - body.mesh.vertices(0, outermost));
}

}  // namespace

Eigen::Vector3d SternumShift(const Model& model, const Parts& parts, const State& from, const State& to) {
  if (parts.sternum < 0) return Eigen::Vector3d::Constant(kNone);
  return (Placed(model, to, parts.sternum) - Placed(model, from, parts.sternum)).rowwise().mean();
}

double LowerRibShift(const Model& model, const Parts& parts, const State& state) {
  Mean mean;
  for (const int b : parts.ribs) {
    const int number = model.bodies[b].anatomy.number();
    if (number >= 7 && number <= 10) mean.Add(OutwardShift(model, state, b));
  }
  return mean.Value();
}

double MiddleRibShift(const Model& model, const Parts& parts, const State& state, v1::Side side) {
  Mean mean;
  for (const int b : parts.ribs) {
    const v1::Anatomy& rib = model.bodies[b].anatomy;
    if (rib.side() == side && rib.number() >= 4 && rib.number() <= 7) mean.Add(OutwardShift(model, state, b));
  }
  return mean.Value();
}

LoweredPoints LoweredLungs(const Model& model, const Parts& parts, const State& from, const State& to) {
  LoweredPoints all;
  for (const int b : parts.lungs) {
    const Points before = Placed(model, from, b), after = Placed(model, to, b);
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
      all.rest.emplace_back(model.bodies[b].mesh.vertices.col(i));
      all.by.push_back(before(2, i) - after(2, i));
    }
  }
  return all;
}

LungShift ShiftOf(const LoweredPoints& lungs) {
  if (lungs.by.empty()) return {};
  std::vector<double> depths, heights;
  for (const auto& at : lungs.rest) depths.push_back(at.y()), heights.push_back(at.z());
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double front = Quantile(depths, 1.0 / 3), back = Quantile(depths, 2.0 / 3);
  Mean apex, base, posterior, anterior;
  for (size_t i = 0; i < lungs.by.size(); ++i) {
    const double share = (heights[i] - *low) / (*high - *low);
    if (share > 0.9) apex.Add(lungs.by[i]);
    if (share < 0.1) base.Add(lungs.by[i]);
    if (share < 0.5 && depths[i] > back) posterior.Add(lungs.by[i]);
    if (share < 0.5 && depths[i] < front) anterior.Add(lungs.by[i]);
  }
  return {Quantile(lungs.by, 0.05), apex.Value(), base.Value(), posterior.Value() / anterior.Value()};
}

double LungSurfaceVolume(const Model& model, const Parts& parts, const State& state) {
  double volume = parts.lungs.empty() ? kNone : 0;
  for (const int b : parts.lungs) volume += SignedVolume(Placed(model, state, b), model.bodies[b].mesh.triangles);
  return volume;
}

}  // namespace phrenic::physiology
