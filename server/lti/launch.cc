#include "server/lti/launch.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/crypto/secret.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

constexpr char kClaim[] = "https://purl.imsglobal.org/spec/lti/claim/";
constexpr char kDeepLinkingSettings[] = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings";
constexpr char kEndpoint[] = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint";
constexpr char kNamesService[] = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice";
constexpr char kScoreScope[] = "https://purl.imsglobal.org/spec/lti-ags/scope/score";
constexpr char kMembership[] = "http://purl.imsglobal.org/vocab/lis/v2/membership";
constexpr std::size_t kMostClaimBytes = 2048, kMostUserBytes = 255;
constexpr double kSkew = 60;  // [s]

absl::Status NotAccepted(const std::string& why) {
  return absl::UnauthenticatedError(absl::StrCat("The platform's message ", why, "."));
}

// Returns a text of an object; empty if it is missing, no text, or too long.
std::string TextIn(const json& object, const std::string& name) {
  if (!object.is_object()) return "";
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return "";
  auto text = found->get<std::string>();
  return text.size() > kMostClaimBytes ? "" : text;
}

// Returns a member of an object; null if it is missing.
json PartIn(const json& object, const std::string& name) {
  const auto found = object.find(name);
  return found == object.end() ? json() : *found;
}

bool ListHas(const json& list, const std::string& wanted) {
  return list.is_array() && std::find(list.begin(), list.end(), json(wanted)) != list.end();
}

absl::Status CheckAudience(const json& claims, const Platform& platform) {
  const json audience = PartIn(claims, "aud");
  const bool meant = audience.is_array() ? ListHas(audience, platform.client_id) : audience == json(platform.client_id);
  if (!meant) return NotAccepted("is for another tool (aud)");
  const bool several = audience.is_array() && audience.size() > 1;
  if (several || claims.contains("azp")) {
    if (TextIn(claims, "azp") != platform.client_id) return NotAccepted("was given to another tool (azp)");
  }
  return absl::OkStatus();
}

absl::Status CheckTime(const json& claims, absl::Time now) {
  const json expires = PartIn(claims, "exp"), issued = PartIn(claims, "iat");
  const double seconds = absl::ToDoubleSeconds(now - absl::UnixEpoch());
  if (!expires.is_number() || expires.get<double>() + kSkew <= seconds) {
    return NotAccepted("has expired (exp): open the activity again from your course");
  }
  if (!issued.is_number() || issued.get<double>() - kSkew > seconds) {
    return NotAccepted("comes from the future (iat): the clocks of the platform and of this server differ");
  }
  return absl::OkStatus();
}

absl::Status CheckIdentity(const json& claims, const Platform& platform, std::string_view nonce, absl::Time now) {
  if (TextIn(claims, "iss") != platform.issuer) return NotAccepted("comes from another platform (iss)");
  if (absl::Status status = CheckAudience(claims, platform); !status.ok()) return status;
  if (absl::Status status = CheckTime(claims, now); !status.ok()) return status;
  if (nonce.empty() || !SameToken(TextIn(claims, "nonce"), nonce)) {
    return NotAccepted("does not answer this server's request (nonce)");
  }
  if (TextIn(claims, std::string(kClaim) + "version") != "1.3.0") return NotAccepted("is not of LTI 1.3.0 (version)");
  if (!platform.deployments.contains(TextIn(claims, std::string(kClaim) + "deployment_id"))) {
    return NotAccepted("is of a deployment that the settings do not name (deployment_id); add it to --lti-platform");
  }
  return absl::OkStatus();
}

// True for a role in the course; one in the institution says nothing of this course.
bool IsTeacherRole(const json& role) {
  if (!role.is_string()) return false;
  const auto name = role.get<std::string>();
  for (const char* course : {"#Instructor", "#Administrator", "#ContentDeveloper"}) {
    if (name == absl::StrCat(kMembership, course)) return true;
  }
  return name == "Instructor" || absl::StartsWith(name, absl::StrCat(kMembership, "/Instructor#"));
}

absl::Status ReadUser(const json& claims, Launch& launch) {
  launch.user = TextIn(claims, "sub");
  const auto printable = [](unsigned char c) { return c > ' ' && c < 0x7F; };
  if (launch.user.empty() || launch.user.size() > kMostUserBytes ||
      !std::all_of(launch.user.begin(), launch.user.end(), printable)) {
    return absl::InvalidArgumentError(
        "The platform's message names no user (sub): anonymous launches are not possible.");
  }
  const json roles = PartIn(claims, std::string(kClaim) + "roles");
  launch.teaches = roles.is_array() && std::any_of(roles.begin(), roles.end(), IsTeacherRole);
  return absl::OkStatus();
}

absl::Status ReadServices(const json& claims, const Platform& platform, Launch& launch) {
  const json endpoint = PartIn(claims, kEndpoint);
  if (endpoint.is_object() && ListHas(PartIn(endpoint, "scope"), kScoreScope)) {
    launch.line_item = TextIn(endpoint, "lineitem");
  }
  launch.memberships = TextIn(PartIn(claims, kNamesService), "context_memberships_url");
  for (const auto& [claim, address] :
       {std::pair("lineitem", &launch.line_item), {"context_memberships_url", &launch.memberships}}) {
    if (address->empty()) continue;
    if (absl::Status status = CheckAddress(platform, claim, *address); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status ReadDeepLinking(const json& claims, const Platform& platform, Launch& launch) {
  const json settings = PartIn(claims, kDeepLinkingSettings);
  if (!launch.teaches) return absl::PermissionDeniedError("Only a teacher of the course can choose a lesson.");
  if (!settings.is_object() || !ListHas(PartIn(settings, "accept_types"), "ltiResourceLink")) {
    return absl::InvalidArgumentError("The platform accepts no links to lessons here (accept_types).");
  }
  launch.chooses = true;
  launch.return_url = TextIn(settings, "deep_link_return_url");
  launch.data = TextIn(settings, "data");
  return CheckAddress(platform, "deep_link_return_url", launch.return_url);
}

absl::Status ReadLesson(const json& claims, const Platform& platform, std::string_view url, Launch& launch) {
  const std::string target = TextIn(claims, std::string(kClaim) + "target_link_uri");
  if (OriginOf(target) != url) {
    return absl::PermissionDeniedError("The platform's message leads to another server (target_link_uri).");
  }
  const std::string activity = TextIn(PartIn(claims, std::string(kClaim) + "resource_link"), "id");
  if (activity.empty()) {
    return absl::InvalidArgumentError("The platform's message names no activity (resource_link).");
  }
  if (launch.course.empty()) launch.course = "activity " + activity;
  const json custom = PartIn(claims, std::string(kClaim) + "custom");
  launch.lesson = TextIn(custom, "lesson");
  launch.learners_control = TextIn(custom, "learners") == "controller";
  return ReadServices(claims, platform, launch);
}

}  // namespace

absl::StatusOr<Launch> ReadLaunch(std::string_view text, const Platform& platform, std::string_view nonce,
                                  std::string_view url, absl::Time now) {
  const json claims = json::parse(text, nullptr, false);
  if (!claims.is_object()) return NotAccepted("has no claims");
  if (absl::Status status = CheckIdentity(claims, platform, nonce, now); !status.ok()) return status;
  Launch launch;
  if (absl::Status status = ReadUser(claims, launch); !status.ok()) return status;
  launch.deployment = TextIn(claims, std::string(kClaim) + "deployment_id");
  launch.course = TextIn(PartIn(claims, std::string(kClaim) + "context"), "id");
  const std::string type = TextIn(claims, std::string(kClaim) + "message_type");
  absl::Status read;
  if (type == "LtiResourceLinkRequest") {
    read = ReadLesson(claims, platform, url, launch);
  } else if (type == "LtiDeepLinkingRequest") {
    read = ReadDeepLinking(claims, platform, launch);
  } else {
    read = absl::InvalidArgumentError("The platform asks for something that this server does not do (message_type).");
  }
  if (!read.ok()) return read;
  return launch;
}

}  // namespace phrenic::lti
