// Any bytes as the form of a launch, as its claims, as a setting and as a saved learner: read or refused, and a launch
// that is read leads to addresses of its platform alone.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/lti/form.h"
#include "server/lti/launch.h"
#include "server/lti/learner.h"
#include "server/lti/platform.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace lti = phrenic::lti;
  static const lti::Platform& platform = *new lti::Platform(
      *lti::ReadPlatform("issuer=https://school.example client=client-1 deployment=1 login=https://school.example/auth "
                         "token=https://school.example/token keys=https://school.example/keys"));
  const std::string text(reinterpret_cast<const char*>(data), size);
  const lti::Fields fields = lti::ReadForm(text);
  if (fields.size() > 100) std::abort();
  if (lti::HtmlText(text).find_first_of("<>\"'") != std::string::npos) std::abort();
  (void)lti::CookieOf(text, "phrenic_lti_1");
  (void)lti::ReadPlatform(text);
  if (const auto learner = lti::ReadLearner(text);
      learner.ok() && !lti::ReadLearner(lti::WriteLearner(*learner)).ok()) {
    std::abort();
  }
  const absl::Time now = absl::FromUnixSeconds(1'800'000'000);
  for (const std::string& claims : {text, lti::FieldOf(fields, "id_token")}) {
    const auto launch = lti::ReadLaunch(claims, platform, "nonce-1", "https://tool.example", now);
    if (!launch.ok()) continue;
    for (const std::string& address : {launch->line_item, launch->memberships, launch->return_url}) {
      if (!address.empty() && lti::OriginOf(address) != "https://school.example") std::abort();
    }
  }
  return 0;
}
