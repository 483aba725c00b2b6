// One kind of a person's data in a fit: the differences between the data and the model, with their derivatives.
#ifndef PHRENIC_SERVER_FIT_RESIDUALS_H_
#define PHRENIC_SERVER_FIT_RESIDUALS_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace phrenic::fit {

struct Rows {
  Eigen::VectorXd residual;  // data - model [m], [m^3], [s]
  Eigen::VectorXd weight;    // 1/variance
  Eigen::MatrixXd slope;     // derivative of the model by the fitted numbers, one row per residual
};

enum class Part { kFitting, kHeldOut };

struct KindOfData {
  std::string kind, source;  // "landmarks"; the file's name
  std::string unit;          // "mm", "l"
  double per_unit = 1e-3;    // SI per unit
  double sd = 0;             // of a datum [m], [m^3]
  int rows_per_datum = 1;    // 3 for the vectors of landmarks
};

// Immutable but for Match; not thread-safe.
class Residuals {
 public:
  explicit Residuals(KindOfData kind) : kind_(std::move(kind)) {}
  virtual ~Residuals() = default;
  const KindOfData& kind() const { return kind_; }

  // Chooses again which points of the model belong to which of the data, for data without such pairs.
  virtual void Match(const Eigen::VectorXd& /*numbers*/) {}
  // Returns the rows of a part; none if nothing is held out.
  virtual Rows At(const Eigen::VectorXd& numbers, Part part) const = 0;
  // Returns the numbers for which nothing moves.
  virtual Eigen::VectorXd Still(Eigen::VectorXd numbers, Eigen::Index amplitudes) const {
    numbers.head(amplitudes).setZero();
    return numbers;
  }
  // What to tell the person who fits.
  const std::vector<std::string>& doubts() const { return doubts_; }

 protected:
  void Doubt(std::string text) { doubts_.push_back(std::move(text)); }

 private:
  KindOfData kind_;
  std::vector<std::string> doubts_;
};

using AllResiduals = std::vector<std::unique_ptr<Residuals>>;

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_RESIDUALS_H_
