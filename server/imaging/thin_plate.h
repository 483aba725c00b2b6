// Smoothing of values on a regular grid by a thin plate, and cubic B-splines over the result.
#ifndef PHRENIC_SERVER_IMAGING_THIN_PLATE_H_
#define PHRENIC_SERVER_IMAGING_THIN_PLATE_H_

#include <Eigen/SparseCholesky>
#include <array>

namespace phrenic::imaging {

// The nodes of the grid. `around`: the last column is beside the first.
struct PlateGrid {
  int columns = 0, rows = 0;
  bool around = false;

  int nodes() const { return columns * rows; }
  int Index(int column, int row) const { return row * columns + column; }
};

// Minimises over the nodes
//   sum w (u - observed)^2 + bending sum (Laplacian u)^2 + tension sum (difference along a column)^2
// with the five-point Laplacian (a thin plate; Wahba, Spline Models for Observational Data, 1990). Where nothing was
// observed the plate continues what is beside it, straight without tension, and constant along columns far away with
// it. Not thread-safe.
class ThinPlate {
 public:
  ThinPlate(const PlateGrid& grid, double bending, double tension = 0);

  // Returns u for one weight and one observation a node. Requires: weights are not negative.
  Eigen::VectorXd Fit(const Eigen::VectorXd& weights, const Eigen::VectorXd& observed);

 private:
  Eigen::SparseMatrix<double> stiffness_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;
};

// Returns the uniform cubic B-spline's basis at t in [0, 1].
std::array<double, 4> SplineWeights(double t);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_THIN_PLATE_H_
