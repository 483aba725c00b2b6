// Any bytes as a key set give keys or an error; any bytes as a token are refused, as no key has signed them.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/access/jwt.h"
#include "tests/fuzz/scratch_file.h"

namespace {

// An EC key of RFC 7517, appendix A.1.
constexpr char kKeys[] = R"({"keys":[{"kty":"EC","crv":"P-256","x":"MKBCTNIcKUSDii11ySs3526iDZ8AiTo7Tu6KPAqv7D4",
"y":"4Etl6SRW2YiLUrN5vfvVHuhp7x8PxltmWWlbbM4IFyM","kid":"1"}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using phrenic::access::JwtKeys;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (text.find("jwks_uri") != std::string::npos) return 0;  // would be fetched
  const phrenic::fuzz::ScratchFile file(data, size),
      good(reinterpret_cast<const std::uint8_t*>(kKeys), sizeof(kKeys) - 1);
  const absl::Time now = absl::FromUnixSeconds(1'700'000'000);
  (void)JwtKeys::Read({file.path(), "issuer", "audience"});
  const auto keys = JwtKeys::Read({good.path(), "issuer", "audience"});
  if (!keys.ok() || (*keys)->Check(text, now).ok()) std::abort();
  return 0;
}
