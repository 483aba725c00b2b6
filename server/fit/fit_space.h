// The numbers of a person's breath that are fitted together, each with its unit, its bounds and what is known of it
// before the person's data (the prior, a normal distribution).
#ifndef PHRENIC_SERVER_FIT_FIT_SPACE_H_
#define PHRENIC_SERVER_FIT_FIT_SPACE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "server/fit/people.h"
#include "server/mechanics/lungs/boundary_modes.h"

namespace phrenic::fit {

// In SI units, but for `unit` and `per_unit`.
struct FitNumber {
  std::string name, what;
  std::string unit;     // that it is shown in: "mm", "s", "1"
  double per_unit = 1;  // SI per unit
  double mean = 0, sd = 1;
  double low = 0, high = 0;  // bounds
};

// The descent of the lungs' lowest fifth before anything is known of a person: the five people of people.h have 7 to
// 13 mm in quiet breathing; M-mode of 210 healthy people has 16 to 18 +- 3 mm at the dome when quiet and 60 +- 12 deep
// (Boussuges et al., Chest 135, 2009). Wide enough for both.
inline constexpr double kPriorDescent = 0.012, kPriorDescentSd = 0.008;  // [m]

// Not thread-safe while numbers are added.
class FitSpace {
 public:
  // The amplitudes are the first numbers. Their prior: a descent d of kPriorDescent +- kPriorDescentSd, times the
  // people's amplitudes per descent, which vary between people by their spread times kPriorDescent.
  FitSpace(const std::vector<Amplitude>& amplitudes, const PeopleMotion& people);

  // Adds a number that is independent of the others, and returns its index.
  int Add(FitNumber number);
  // Returns the index of the number, or -1.
  int Find(const std::string& name) const;

  const std::vector<FitNumber>& numbers() const { return numbers_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(numbers_.size()); }
  Eigen::Index amplitudes() const { return covariance_.rows(); }
  Eigen::VectorXd Mean() const;
  // Of the prior.
  Eigen::MatrixXd Covariance() const;
  Eigen::MatrixXd Precision() const;
  // Returns the point with each number moved to its nearest bound.
  Eigen::VectorXd Bounded(Eigen::VectorXd numbers) const;

 private:
  std::vector<FitNumber> numbers_;
  Eigen::MatrixXd covariance_;  // of the amplitudes
};

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_FIT_SPACE_H_
