#include "server/mechanics/lungs/boundary_modes.h"

#include <algorithm>
#include <array>

namespace phrenic {
namespace {

using Vector = Eigen::Vector3d;
using Place = BoundaryPlace;

double SmoothStep(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

const std::array<BoundaryMode, 10> kModes = {{
    {"piston", "the base descends", [](const Place& p) { return Vector(0, 0, -p.base); }},
    {"tilt-front-back", "the base descends at the back and rises in front",
     [](const Place& p) { return Vector(0, 0, -p.base * p.eta); }},
    {"tilt-left-right", "the base descends at the side and rises in the middle",
     [](const Place& p) { return Vector(0, 0, -p.base * p.xi); }},
    {"pump", "the front wall goes forwards", [](const Place& p) { return Vector(0, -p.costal * (1 - p.eta) / 2, 0); }},
    {"apex", "the top wall descends",
     [](const Place& p) { return Vector(0, 0, -p.costal * std::clamp((p.zeta - 0.6) / 0.4, 0.0, 1.0)); }},
    {"mediastinum", "the medial side goes towards the middle",
     [](const Place& p) { return Vector(-p.outwards * p.medial, 0, 0); }},
    {"mediastinum-tilt", "the medial side goes towards the middle at the back and away from it in front",
     [](const Place& p) { return Vector(-p.outwards * p.medial * p.eta, 0, 0); }},
    {"back", "the wall goes backwards", [](const Place& p) { return Vector(0, p.costal, 0); }},
    {"low-pump", "the lower front wall goes forwards",
     [](const Place& p) { return Vector(0, -p.costal * (1 - p.eta) / 2 * (1 - p.zeta), 0); }},
    {"dome", "the base descends in front and at the back and rises between",
     [](const Place& p) { return Vector(0, 0, -p.base * (p.eta * p.eta - 0.33)); }},
}};

void AddShared(std::initializer_list<int> modes, std::vector<Amplitude>& amplitudes) {
  for (const int mode : modes) amplitudes.push_back({mode, true, true});
}

void AddPerLung(int mode, std::vector<Amplitude>& amplitudes) {
  amplitudes.push_back({mode, true, false});
  amplitudes.push_back({mode, false, true});
}

}  // namespace

BoundaryPlace PlaceOf(const Vector& point, const Vector& normal, const Eigen::AlignedBox3d& box, double outwards) {
  const Vector at = (2 * point - box.min() - box.max()).cwiseQuotient(box.sizes());
  Place place = {};
  place.outwards = outwards;
  place.xi = at.x() * place.outwards;
  place.eta = at.y();
  place.zeta = (at.z() + 1) / 2;
  place.base = SmoothStep(-normal.z(), 0.25, 0.55) * SmoothStep(0.75 - place.zeta, 0, 0.1);
  place.medial = (1 - place.base) * SmoothStep(-normal.x() * place.outwards, 0.35, 0.65);
  place.costal = 1 - place.base - place.medial;
  return place;
}

std::span<const BoundaryMode> BoundaryModes() { return kModes; }

Points ResponseTo(const BoundaryMode& mode, const LungTissue& tissue, double outwards) {
  Points displacement(3, tissue.points().cols());
  for (Eigen::Index i = 0; i < displacement.cols(); ++i) {
    displacement.col(i) =
        mode.displacement(PlaceOf(tissue.points().col(i), tissue.normals().col(i), tissue.box(), outwards));
  }
  return tissue.SolveVectors(displacement);
}

std::string Amplitude::Name() const {
  const std::string name = kModes[static_cast<size_t>(mode)].name;
  return right && left ? name : name + (right ? "-right" : "-left");
}

std::vector<Amplitude> BreathAmplitudes(int count) {
  std::vector<Amplitude> amplitudes;
  AddPerLung(kPiston, amplitudes);
  if (count == 8) {
    AddShared({kTiltFrontBack, kTiltLeftRight, kPump, kApex, kMediastinum, kMediastinumTilt}, amplitudes);
  } else {
    AddPerLung(kTiltFrontBack, amplitudes);
    AddShared({kTiltLeftRight, kPump, kApex, kMediastinum, kMediastinumTilt, kBack, kLowPump, kDome}, amplitudes);
  }
  return amplitudes;
}

}  // namespace phrenic
