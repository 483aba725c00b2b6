#include <algorithm>
#include <cmath>

#include "server/physiology/cavity.h"
#include "server/physiology/measures.h"

namespace phrenic::physiology {
namespace {

constexpr double kLitres = 1e3, kCentimetreOfWater = 98.0665;  // [Pa]

double Greatest(const Recording& r, Quantity q) { return *std::max_element(r.of[q].begin(), r.of[q].end()); }
double Least(const Recording& r, Quantity q) { return *std::min_element(r.of[q].begin(), r.of[q].end()); }
double Gained(const Recording& r, Quantity q) { return r.of[q][r.peak_sample] - r.of[q].front(); }

// Returns -int p dV between two samples [J].
double Work(const Recording& r, size_t from, size_t to) {
  const auto &pressure = r.of[kPleural], &volume = r.of[kVolume];
  const double start = pressure.front();
  double work = 0;
  for (size_t i = from + 1; i <= to; ++i) {
    work -= ((pressure[i] + pressure[i - 1]) / 2 - start) * (volume[i] - volume[i - 1]);
  }
  return work;
}

double FlowIntegrated(const Recording& r) {
  double volume = 0;
  for (size_t i = 1; i <= r.peak_sample; ++i) {
    volume += (r.time[i] - r.time[i - 1]) * (r.of[kFlow][i] + r.of[kFlow][i - 1]) / 2;
  }
  return volume;
}

double VolumeOfAbdomen(const Recording& r) {
  if (r.subject->parts.pressures != nullptr) return Gained(r, kDisplaced);
  const auto sheet = [&r](const State& state) { return Placed(r.subject->model, state, r.subject->parts.sheet); };
  return r.subject->columns.Swept(sheet(r.base), sheet(r.peak));
}

}  // namespace

double TidalVolume(const Recording& r, const Recording&) {
  return kLitres * (Greatest(r, kVolume) - Least(r, kVolume));
}
double InspiredVolume(const Recording& r, const Recording&) {
  return kLitres * (Greatest(r, kVolume) - r.of[kVolume].front());
}
double VolumeAtRest(const Recording& r, const Recording&) { return kLitres * r.of[kVolume].front(); }
double VolumeAbove(const Recording& r, const Recording& other) {
  return VolumeAtRest(r, r) - VolumeAtRest(other, other);
}
double TidalVolumeLost(const Recording& r, const Recording& other) {
  return 100 * (1 - TidalVolume(r, r) / TidalVolume(other, other));
}

double InspiredShare(const Recording& r, const Recording& other) {
  return 100 * InspiredVolume(r, r) / InspiredVolume(other, other);
}

double AbdominalShare(const Recording& r, const Recording&) {
  const double lungs = Gained(r, kVolume);
  return lungs > 0 ? 100 * VolumeOfAbdomen(r) / lungs : kNone;
}
double AbdominalShareLost(const Recording& r, const Recording& other) {
  return AbdominalShare(other, other) - AbdominalShare(r, r);
}

double CavityError(const Recording& r, const Recording&) {
  const Subject& s = *r.subject;
  return 100 * (CavityGrowth(s.model, s.parts, r.base, r.peak) / FlowIntegrated(r) - 1);
}

double PdiSwing(const Recording& r, const Recording&) {
  return (Greatest(r, kTransdiaphragmatic) - r.of[kTransdiaphragmatic].front()) / kCentimetreOfWater;
}
double PdiShare(const Recording& r, const Recording& other) { return 100 * PdiSwing(r, r) / PdiSwing(other, other); }

double PleuralFall(const Recording& r, const Recording&) {
  return (r.of[kPleural].front() - Least(r, kPleural)) / kCentimetreOfWater;
}
double PleuralFallShare(const Recording& r, const Recording& other) {
  return PleuralFall(r, r) / PleuralFall(other, other);
}

double PleuralRise(const Recording& r, const Recording&) {
  return (Greatest(r, kPleural) - r.of[kPleural].front()) / kCentimetreOfWater;
}

double FlowOut(const Recording& r, const Recording&) { return -kLitres * Least(r, kFlow); }
double FlowOutShare(const Recording& r, const Recording& other) { return FlowOut(r, r) / FlowOut(other, other); }
double PleuralRiseShare(const Recording& r, const Recording& other) {
  return PleuralRise(r, r) / PleuralRise(other, other);
}

double FlowShare(const Recording& r, const Recording& other) { return Greatest(r, kFlow) / Greatest(other, kFlow); }

double WorkShare(const Recording& r, const Recording& other) {
  const auto work = [](const Recording& of) { return Work(of, 0, of.peak_sample) / InspiredVolume(of, of); };
  return work(r) / work(other);
}

double LoopShare(const Recording& r, const Recording& other) {
  const auto loop = [](const Recording& of) { return Work(of, 0, of.time.size() - 1) / InspiredVolume(of, of); };
  return loop(r) / loop(other);
}

}  // namespace phrenic::physiology
