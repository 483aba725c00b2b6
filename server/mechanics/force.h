// The family of forces. To add one: a file in forces/, a message in forces.proto, its case in catalogue.cc, its line in
// tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_FORCE_H_
#define PHRENIC_SERVER_MECHANICS_FORCE_H_

#include <span>
#include <string>

#include "server/mechanics/eval_context.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/parallel/vertex_range.h"
#include "server/mechanics/stiffness.h"

namespace phrenic {

// A batch of like force elements: all springs of a body, one action line. Any number of batches act on the same
// vertices: that is how one body mixes springs, finite elements and muscle (thesis 4.1.3). Immutable; any number of
// threads may call. No call allocates.
class Force {
 public:
  virtual ~Force() = default;
  // "springs:diaphragm", in timings and errors.
  const std::string& name() const { return name_; }

  // f += force [N], 3 x n; never clears.
  virtual void AddForce(const EvalContext& at, MutablePoints f) const { AddForceIn({0, f.cols()}, at, f); }
  // A force that can be worked out for some vertices alone, from the positions of all and the velocities of those, says
  // so, and has this in AddForce's place, f then 3 x the range's vertices; several threads may ask at once, for
  // different ranges.
  virtual bool by_range() const { return false; }
  virtual void AddForceIn(const VertexRange&, const EvalContext&, MutablePoints /*f*/) const {}
  // Whether it then reads positions of vertices outside the range, `at.packed` apart: those are to wait for it.
  virtual bool reads_others() const { return false; }
  // f = force, whatever it held: what the first to act on it is asked.
  virtual void SetForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const {
    f.setZero();
    AddForceIn(range, at, f);
  }
  // Hands over K = -df/dx, positive semi-definite. Nothing where the force does not depend on positions.
  virtual void AddStiffness(const EvalContext&, StiffnessSink&) const {}
  // Hands over what AddStiffness may come to where nothing acts now (surfaces that do not touch, cables that are
  // slack): the largest stable step counts on it.
  virtual void AddLatentStiffness(const EvalContext&, StiffnessSink&) const {}
  // c_i += the coefficient [N s/m] of the part -c_i v_i of the force on vertex i.
  virtual void AddDamping(const EvalContext&, Eigen::VectorXd& /*c*/) const {}
  // Hands over the rest of -df/dv, scale g g^T [N s/m], where the velocity of one vertex acts on others.
  virtual void AddSharedDamping(const EvalContext&, OuterProducts&) const {}
  // [J]; force = -dE/dx where it has one, and whether it has.
  virtual double Energy(const EvalContext&) const { return 0; }
  virtual bool conservative() const { return false; }

  // What it can say about itself beside its pull: measures read it (measure.h).
  struct Output {
    const char* name;  // "flow"
    const char* unit;  // "m^3/s"
  };
  virtual std::span<const Output> outputs() const { return {}; }
  // In the order of `outputs`.
  virtual double Read(size_t /*output*/, const EvalContext&) const { return 0; }

 protected:
  explicit Force(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCE_H_
