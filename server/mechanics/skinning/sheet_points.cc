#include "server/mechanics/skinning/sheet_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "server/mechanics/skinning/sheet_points_kernel.h"

namespace phrenic {
namespace {

using NodeSum = Eigen::Matrix<double, 8, 1>;

struct SheetNodes {
  std::vector<SheetNode> at, rates;
};

NodeSum WeightedNode(const std::vector<SheetNode>& nodes, const DriverSheet& sheet, const TriangleBinding& binding) {
  const auto numbers = [&](int k) {
    return Eigen::Map<const NodeSum, Eigen::Aligned64>(nodes[binding.corners[k] - sheet.first_vertex].numbers);
  };
  return binding.weights[0] * numbers(0) + binding.weights[1] * numbers(1) + binding.weights[2] * numbers(2);
}

// Sets the positions and clears the sums.
void StartSums(const DriverSheet& sheet, const ConstPoints& of, std::vector<SheetNode>& nodes) {
  nodes.resize(static_cast<size_t>(sheet.rest_areas.size()));
  for (size_t k = 0; k < nodes.size(); ++k) {
    nodes[k] = {};
    nodes[k].position() = of.col(sheet.first_vertex + static_cast<Eigen::Index>(k));
  }
}

void AddToNode(SheetNode& node, const Eigen::Vector3d& area_vector, double area) {
  node.normal() += area_vector;
  node.stretch() += area;
}

// Sums area vectors N = (b - a) x (c - a) / 2 and areas |N|; with kRates also dN/dt and d|N|/dt = n . dN/dt.
template <bool kRates>
void AddUpTriangles(const DriverSheet& sheet, SheetNodes& nodes) {
  for (const auto& corners : sheet.triangles.colwise()) {
    const Eigen::Vector3i v = corners.array() - sheet.first_vertex;
    SheetNode &a = nodes.at[v[0]], &b = nodes.at[v[1]], &c = nodes.at[v[2]];
    const Eigen::Vector3d u = b.position() - a.position(), w = c.position() - a.position();
    const Eigen::Vector3d area = 0.5 * u.cross(w);
    const double size = area.norm();
    for (SheetNode* node : {&a, &b, &c}) AddToNode(*node, area, size);
    if constexpr (!kRates) continue;
    SheetNode &da = nodes.rates[v[0]], &db = nodes.rates[v[1]], &dc = nodes.rates[v[2]];
    const Eigen::Vector3d du = db.position() - da.position(), dw = dc.position() - da.position();
    const Eigen::Vector3d rate = 0.5 * (du.cross(w) + u.cross(dw));
    const double growth = size > 0 ? area.dot(rate) / size : 0;
    for (SheetNode* node : {&da, &db, &dc}) AddToNode(*node, rate, growth);
  }
}

// Turns the sums into unit normals and stretches: with N their area vector, dn/dt = (dN/dt - n (n . dN/dt)) / |N|.
template <bool kRates>
void FinishSums(const DriverSheet& sheet, SheetNodes& nodes) {
  for (size_t k = 0; k < nodes.at.size(); ++k) {
    const double rest = sheet.rest_areas[static_cast<Eigen::Index>(k)], size = nodes.at[k].normal().norm();
    if (!(rest > 0)) continue;
    auto normal = nodes.at[k].normal();
    if (size > 0) normal /= size;
    nodes.at[k].stretch() /= rest;
    if constexpr (!kRates) continue;
    auto rate = nodes.rates[k].normal();
    if (size > 0) rate = Eigen::Vector3d((rate - normal * normal.dot(rate)) / size);
    nodes.rates[k].stretch() /= rest;
  }
}

struct LiftedPoint {
  Eigen::Vector3d normal;
  double length;   // of the interpolated normal before it is made a unit vector
  double stretch;  // of the area
  double height;   // [m]

  LiftedPoint(const NodeSum& sum, double rest_height)
      : normal(sum.segment<3>(4)), length(normal.norm()), stretch(std::max(kSmallestStretch, sum[3])) {
    if (length > 0) normal /= length;
    height = rest_height / stretch;
  }
  // Returns the rate of (H / J) n, from the rates of what it is made of.
  Eigen::Vector3d Rate(const NodeSum& rates) const {
    const double growth = stretch > kSmallestStretch ? rates[3] / stretch : 0;
    const Eigen::Vector3d turning = rates.segment<3>(4);
    const Eigen::Vector3d turned = length > 0 ? Eigen::Vector3d((turning - normal * normal.dot(turning)) / length)
                                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    return height * (turned - growth * normal);
  }
};

// Completes what the nodes pass on.
template <bool kRates>
SheetNodes& NodesOf(const DriverSheet& sheet, const EvalContext& at) {
  SheetNodes& nodes = at.scratch.Get<SheetNodes>();
  StartSums(sheet, at.x, nodes.at);
  if (kRates) StartSums(sheet, at.v, nodes.rates);
  AddUpTriangles<kRates>(sheet, nodes);
  FinishSums<kRates>(sheet, nodes);
  return nodes;
}

}  // namespace

void PlaceOnSheet(const DriverSheet& sheet, std::span<const TriangleBinding> bindings, const EvalContext& at,
                  MutablePoints x) {
  PlaceBindings(bindings, NodesOf<false>(sheet, at).at.data(), sheet.first_vertex, x.data());
}

void MoveOnSheet(const DriverSheet& sheet, std::span<const TriangleBinding> bindings, const EvalContext& at,
                 MutablePoints x, MutablePoints v) {
  const SheetNodes& nodes = NodesOf<true>(sheet, at);
  Eigen::Index i = 0;
  for (const TriangleBinding& binding : bindings) {
    const NodeSum sum = WeightedNode(nodes.at, sheet, binding), rates = WeightedNode(nodes.rates, sheet, binding);
    const LiftedPoint lifted(sum, binding.height);
    x.col(i) = sum.head<3>() + lifted.height * lifted.normal;
    v.col(i) = rates.head<3>() + lifted.Rate(rates);
    ++i;
  }
}

}  // namespace phrenic
