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

// Where a vessel passes the sheet: the middle of an opening and the sheet's normal there, towards the thorax.
struct Passage {
  Eigen::Vector3d middle, normal;
};

Passage PassageOf(const PlaneLoop& opening) {
  const Eigen::Vector2d sum = std::accumulate(opening.begin(), opening.end(), Eigen::Vector2d(0, 0));
  const Eigen::Vector2d middle = sum / static_cast<double>(opening.size());
  return {DiaphragmPoint(middle), DiaphragmNormal(middle)};
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

constexpr double kThroughSheet = 12;  // length over which a vessel follows the sheet's normal on either side [mm]

std::vector<Station> OesophagusStations() {
  const Passage hiatus = PassageOf(OesophagealOpening());
  const Eigen::Vector3d below = hiatus.middle - kThroughSheet * hiatus.normal;
  return {BeforeSpine(0, 390, 6, 0.5),
          BeforeSpine(0, 355, 6, 0.5),
          BeforeSpine(-2, 325, 6, 0.5),
          BeforeSpine(-4, 295, 6, 0.5),
          BeforeSpine(-6, 262, 6, 2),
          BeforeSpine(-3, 235, 6, 12),
          BeforeSpine(3, 212, 6, 17),
          {hiatus.middle + kThroughSheet * hiatus.normal, 5.5},
          {hiatus.middle, 5.5},
          {below, 6},
          {below + Eigen::Vector3d(12, -6, -8), 7}};
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
                 BeforeSpine(2, 192, 9),
                 BeforeSpine(-3, 166, 8.5),
                 BeforeSpine(-1, 140, 8),
                 BeforeSpine(0, 110, 7.5),
                 BeforeSpine(0, 60, 7.5),
                 BeforeSpine(0, 5, 7.5)},
                edge_length);
}

Mesh SuperiorVenaCava(double edge_length) {
  return Vessel({{{-17, -20, 262}, 9}, {{-18, -22, 295}, 9}, {{-18, -20, 322}, 8.5}, {{-16, -14, 345}, 8}},
                edge_length);
}

Mesh InferiorVenaCava(double edge_length) {
  const Passage opening = PassageOf(CavalOpening());
  return Vessel({{{-24, -8, 246}, 9.5},
                 {opening.middle + kThroughSheet * opening.normal, 9.5},
                 {opening.middle, 9.5},
                 {opening.middle - kThroughSheet * opening.normal, 9.5},
                 BeforeSpine(-28, 165, 9.5, 9),
                 BeforeSpine(-22, 120, 9.5, 7),
                 BeforeSpine(-19, 60, 9.5, 7),
                 BeforeSpine(-19, 5, 9.5, 7)},
                edge_length);
}

Mesh Oesophagus(double edge_length) { return Vessel(OesophagusStations(), edge_length); }

Eigen::Vector3d OesophagusEnd() { return OesophagusStations().back().at; }

}  // namespace phrenic::anatomy
