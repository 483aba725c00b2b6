// Recordings over time against the model: the lungs' volume V s(phase), or the descent D s(phase) of the middle of a
// base, with V and D linear in the amplitudes and s the raised cosine of breath_signal.h, whose inspiratory share,
// pause and beginning are fitted, and an offset. Neighbouring samples are alike: a quarter of a breath counts as one
// datum. The lengths of the breaths are data of their own. Every second breath is held out (SamplesOf).
#ifndef PHRENIC_SERVER_FIT_TRACE_RESIDUALS_H_
#define PHRENIC_SERVER_FIT_TRACE_RESIDUALS_H_

#include "server/fit/fit_space.h"
#include "server/fit/residuals.h"
#include "server/fit/traces.h"

namespace phrenic::fit {

inline constexpr char kBreathLength[] = "breath length", kInspiratoryShare[] = "inspiratory share",
                      kPauseShare[] = "pause";

// Adds the residuals of a recording, and the numbers that it needs to the space. `depth`: of the breath per amplitude
// [m^2] or [1]. Prior of the time course: 4 +- 1.5 s, 0.42 +- 0.08 of it inspiration, 0.1 +- 0.08 pause (quiet
// breathing: Tobin et al., Chest 84, 1983; Benchetrit, Respir Physiol 122, 2000).
void AddTrace(const KindOfData& kind, const TracedBreaths& breaths, const Eigen::VectorXd& depth, FitSpace& space,
              AllResiduals& all);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_TRACE_RESIDUALS_H_
