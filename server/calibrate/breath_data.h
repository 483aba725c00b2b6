// A person's data against a simulated breath: recordings, markers on the chest, and what a fit of the lungs' motion has
// read off landmarks and surfaces.
#ifndef PHRENIC_SERVER_CALIBRATE_BREATH_DATA_H_
#define PHRENIC_SERVER_CALIBRATE_BREATH_DATA_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/calibrate/target.h"
#include "server/fit/evidence.h"

namespace phrenic::calibrate {

// One kind of data. Numbers of its own, such as the offset of a recording, are fitted with the parameters of the
// simulation. Immutable, thread-safe.
class BreathData {
 public:
  struct OwnNumber {
    std::string name, unit;
    double per_unit, sd;  // its prior is 0 +- sd [SI]
  };

  explicit BreathData(fit::KindOfData kind) : kind_(std::move(kind)) {}
  virtual ~BreathData() = default;
  const fit::KindOfData& kind() const { return kind_; }

  virtual std::vector<OwnNumber> OwnNumbers() const { return {}; }
  // The measured values of a part [SI], and one over the variance of each.
  virtual Eigen::VectorXd Values(fit::Part part) const = 0;
  virtual Eigen::VectorXd Weights(fit::Part part) const = 0;
  // What the breath leads to expect of them; `slopes`, if given, becomes its derivative by the own numbers. NaN for
  // what the breath does not have.
  virtual Eigen::VectorXd Predict(const physiology::Recording& breath, const Eigen::VectorXd& own, fit::Part part,
                                  Eigen::MatrixXd* slopes) const = 0;
  // What nothing that moves leads to expect.
  virtual Eigen::VectorXd Still(fit::Part part) const { return Eigen::VectorXd::Zero(Values(part).size()); }
  const std::vector<std::string>& doubts() const { return doubts_; }

 protected:
  void Doubt(std::string text) { doubts_.push_back(std::move(text)); }

 private:
  fit::KindOfData kind_;
  std::vector<std::string> doubts_;
};

using AllBreathData = std::vector<std::unique_ptr<BreathData>>;

// A recording against the lungs' volume or the descent of a dome's apex, aligned where both cross their middle upwards,
// but for a shift (0 +- 0.03 of a breath) and an offset (0 +- 0.02 l or 1 mm). Every second breath is held out.
std::unique_ptr<BreathData> TraceData(const fit::Evidence::TraceFile& file);

// A measure with its standard error, in the target's unit. Nothing is held out.
struct KnownMeasure {
  const Target* target;
  double value, error;
  std::string source;
};
std::unique_ptr<BreathData> MeasureData(const KnownMeasure& known);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_BREATH_DATA_H_
