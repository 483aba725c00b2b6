// What people's breaths have in common: the amplitudes of a breath per descent of the base, and how much people differ.
#ifndef PHRENIC_SERVER_FIT_PEOPLE_H_
#define PHRENIC_SERVER_FIT_PEOPLE_H_

#include <Eigen/Core>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/errors.h"
#include "server/fit/person.h"

namespace phrenic::fit {

// Per descent [1], one entry per amplitude of BreathAmplitudes.
struct PeopleMotion {
  Eigen::VectorXd mean, spread;  // spread: standard deviation between people
  int people = 0;
};

// One person's contribution.
struct PersonMotion {
  Eigen::MatrixXd responses;   // Person::Responses at the landmarks
  Eigen::VectorXd motion;      // of the landmarks [m], three rows a point
  Eigen::VectorXd amplitudes;  // fitted to this person alone [m]
  double descent;              // [m]
};

// Returns the amplitudes per descent that fit all people best, each person counting the same: the least squares of
// motion/descent with a ridge of 0.3 %. Requires: at least one person; equal numbers of amplitudes.
PeopleMotion Summarise(const std::vector<const PersonMotion*>& people);

// Returns the built-in numbers: of the five people of ../shared/data/motion, by `phrenic study motion --modes COUNT`
// (the field "people" of its JSON). Requires: `count` is 8 or 12.
const PeopleMotion& ShippedPeople(int count);

// The mean length of the errors that `phrenic study motion` finds when each person is predicted from the others and the
// descent, per descent [1].
inline constexpr double kErrorPerDescent = 0.25;

// The expected motion for one number.
struct Prediction {
  double descent;                // of the base [m]
  Eigen::VectorXd amplitudes;    // [m]
  Eigen::VectorXd spread;        // standard deviation between people [m]
  double volume, volume_spread;  // of the lungs' change of volume [m^3]
};
Prediction PredictFromDescent(const Person& person, const PeopleMotion& people, double descent);

// The descent at which the lungs' volume changes by `volume` [m^3]. FAILED_PRECONDITION if they do not grow with it.
absl::StatusOr<Prediction> PredictFromVolume(const Person& person, const PeopleMotion& people, double volume);

// The expected motion of points, and how much people differ there.
struct MotionBand {
  Points motion;           // 3 x n [m]
  Eigen::VectorXd spread;  // standard deviation of the motion's length and direction together [m]
};
// Requires: a prediction for this person. The numbers vary independently of each other.
MotionBand BandAt(const Person& person, const Prediction& prediction, const Points& points);
// Returns the mean motion and, as the error's mean and p95, the spread, over the regions of ErrorsByRegion.
std::vector<RegionError> BandByRegion(const Person& person, const Points& points, const MotionBand& band);

// Returns the mean downward motion [m] of the fifth of the points that lies lowest in its lung. `places`:
// Person::PlacesAt. Requires: points.
double DescentOf(const Points& places, const Points& motion);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_PEOPLE_H_
