#include "server/anatomy/vessels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"

namespace phrenic::anatomy {
namespace {

// A point of a vessel's centreline and the semi-axes of its section there [mm].
struct Station {
  Station(const Eigen::Vector3d& centre, double radius) : Station(centre, radius, radius) {}
  Station(const Eigen::Vector3d& centre, double half_width, double half_depth)
      : at(centre), lateral(half_width), depth(half_depth) {}

  Eigen::Vector3d at;
  double lateral, depth;  // from side to side, and across
};

// Returns a station in front of the vertebral bodies, at a distance of their anterior faces.
Station BeforeSpine(double x, double z, double radius, double distance = 1.2) {
  return {{x, SpineFront(z) - radius - distance, z}, radius};
}

// As above, of a vessel that is flattened between the spine and what is in front of it.
Station Flattened(double x, double z, double lateral, double depth, double distance) {
  return {{x, SpineFront(z) - depth - distance, z}, lateral, depth};
}

// Returns the point where a vessel passes the sheet: the middle of an opening.
Eigen::Vector3d PassageOf(const PlaneLoop& opening) {
  const Eigen::Vector2d sum = std::accumulate(opening.begin(), opening.end(), Eigen::Vector2d(0, 0));
  return DiaphragmPoint(sum / static_cast<double>(opening.size()));
}

// Returns the direction of the path at a station.
Eigen::Vector3d DirectionAt(const std::vector<Station>& stations, size_t i) {
  return (stations[std::min(i + 1, stations.size() - 1)].at - stations[i > 0 ? i - 1 : 0].at).normalized();
}

// Returns the section at the relative arc length s, its semi-axes linear between the stations. The broad axis is
// lateral, so that a ring has vertices at the edges of a flat vessel.
TubeSection SectionOf(const std::vector<Station>& stations, const std::vector<double>& passed, double s) {
  const double at = s * passed.back();
  size_t next = 1;
  while (next + 1 < passed.size() && passed[next] < at) ++next;
  const double t = std::clamp((at - passed[next - 1]) / (passed[next] - passed[next - 1]), 0.0, 1.0);
  const Station &from = stations[next - 1], &to = stations[next];
  const Eigen::Vector3d direction = (1 - t) * DirectionAt(stations, next - 1) + t * DirectionAt(stations, next);
  return {std::lerp(from.lateral, to.lateral, t), std::lerp(from.depth, to.depth, t),
          direction.cross(Eigen::Vector3d::UnitX())};
}

Mesh Vessel(const std::vector<Station>& stations, double edge_length) {
  Curve path;
  std::vector<double> passed;
  for (const Station& station : stations) {
    passed.push_back(path.empty() ? 0 : passed.back() + (station.at - path.back()).norm());
    path.push_back(station.at);
  }
  const auto section = [&](double s, const Eigen::Vector3d&) { return SectionOf(stations, passed, s); };
  return Tube({.through = path, .section = section}, edge_length);
}

// The aorta rises from the heart between pulmonary trunk and superior vena cava, turns back over the left bronchus,
// descends left of the midline, then behind the gullet and the sheet. Flat where the sheet is close to the discs, it
// stays behind the sheet for 15 mm below the median arcuate ligament, which descends in a deep breath.
std::vector<Station> AortaStations() {
  return {{{-8, -38, 256}, 10},
          {{-12, -42, 271}, 9.5},
          {{-12.6, -42.8, 284}, 9.4},
          {{-9.8, -40.5, 294}, 9.2},
          {{-5.5, -36, 303}, 8.8},
          {{-2, -30, 313}, 8.5},
          {{4, -17, 322}, 8.5},
          {{11, -2, 326}, 8.8},
          {{15.8, 12, 323}, 9},
          {{17, 24, 315}, 9.2},
          {{16.5, 31, 305}, 9.5},
          {{16, 33.5, 296}, 9.7},
          BeforeSpine(14, 284, 10, 1.5),
          BeforeSpine(12, 262, 10, 1.5),
          Flattened(12.5, 244, 9.5, 8.5, 1),
          Flattened(11.5, 230, 9, 7, 0.8),
          Flattened(6.5, 217, 8.5, 5.2, 1),
          Flattened(-0.5, 209, 8.5, 5, 1),
          Flattened(-5.5, 202, 7.5, 5.8, 1),
          {{-5.5, 25.5, 195}, 7.5, 6},
          {{-5, 25.3, 188}, 7.5, 5.2},
          {{-4.5, 25.2, 181}, 7.2, 3.7},
          {{-4, 24.9, 175}, 7, 2.4},
          {{-3.2, 23.8, 169}, 6.5, 1.3},
          {{-2.5, 22.6, 163.5}, 6.2, 0.6},
          {{-2, 21.5, 157}, 6.5, 0.55},
          {{-2, 20.7, 151}, 6.8, 0.9},
          {{-1.6, 19.6, 146}, 7, 1},
          {{-1, 17.6, 140}, 7, 0.7},
          {{0, 15.25, 133}, 7.5, 0.33},
          {{0, 13.9, 126}, 7, 0.55},
          {{0, 13.2, 121}, 5.5, 0.8},
          {{0, 12.4, 116}, 4.2, 1},
          {{0, 10.8, 111}, 3.7, 1},
          {{0, 8.6, 106}, 3.8, 1.1},
          {{0, 4.6, 100.5}, 3.8, 1.9},
          {{0, 1.6, 95}, 4.8, 4.2},
          {{0, -1, 88}, 5.6, 5.6},
          BeforeSpine(0, 78, 6.2, 1.5),
          BeforeSpine(0, 60, 6.6, 1.8),
          BeforeSpine(0, 34, 7, 2),
          BeforeSpine(0, 5, 7.3, 1.8)};
}

// The gullet comes down between sheet and spine and turns forwards through its hiatus.
std::vector<Station> OesophagusStations() {
  const Eigen::Vector3d hiatus = PassageOf(OesophagealOpening());
  return {BeforeSpine(0, 390, 5.5, 1),
          BeforeSpine(0, 355, 5.5, 1),
          BeforeSpine(-2, 325, 5.5, 1),
          BeforeSpine(-4, 295, 5.5, 1.2),
          BeforeSpine(-6, 262, 6, 2),
          BeforeSpine(-2, 238, 6, 14),
          BeforeSpine(5, 216, 6, 15),
          {hiatus + Eigen::Vector3d(0, 6.6, 24), 4.6},
          {hiatus + Eigen::Vector3d(0, 6, 12), 4.1},
          {hiatus + Eigen::Vector3d(0, 0.6, -2), 3.7},
          {hiatus + Eigen::Vector3d(3.5, -10, -7), 4},
          {hiatus + Eigen::Vector3d(13, -22, -14), 6}};
}

}  // namespace

Mesh Aorta(double edge_length) { return Vessel(AortaStations(), edge_length); }

Mesh SuperiorVenaCava(double edge_length) {
  return Vessel({{{-17, -20, 262}, 9}, {{-18, -22, 295}, 9}, {{-18, -20, 322}, 8.5}, {{-16, -14, 345}, 8}},
                edge_length);
}

Mesh InferiorVenaCava(double edge_length) {
  const Eigen::Vector3d opening = PassageOf(CavalOpening());
  return Vessel({{{-23, -2, 260}, 9.5},
                 {opening + Eigen::Vector3d(6, 1, 18), 9.5},
                 {opening, 9.5},
                 {opening + Eigen::Vector3d(-3, -1, -18), 9.5},
                 BeforeSpine(-36, 168, 9.5, 22),
                 BeforeSpine(-24, 120, 9.5, 12),
                 BeforeSpine(-19, 60, 9.5, 7),
                 BeforeSpine(-19, 5, 9.5, 7)},
                edge_length);
}

Mesh Oesophagus(double edge_length) { return Vessel(OesophagusStations(), edge_length); }

Eigen::Vector3d OesophagusEnd() { return OesophagusStations().back().at; }

}  // namespace phrenic::anatomy
