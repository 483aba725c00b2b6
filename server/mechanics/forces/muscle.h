// Muscle with its tendon, and passive tissue, in constant-strain triangles of one layer. With F f and F c the deformed
// directions along and across the fibres, l = |F f| and m = |F c| their stretches, A the rest area and g_i the
// gradients of the shape functions,
//   f_i = -A [T/l (f.g_i) F f + U/m (c.g_i) F c + G (F f . F c) ((f.g_i) F c + (c.g_i) F f)]  [N],
// T and U the tensions along and across of breathing/muscle_law.h, each plus viscosity times dl/dt = F f . F' f / l [N
// s/m], G the shear stiffness [N/m]. l and m are regularised: l^2 = |F f|^2 + 1e-8. Fibres follow the gradient of the
// harmonic function from one region to the tendon (Bayer et al. 2012). Force-velocity acts through the low-passed mean
// rate of each bundle of fibres (breathing/fibre_bundles.h), State::scalars that this force advances. The activation of
// a side follows the live parameters diaphragm_activation breath_force times the breath's signal where positive, times
// right_activation or left_activation, with a time constant; muscle_strength scales its force; elasticity scales
// stiffnesses, not tensions. With balanced_at_rest the resting tensions are chosen to hold the other forces at rest
// (muscle_prestress.h), and a constant load L balances what they leave. If an abdomen has a weight, the part of L along
// that weight's direction d at rest carries it, and scales with the weight's component along d in a posture, where its
// direction is e (unit vectors):
//   L(posture) = L - (1 - d.e) (L.d) d  [N].
//
// Energy is that at fixed activation and rates. The stiffness leaves out negative terms.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_H_

#include <array>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "server/mechanics/breathing/fibre_bundles.h"
#include "server/mechanics/breathing/muscle_prestress.h"
#include "server/mechanics/breathing/muscle_triangle.h"
#include "server/mechanics/breathing/posture.h"
#include "server/mechanics/forces/muscle_kernel.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Muscle final : public Force {
 public:
  // Returns null, and reports it, if the body has no triangle with area. INVALID_ARGUMENT if a region does not exist or
  // there is no harmonic function between the two.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Muscle& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  // That of full activation, as far as it is not active.
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddViscosity(const EvalContext& at, StiffnessSink& blocks) const override;
  bool has_viscosity() const override { return law_.viscosity > 0 || law_.tendon_viscosity > 0; }
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

  bool balances_at_rest() const override { return balances_; }
  absl::Status BalanceAtRest(const ConstPoints& load, const ConstPoints& normals, ModelBuilder& builder,
                             Eigen::VectorXd& pushes) override;

  void AdvanceScalars(const EvalContext& end, std::int64_t tick, double dt, ScalarState& scalars) const override;
  void SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const override;
  bool advances_scalars() const override { return hill_.active() || activation_time_ > 0; }

  // Means over muscle by area at rest: of the stretch along fibres, and of the thickness over that at rest (1/(l m), as
  // tissue is incompressible).
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

  // The constant load that balances the others at rest, 3 x the body's vertices [N]; no columns unless balanced at
  // rest.
  const Points& rest_load() const { return rest_load_; }
  // Returns the load in a posture [N], as the header says. The reference is valid as long as the force.
  const Points& LoadIn(v1::Posture posture) const;
  const std::vector<MuscleTriangle>& triangles() const { return triangles_; }

 private:
  using Layout = std::variant<MuscleLayout<float>, MuscleLayout<double>>;
  using Tensions = FibreBundles::Values;

  Muscle(std::string name, const v1::Muscle& scene, const BodyModel& body);
  double ActivationOf(const EvalContext& at, bool right) const;
  // Returns the active tension of each bundle at force-length 1 [N/m].
  Tensions ActiveTensions(const EvalContext& at) const;
  template <typename Number>
  MusclePoints<Number> PointsFor(const EvalContext& at) const;
  template <typename Number>
  void AddForceIn(const MuscleLayout<Number>& layout, const EvalContext& at, MutablePoints f) const;
  template <typename Number>
  Tensions MeanRatesIn(const MuscleLayout<Number>& layout, const EvalContext& at) const;
  Points LoadThatIsLeft(const Model& model, const RestingLoad& resting, const PrestressReport& report) const;
  void SetPosturalLoads(const Model& model);
  // Makes layout_ of triangles_.
  void LayOut();

  const MuscleLaw law_;
  const HillLaw hill_;
  const double rate_time_;                 // [s]
  const double activation_time_;           // [s]
  const double greatest_resting_tension_;  // [N/m]
  const bool balances_, single_;
  const VertexRange vertices_;  // of the body
  std::vector<MuscleTriangle> triangles_;
  FibreBundles bundles_;
  int first_activation_ = -1;  // index in State::scalars of the right side's activation; -1: it is not a state
  int first_rate_ = -1;        // index in State::scalars of the rate of the first bundle
  int origin_ = 0;             // the vertex that positions are relative to in single precision
  Layout layout_;
  Points rest_load_;  // 3 x the body's vertices [N]; no columns unless balanced at rest
  std::array<Points, kPostures.size()> postural_loads_;  // by kPostures; no columns where it equals rest_load_
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_H_
