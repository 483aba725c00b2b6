#include "server/anatomy/vessels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"

namespace phrenic::anatomy {
namespace {

// A point of a vessel's centreline and the radius there [mm].
struct Station {
  Eigen::Vector3d at;
  double radius;
};

// Returns a station in front of the vertebral bodies, at a distance of their anterior faces.
Station BeforeSpine(double x, double z, double radius, double distance = 1.2) {
  return {{x, SpineFront(z) - radius - distance, z}, radius};
}

// Returns the point where a vessel passes the sheet: the middle of an opening.
Eigen::Vector3d PassageOf(const PlaneLoop& opening) {
  const Eigen::Vector2d sum = std::accumulate(opening.begin(), opening.end(), Eigen::Vector2d(0, 0));
  return DiaphragmPoint(sum / static_cast<double>(opening.size()));
}

// Returns the radius at the relative arc length s, linear between the stations.
double RadiusAt(const std::vector<Station>& stations, const std::vector<double>& passed, double s) {
  const double at = s * passed.back();
  size_t next = 1;
  while (next + 1 < passed.size() && passed[next] < at) ++next;
  const double t = std::clamp((at - passed[next - 1]) / (passed[next] - passed[next - 1]), 0.0, 1.0);
  return stations[next - 1].radius + t * (stations[next].radius - stations[next - 1].radius);
}

Mesh Vessel(const std::vector<Station>& stations, double edge_length) {
  Curve path;
  std::vector<double> passed;
  for (const Station& station : stations) {
    passed.push_back(path.empty() ? 0 : passed.back() + (station.at - path.back()).norm());
    path.push_back(station.at);
  }
  const auto section = [&](double s, const Eigen::Vector3d&) {
    const double radius = RadiusAt(stations, passed, s);
    return TubeSection{radius, radius, Eigen::Vector3d::UnitX()};
  };
  return Tube({.through = path, .section = section}, edge_length);
}

// The gullet comes down between sheet and spine and turns forwards through its hiatus.
std::vector<Station> OesophagusStations() {
  const Eigen::Vector3d hiatus = PassageOf(OesophagealOpening());
  return {BeforeSpine(0, 390, 6, 0.5),
          BeforeSpine(0, 355, 6, 0.5),
          BeforeSpine(-2, 325, 6, 0.5),
          BeforeSpine(-4, 295, 6, 0.5),
          BeforeSpine(-6, 262, 6, 2),
          BeforeSpine(-2, 238, 6, 14),
          BeforeSpine(5, 216, 6, 15),
          {hiatus + Eigen::Vector3d(0, 6.5, 24), 4.8},
          {hiatus + Eigen::Vector3d(0, 5.9, 12), 4.4},
          {hiatus + Eigen::Vector3d(0, 1, -2), 4.4},
          {hiatus + Eigen::Vector3d(2, -10, -7), 5},
          {hiatus + Eigen::Vector3d(13, -22, -14), 6}};
}

}  // namespace

Mesh Aorta(double edge_length) {
  return Vessel({{{4, -36, 264}, 14},
                 {{-4, -40, 290}, 13.5},
                 {{-2, -32, 313}, 13},
                 {{6, -13, 327}, 12.5},
                 {{13, 10, 328}, 12},
                 {{16, 27, 315}, 11.5},
                 BeforeSpine(13, 288, 11),
                 BeforeSpine(12, 255, 10.5),
                 BeforeSpine(9, 220, 10),
                 BeforeSpine(0, 192, 9),
                 BeforeSpine(-4, 166, 8.5),
                 BeforeSpine(-2, 140, 7.5),
                 BeforeSpine(0, 110, 6.8),
                 BeforeSpine(0, 60, 7.5),
                 BeforeSpine(0, 5, 7.5)},
                edge_length);
}

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
