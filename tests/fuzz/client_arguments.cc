// Any text as an argument of the command line or as an address in a setting gives a value or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "client/campaign/runs.h"
#include "client/cli/scene_argument.h"
#include "client/cli/study_inputs.h"
#include "client/print/comparison.h"
#include "server/cluster/redis.h"
#include "server/schema/id.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace phrenic;  // NOLINT(google-build-using-namespace)
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto pulls = client::ReadPulls({text});
  if (pulls.ok() && pulls->size() != 1) std::abort();
  (void)client::ReadSettings({text});
  (void)client::ReadPhysique({text});
  (void)client::ReadLimits({text});
  const auto input = client::ReadUncertainInput(text);
  if (input.ok() && input->distribution_case() == v1::UncertainInput::DISTRIBUTION_NOT_SET) std::abort();
  (void)client::ReadStudiedOutput(text);
  const auto share = client::ReadShare(text);
  if (share.ok() && (share->number < 0 || share->number >= share->count)) std::abort();
  const auto redis = cluster::ParseRedisAddress(text);
  if (redis.ok() && (redis->port < 0 || redis->port > 65535)) std::abort();
  (void)schema::CheckId("id", text);
  return 0;
}
