// The family of forces. To add one: a file in forces/, a message in forces.proto, its case in compile/catalogue.cc, its
// line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_FORCE_H_
#define PHRENIC_SERVER_MECHANICS_FORCE_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "server/mechanics/eval_context.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/stiffness.h"

namespace phrenic {

struct ModelBuilder;

// A force on the simulated vertices: one batch of like elements, such as all springs of a body or one muscle. Several
// batches may act on the same vertices: one body may mix springs, finite elements and muscle (thesis 4.1.3). Immutable
// and thread-safe. No call allocates once its scratch memory is large enough.
//
// n is the number of simulated vertices. A force that can be evaluated for some vertices at a time may be a BlockForce
// (block_force.h).
class Force {
 public:
  virtual ~Force() = default;
  // The element's name in reports and errors, such as "springs:diaphragm".
  const std::string& name() const { return name_; }

  // Adds the force on each vertex [N] to `f` (3 x n). Never clears `f`.
  virtual void AddForce(const EvalContext& at, MutablePoints f) const = 0;
  // False if AddForce adds nothing at any time: steps leave the force out, measures read it.
  virtual bool acts_on_vertices() const { return true; }

  // Adds K = -df/dx [N/m], positive semi-definite, to `sink`. Adds nothing if the force does not depend on positions.
  virtual void AddStiffness(const EvalContext&, StiffnessSink& /*sink*/) const {}
  // Adds an upper bound of the stiffness that is inactive at this moment (surfaces that do not touch, slack cables) and
  // may become active. The largest stable step includes it.
  virtual void AddLatentStiffness(const EvalContext&, StiffnessSink& /*sink*/) const {}

  // Adds to each c_i the coefficient [N s/m] of the term -c_i v_i in the force on vertex i.
  virtual void AddDamping(const EvalContext&, Eigen::VectorXd& /*c*/) const {}
  // Adds the rest of -df/dv as terms scale g g^T [N s/m] with g of 3 x n, where the velocity of one vertex acts on
  // others.
  virtual void AddSharedDamping(const EvalContext&, OuterProducts& /*shared*/) const {}
  // True if AddSharedDamping adds terms.
  virtual bool has_shared_damping() const { return false; }

  // Adds the rest of -df/dv where the velocities of a few vertices act on each other, in 3 x 3 blocks [N s/m]:
  // symmetric, positive semi-definite, and only between vertices that AddStiffness joins at every moment.
  virtual void AddViscosity(const EvalContext&, StiffnessSink& /*blocks*/) const {}
  // True if AddViscosity adds blocks.
  virtual bool has_viscosity() const { return false; }

  // Returns the stored energy [J]; f = -dE/dx. Requires: conservative().
  virtual double Energy(const EvalContext&) const { return 0; }
  virtual bool conservative() const { return false; }

  // Adds to each vertex that rests on a surface the unit normal that points into the surface, which can push the vertex
  // the other way (3 x n).
  virtual void AddContactNormals(const EvalContext&, MutablePoints /*normals*/) const {}
  // True if BalanceAtRest is to be called.
  virtual bool balances_at_rest() const { return false; }
  // Chooses a prestress so that the forces on the vertices that move sum to zero at rest. Called once while the scene
  // is compiled, when all its forces are made. `load` is the sum of the other forces at rest [N], `normals` those of
  // all contacts (AddContactNormals), 3 x n each. Adds to `pushes` the force [N] with which a surface is to push each
  // vertex against its normal.
  virtual absl::Status BalanceAtRest(const ConstPoints& /*load*/, const ConstPoints& /*normals*/, ModelBuilder&,
                                     Eigen::VectorXd& /*pushes*/) {
    return absl::OkStatus();
  }
  // Tells a contact how hard it pushes the vertices at rest that AddContactNormals named [N], one number per vertex.
  virtual void RestOnSurface(const Eigen::VectorXd& /*pushes*/) {}

  // Advances the force's own State::scalars by a step of `dt` [s], or one part of an adaptive step, that ends at `end`.
  // `tick` counts such steps. A function of these arguments only: a run that is restored goes on bit for bit.
  virtual void AdvanceScalars(const EvalContext& /*end*/, std::int64_t /*tick*/, double /*dt*/,
                              ScalarState& /*scalars*/) const {}
  // Sets the rate [unit/s] of each scalar that AdvanceScalars integrates, for solvers that integrate it themselves:
  // AdvanceScalars over `dt` adds dt times this rate, to first order. Leaves alone scalars that change in jumps, which
  // AdvanceScalars sets at any `dt`, 0 included.
  virtual void SetScalarRates(const EvalContext&, Eigen::VectorXd& /*rates*/) const {}
  // True if AdvanceScalars changes some.
  virtual bool advances_scalars() const { return false; }

  // A number that the force computes beside its forces; a measure may read it (measures/force_output.h).
  struct Output {
    const char* name;  // "flow"
    const char* unit;  // "m^3/s"
  };
  virtual std::span<const Output> outputs() const { return {}; }
  // Returns the value of outputs()[output].
  virtual double Read(size_t /*output*/, const EvalContext&) const { return 0; }

 protected:
  explicit Force(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCE_H_
