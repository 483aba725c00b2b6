// Recordings of a breath over time: the volume of a spirogram, and the displacement of a dome in an M-mode ultrasound.
//
// A CSV with a column "time_s" (or "time", "time_ms") and one of "volume_l" ("volume", "volume_ml") or
// "displacement_mm" ("displacement", "displacement_cm"). Both grow as the lungs fill. Other columns are ignored.
#ifndef PHRENIC_SERVER_FIT_TRACES_H_
#define PHRENIC_SERVER_FIT_TRACES_H_

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::fit {

enum class Traced { kVolume, kDisplacement };

// The samples of a recording's whole breaths. A breath begins where the recording crosses its middle upwards, which is
// steep; the line through the ends of the expirations is subtracted, so that drift and changes of the end-expiratory
// level are no part of it.
struct TracedBreaths {
  Eigen::VectorXd phase;    // of each sample, 0..1 from the breath's beginning
  Eigen::VectorXd value;    // above end expiration [m^3] or [m]
  Eigen::VectorXi breath;   // of each sample: index in lengths
  Eigen::VectorXd lengths;  // of each breath [s]
  std::vector<std::string> doubts;
};

// Returns the indices of the samples that are fitted, or of those that are held out: every second breath, from the
// second on; of a single breath every second sixteenth, which tells only that the shape is smooth.
std::vector<int> SamplesOf(const TracedBreaths& breaths, bool held_out);
// The same of the breaths themselves: of a single one nothing is held out.
std::vector<int> BreathsOf(const TracedBreaths& breaths, bool held_out);

inline constexpr int kMostTraceSamples = 500'000;

// Parses a recording and finds its breaths. INVALID_ARGUMENT "name:line: problem and remedy" for what is no number,
// times that do not ascend, more than kMostTraceSamples samples, a recording without a whole breath, and breaths that
// are not those of people in these units: 0.5 to 30 s long, 0.02 to 8 l or 0.3 to 150 mm deep. Thread-safe.
absl::StatusOr<TracedBreaths> ParseTrace(Traced traced, std::string_view name, std::string_view bytes);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_TRACES_H_
