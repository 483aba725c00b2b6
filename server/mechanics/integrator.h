// The family of integrators. To add one: a file in integrators/, a value of v1::Integrator, its case in
// integrators/catalogue.cc, its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_

#include <array>
#include <limits>
#include <string_view>

#include "absl/status/status.h"
#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/state.h"
#include "server/mechanics/workspace.h"

namespace phrenic {

class StepPlan;

// What limits an explicit step: largest frequency and damping rate of all modes, or, if the integrator counts damping
// (Integrator::counted_damping), of the mode for which the two together are largest.
struct Spectrum {
  double omega_max = 0;                                         // eigenfrequency [rad/s]
  double damping_rate = 0;                                      // [1/s]
  double viscous_rate = 0;                                      // its part by Force::AddViscosity [1/s]
  double least_damping_rate = 0;                                // smallest damping rate [1/s]
  double least_mass = std::numeric_limits<double>::infinity();  // of a vertex that moves [kg]
};

// A method that advances a state from t to t + dt. Immutable and thread-safe. Keeps nothing between calls except in
// State, so that a run is a function of model, parameters and state, and a session may change the integrator between
// two steps.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  // The power of the step with which the error at a given time falls, with rigid links too; 0 if it does not fall.
  virtual int order() const = 0;
  // Returns the largest stable step [s]; infinity if any step is stable, 0 if none is.
  virtual double MaxStep(const Spectrum& spectrum) const = 0;
  // The damping that limits the step together with a mode's frequency: with c its rate in that mode, the limit is
  // dt^2 omega^2 + 2 dt c = 4. kOfEachVertex includes viscosity.
  enum class Damping { kNone, kViscosity, kOfEachVertex, kAll };
  virtual Damping counted_damping() const { return Damping::kNone; }
  // True if Advance requires work.before and work.velocity_before to hold the start of the step.
  virtual bool needs_start() const { return true; }

  // Advances positions, velocities and poses from state.time to state.time + dt: motions drive bones, forces move the
  // tissue, and constraints hold at the end. Does not change state.time, phase and tick. ABORTED with a remedy if it
  // finds no next state.
  virtual absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                               Workspace& work) const = 0;
};

// The integrator of each value of v1::Integrator.
using IntegratorTable = std::array<const Integrator*, v1::Integrator_ARRAYSIZE>;

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
