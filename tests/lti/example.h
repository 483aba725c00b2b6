// A platform, and the claims of its launches.
#ifndef PHRENIC_TESTS_LTI_EXAMPLE_H_
#define PHRENIC_TESTS_LTI_EXAMPLE_H_

#include <nlohmann/json.hpp>

#include "absl/time/time.h"
#include "server/lti/platform.h"

namespace phrenic::lti {

inline constexpr char kExampleUrl[] = "https://tool.example", kExampleNonce[] = "nonce-1";
inline constexpr char kExampleEndpoint[] = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint";
inline constexpr char kExampleDeepLinking[] = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings";
inline const absl::Time kExampleNow = absl::FromUnixSeconds(1'800'000'000);
inline constexpr char kExamplePlatform[] =
    "issuer=https://school.example client=client-1 deployment=1 login=https://school.example/auth "
    "token=https://school.example/token keys=https://school.example/keys";

inline Platform ExamplePlatform() { return *ReadPlatform(kExamplePlatform); }

inline nlohmann::json ExampleClaims() {
  const std::string lti = "https://purl.imsglobal.org/spec/lti/claim/";
  nlohmann::json claims = {{"iss", "https://school.example"},
                           {"aud", "client-1"},
                           {"sub", "user-7"},
                           {"exp", 1'800'000'600},
                           {"iat", 1'800'000'000},
                           {"nonce", kExampleNonce}};
  claims[lti + "version"] = "1.3.0";
  claims[lti + "deployment_id"] = "1";
  claims[lti + "message_type"] = "LtiResourceLinkRequest";
  claims[lti + "target_link_uri"] = "https://tool.example/lti/launch";
  claims[lti + "resource_link"] = {{"id", "link-1"}};
  claims[lti + "context"] = {{"id", "course-1"}};
  claims[lti + "roles"] = {"http://purl.imsglobal.org/vocab/lis/v2/membership#Learner"};
  claims[lti + "custom"] = {{"lesson", "paralysis"}};
  claims[kExampleEndpoint] = {{"scope", {"https://purl.imsglobal.org/spec/lti-ags/scope/score"}},
                              {"lineitem", "https://school.example/items/3?type=1"}};
  claims["https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice"] = {
      {"context_memberships_url", "https://school.example/members"}, {"service_versions", {"2.0"}}};
  return claims;
}

inline nlohmann::json ExampleChoiceClaims() {
  nlohmann::json claims = ExampleClaims();
  claims["https://purl.imsglobal.org/spec/lti/claim/message_type"] = "LtiDeepLinkingRequest";
  claims["https://purl.imsglobal.org/spec/lti/claim/roles"] = {
      "http://purl.imsglobal.org/vocab/lis/v2/membership#Instructor"};
  claims[kExampleDeepLinking] = {{"deep_link_return_url", "https://school.example/return"},
                                 {"accept_types", {"ltiResourceLink"}},
                                 {"data", "kept"}};
  return claims;
}

}  // namespace phrenic::lti

#endif  // PHRENIC_TESTS_LTI_EXAMPLE_H_
