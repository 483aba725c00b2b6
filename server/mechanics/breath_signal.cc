#include "server/mechanics/breath_signal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phrenic {
namespace {

using std::numbers::pi;

constexpr double kBreathsOfWaxing = 12;
constexpr double kShortestExpiration = 0.02;  // of a breath

BreathSignal Sine(double phase) {
  const double angle = 2 * pi * phase, value = std::sin(angle);
  return {value, 2 * pi * std::cos(angle), std::max(0.0, -value)};
}

BreathSignal RaisedCosine(double phase) {
  const double angle = 2 * pi * phase, value = (1 - std::cos(angle)) / 2;
  return {value, pi * std::sin(angle), 1 - value};
}

// Up over the inspiratory share, down, and the pause.
BreathSignal WithShares(double inspiratory, double pause, double phase) {
  if (inspiratory == 0.5 && pause == 0) return RaisedCosine(phase);
  const double at = phase - std::floor(phase);
  const double out = std::max(1 - pause - inspiratory, kShortestExpiration);
  if (at >= inspiratory + out) return {0, 0, 1};
  const bool in = at < inspiratory;
  BreathSignal signal = RaisedCosine(in ? at / inspiratory / 2 : 0.5 + (at - inspiratory) / out / 2);
  signal.slope /= 2 * (in ? inspiratory : out);
  return signal;
}

bool GlottisIsClosed(const v1::Parameters& parameters, double phase) {
  const double since_peak = phase - std::floor(phase) - parameters.inspiratory_share();
  return since_peak >= 0 && since_peak < parameters.glottis_share();
}

BreathSignal Trace(const google::protobuf::RepeatedField<double>& values, double phase) {
  if (values.empty()) return {};
  const double at = (phase - std::floor(phase)) * values.size();
  const int left = std::min(static_cast<int>(at), values.size() - 1), right = (left + 1) % values.size();
  const double value = values[left] + (at - left) * (values[right] - values[left]);
  return {value, (values[right] - values[left]) * values.size(), 1 - value};
}

BreathSignal OfWaveform(const v1::Breath& breath, const v1::Parameters& parameters, double phase) {
  switch (breath.waveform()) {
    case v1::WAVEFORM_RAISED_COSINE: {
      BreathSignal signal = WithShares(parameters.inspiratory_share(), parameters.pause_share(), phase);
      signal.glottis_closed = GlottisIsClosed(parameters, phase);
      return signal;
    }
    case v1::WAVEFORM_TRACE:
      return Trace(breath.trace(), phase);
    default:
      return Sine(phase);
  }
}

}  // namespace

BreathSignal BreathSignalAt(const v1::Breath& breath, const v1::Parameters& parameters, double phase) {
  BreathSignal signal = OfWaveform(breath, parameters, phase);
  if (parameters.waxing() == 0) return signal;
  const double angle = 2 * pi * phase / kBreathsOfWaxing;
  const double share = 1 - parameters.waxing() * (1 - std::cos(angle)) / 2;
  signal.slope = share * signal.slope - parameters.waxing() * pi / kBreathsOfWaxing * std::sin(angle) * signal.value;
  signal.value *= share;
  return signal;
}

}  // namespace phrenic
