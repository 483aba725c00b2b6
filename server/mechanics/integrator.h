// The family of integrators: how free vertices get from t to t + dt.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_

#include <string_view>

#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/state.h"

namespace phrenic {

struct Model;

// Memory that a step needs; made once per session, so that no step allocates. Holds nothing between steps.
struct Workspace {
  Points force;   // [N]
  Points before;  // positions at the start of the step [m]
};

// What limits an explicit step.
struct Spectrum {
  double omega_max = 0;     // largest eigenfrequency [rad/s]
  double damping_rate = 0;  // largest damping rate [1/s]
};

// Immutable; keeps nothing between calls except through State, so that a run is a function of model, parameters and
// state, and a session may change integrator between two steps.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  virtual int order() const = 0;
  // The largest stable step [s]; infinity where nothing limits it.
  virtual double MaxStep(const Spectrum& spectrum) const = 0;
  // Carries free vertices from t to t + dt. Motions have set driven ones and poses for t + dt already; state.time is
  // still t.
  virtual void Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
