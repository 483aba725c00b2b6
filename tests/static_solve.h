// Computes static equilibria by Newton's method, without an integrator.
#ifndef PHRENIC_TESTS_STATIC_SOLVE_H_
#define PHRENIC_TESTS_STATIC_SOLVE_H_

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <functional>
#include <vector>

#include "server/mechanics/model.h"
#include "server/mechanics/solve/block_matrix.h"

namespace phrenic {

// True if a coordinate (axis 0 to 2) of a vertex is fixed at its start value.
using Held = std::function<bool(int vertex, int axis)>;

// Returns the sum of all forces, 3 x n [N].
inline Points ForceOn(const Model& model, const State& state) {
  Points f = Points::Zero(3, state.x.cols());
  for (const auto& force : model.forces) force->AddForce(MakeEvalContext(model, model.parameters, state), f);
  return f;
}

// Returns the positions, 3 x n [m], at which the model's forces and `load` (3 x n [N]) balance along each row of
// `freedoms`: a displacement of all coordinates by 1 m. Starts from `start` (3 x n [m]). Fails the test if Newton's
// method does not converge in 100 iterations.
inline Points SolveStatic(const Model& model, const Points& start, const Points& load,
                          const Eigen::SparseMatrix<double>& freedoms) {
  State state = model.InitialState();
  state.x = start;
  BlockMatrix stiffness(model);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Points f = ForceOn(model, state) + load;
    stiffness.Assemble(model, MakeEvalContext(model, model.parameters, state));
    const Eigen::SparseMatrix<double> k = freedoms * stiffness.ToSparse() * freedoms.transpose();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(k);
    if (solver.info() != Eigen::Success) break;
    const Eigen::VectorXd step = freedoms.transpose() * solver.solve(freedoms * f.reshaped());
    state.x.reshaped() += step;
    if (step.cwiseAbs().maxCoeff() < 1e-13 * model.size) return state.x;
  }
  ADD_FAILURE() << "found no equilibrium";
  return state.x;
}

// Returns one row per coordinate of n vertices that is not held.
inline Eigen::SparseMatrix<double> FreedomsOf(Eigen::Index n, const Held& held) {
  std::vector<int> free;
  for (int i = 0; i < 3 * n; ++i) {
    if (!held(i / 3, i % 3)) free.push_back(i);
  }
  Eigen::SparseMatrix<double> freedoms(static_cast<Eigen::Index>(free.size()), 3 * n);
  for (size_t i = 0; i < free.size(); ++i) freedoms.insert(static_cast<Eigen::Index>(i), free[i]) = 1;
  return freedoms;
}

// The same with the coordinates that are not held.
inline Points SolveStatic(const Model& model, const Points& start, const Points& load, const Held& held) {
  return SolveStatic(model, start, load, FreedomsOf(start.cols(), held));
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_STATIC_SOLVE_H_
