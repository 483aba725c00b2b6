// Any bytes as a limits file give limits, or an error with file and line; limits of any tables and columns give
// sentences or an error on results without rows, and with rows of extreme numbers.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include "client/files/study_limits.h"
#include "phrenic/v1/campaign.pb.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto limits = phrenic::client::ParseStudyLimits("fuzz", text);
  if (!limits.ok()) {
    if (limits.status().message().substr(0, 5) != "fuzz:") std::abort();
    return 0;
  }
  phrenic::v1::CampaignResult result;
  (void)phrenic::client::ExceededLimits(*limits, result);
  for (const double number : {0.0, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    result.add_rows()->set_times_real_time(number);
    result.add_readings()->set_last(number);
  }
  const auto exceeded = phrenic::client::ExceededLimits(*limits, result);
  if (exceeded.ok() && limits->limits_size() == 0 && !exceeded->empty()) std::abort();
  return 0;
}
