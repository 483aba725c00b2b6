// The family of integrators: how a state gets from t to t + dt. To add one: a file in integrators/, a value of
// v1::Integrator, its case in catalogue.cc, its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_

#include <array>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/solver_effort.h"
#include "server/mechanics/state.h"

namespace phrenic {

struct Model;
class ImplicitSystem;
class PrefactoredSystem;
class QuasiNewton;

// Memory that a step needs; made once per session, so that no step allocates (the first one after a change of
// integrator may). Holds nothing between steps but what can be worked out again.
struct Workspace {
  Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  ~Workspace();

  Points before, velocity_before;          // at the start of the step, for integrators that need it [m], [m/s]
  Points force;                            // [N]
  std::vector<Eigen::Vector3d> driven;     // positions of driven vertices at the start of the step [m]
  Eigen::VectorXd damping;                 // [N s/m] a vertex
  std::vector<Points> stages;              // of the integrators that have stages; made when first needed
  std::vector<State> trials;               // of adaptive steps; made when first needed
  OuterProducts shared_damping;            // of the last step, where its integrator asks for it
  std::vector<StateBounds> bounds;         // after the step, of each block or more, where its integrator notes it
  SolverEffort effort;                     // of the implicit integrators' linear systems, in the last step
  std::unique_ptr<ImplicitSystem> system;  // of the implicit integrators; made when first needed
  // Of projective dynamics; made when first needed.
  std::array<std::unique_ptr<PrefactoredSystem>, 2> prefactored;
  std::unique_ptr<QuasiNewton> quasi_newton;
};

// What limits an explicit step: largest frequency and damping rate of all modes, or, where damping counts
// (Integrator::counted_damping), of the mode for which the two together are largest.
struct Spectrum {
  double omega_max = 0;                                         // eigenfrequency [rad/s]
  double damping_rate = 0;                                      // [1/s]
  double least_damping_rate = 0;                                // smallest damping rate [1/s]
  double least_mass = std::numeric_limits<double>::infinity();  // of a vertex that moves [kg]
};

// Immutable; keeps nothing between calls except through State, so that a run is a function of model, parameters and
// state, and a session may change integrator between two steps.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  // The error at a given time falls with this power of the step, without rigid links; 0 where it does not fall.
  virtual int order() const = 0;
  // The largest stable step [s]; infinity where nothing limits it, 0 where no step is stable.
  virtual double MaxStep(const Spectrum& spectrum) const = 0;
  // Which damping counts beside a mode's frequency, by its rate c in that mode: the limit is then
  // dt^2 omega^2 + 2 dt c = 4.
  enum class Damping { kNone, kOfEachVertex, kAll };
  virtual Damping counted_damping() const { return Damping::kNone; }
  // Whether the workspace's `before` and `velocity_before` are to hold the start of the step when it is to advance.
  virtual bool needs_start() const { return true; }
  // Carries positions, velocities and poses from state.time to state.time + dt; motions drive the bones, forces the
  // tissue, and constraints have the last word. Leaves state.time, phase and tick as they are. ABORTED
  // with the remedy where it finds no next state.
  virtual absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                               Workspace& work) const = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATOR_H_
