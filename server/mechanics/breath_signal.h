// The signal that drives muscles in the course of a breath (thesis 4.1).
#ifndef PHRENIC_SERVER_MECHANICS_BREATH_SIGNAL_H_
#define PHRENIC_SERVER_MECHANICS_BREATH_SIGNAL_H_

#include "phrenic/v1/parameters.pb.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic {

struct BreathSignal {
  double value = 0;       // of the inspiratory muscles, -1 to 1; 0 at rest
  double slope = 0;       // derivative by the phase [1/breath]
  double expiration = 0;  // of the expiratory muscles, 0 to 1
  bool glottis_closed = false;
};

// Returns the signal at a phase [breaths since the start] (enum Waveform). Expiratory muscles follow what is below zero
// of a sine, and what is below the peak of the others. With WAVEFORM_RAISED_COSINE the glottis is closed from the peak
// on for the live parameter glottis_share, of a breath. With the live parameter waxing w, the signal is multiplied by
// 1 - w (1 - cos(2 pi phase/12))/2. Requires: `parameters` has every field.
BreathSignal BreathSignalAt(const v1::Breath& breath, const v1::Parameters& parameters, double phase);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATH_SIGNAL_H_
