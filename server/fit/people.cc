#include "server/fit/people.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "absl/strings/str_format.h"
#include "server/fit/sides.h"

namespace phrenic::fit {
namespace {

constexpr double kPeopleRidge = 3e-3;

// Returns the standard deviation of the people's own amplitudes per descent about `mean`.
Eigen::VectorXd SpreadOf(const std::vector<const PersonMotion*>& people, const Eigen::VectorXd& mean) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mean.size());
  for (const PersonMotion* person : people) {
    sum += (person->amplitudes / person->descent - mean).cwiseAbs2();
  }
  return (sum / std::max(1.0, static_cast<double>(people.size()) - 1)).cwiseSqrt();
}

PeopleMotion Numbers(std::initializer_list<double> mean, std::initializer_list<double> spread) {
  const auto vector = [](std::initializer_list<double> values) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size())));
  };
  return {vector(mean), vector(spread), 5};
}

}  // namespace

PeopleMotion Summarise(const std::vector<const PersonMotion*>& people) {
  const Eigen::Index size = people.front()->responses.cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (const PersonMotion* person : people) {
    const double points = static_cast<double>(person->motion.size()) / 3;
    matrix += person->responses.transpose() * person->responses / points;
    right += person->responses.transpose() * person->motion / (person->descent * points);
  }
  matrix.diagonal() *= 1 + kPeopleRidge;
  PeopleMotion motion;
  motion.mean = matrix.ldlt().solve(right);
  motion.spread = SpreadOf(people, motion.mean);
  motion.people = static_cast<int>(people.size());
  return motion;
}

const PeopleMotion& ShippedPeople(int count) {
  static const auto* const eight =
      new PeopleMotion(Numbers({1.0369, 0.9577, 1.3132, 0.431, 0.0976, -0.4848, 0.0954, 0.0095},
                               {0.2073, 0.2315, 0.388, 0.1475, 0.1286, 0.1895, 0.0751, 0.1073}));
  static const auto* const twelve = new PeopleMotion(
      Numbers({1.0967, 1.0146, 1.2824, 1.2282, 0.4775, 0.4655, -0.3975, 0.1025, -0.0193, 0.0162, -0.696, 0.205},
              {0.2687, 0.2338, 0.4709, 0.2868, 0.1871, 0.3604, 0.2023, 0.0913, 0.0888, 0.1218, 0.4666, 0.7429}));
  return count == 8 ? *eight : *twelve;
}

Prediction PredictFromDescent(const Person& person, const PeopleMotion& people, double descent) {
  Prediction prediction;
  prediction.descent = descent;
  prediction.amplitudes = descent * people.mean;
  prediction.spread = std::abs(descent) * people.spread;
  const Eigen::VectorXd volumes = person.VolumeResponses();
  prediction.volume = volumes.dot(prediction.amplitudes);
  prediction.volume_spread = volumes.cwiseProduct(prediction.spread).norm();
  return prediction;
}

absl::StatusOr<Prediction> PredictFromVolume(const Person& person, const PeopleMotion& people, double volume) {
  const double per_descent = person.VolumeResponses().dot(people.mean);  // [m^2]
  if (per_descent > 0) return PredictFromDescent(person, people, volume / per_descent);
  return absl::FailedPreconditionError(absl::StrFormat(
      "the lungs' volume changes by %.3g ml per mm of descent: give --descent instead", per_descent * 1e3));
}

MotionBand BandAt(const Person& person, const Prediction& prediction, const Points& points) {
  const Eigen::MatrixXd responses = person.Responses(points);
  MotionBand band;
  band.motion = (responses * prediction.amplitudes).reshaped(3, points.cols());
  const Eigen::VectorXd variance = responses.cwiseAbs2() * prediction.spread.cwiseAbs2();
  band.spread = variance.reshaped(3, points.cols()).colwise().sum().cwiseSqrt().transpose();
  return band;
}

std::vector<RegionError> BandByRegion(const Person& person, const Points& points, const MotionBand& band) {
  Points spread = Points::Zero(3, points.cols());
  spread.row(0) = band.spread.transpose();
  std::vector<int> all(static_cast<size_t>(points.cols()));
  std::iota(all.begin(), all.end(), 0);
  return ErrorsByRegion(person.PlacesAt(points), person.LeftOnes(points), band.motion, spread, all);
}

double DescentOf(const Points& places, const Points& motion) {
  const Eigen::VectorXd heights = places.row(2).transpose();
  const double limit = Quantile({heights.begin(), heights.end()}, 0.2);
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if (heights[i] > limit) continue;
    sum -= motion(2, i);
    ++count;
  }
  return sum / count;
}

}  // namespace phrenic::fit
