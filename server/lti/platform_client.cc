#include "server/lti/platform_client.h"

#include <algorithm>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/crypto/secret.h"
#include "server/lti/form.h"

namespace phrenic::lti {
namespace {

using access::HttpAnswer;
using access::HttpRequest;
using nlohmann::json;

constexpr char kScore[] = "https://purl.imsglobal.org/spec/lti-ags/scope/score";
constexpr char kMembers[] = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly";
constexpr int kAssertionSeconds = 300, kMostPages = 20;
constexpr std::size_t kMostMembers = 10'000, kMostMemberBytes = 200;
constexpr absl::Duration kTokenMargin = absl::Seconds(60);

std::string StringIn(const json& object, const char* name) {
  const bool has = object.is_object() && object.contains(name) && object[name].is_string();
  return has ? object[name].get<std::string>() : "";
}

// Returns the address of scores at a line item: "/scores" after its path.
std::string ScoresOf(const std::string& line_item) {
  const std::size_t query = line_item.find('?');
  const std::string path = line_item.substr(0, query);
  return query == std::string::npos ? path + "/scores" : absl::StrCat(path, "/scores", line_item.substr(query));
}

// Returns the address of the next page; empty after the last page (RFC 8288). An address may contain commas.
std::string NextOf(const std::string& link) {
  std::size_t begin = link.find('<');
  while (begin != std::string::npos) {
    const std::size_t end = link.find('>', begin);
    if (end == std::string::npos) break;
    const std::size_t next = link.find('<', end);
    const std::string rest = link.substr(end, next == std::string::npos ? next : next - end);
    if (absl::StrContains(rest, "rel=\"next\"") || absl::StrContains(rest, "rel=next")) {
      return link.substr(begin + 1, end - begin - 1);
    }
    begin = next;
  }
  return "";
}

void AddMembers(const std::string& body, MemberNames& names) {
  const json page = json::parse(body, nullptr, false);
  if (!page.is_object() || !page.contains("members") || !page["members"].is_array()) return;
  for (const json& member : page["members"]) {
    const std::string user = StringIn(member, "user_id");
    std::string name = StringIn(member, "name");
    if (name.empty()) name = absl::StrCat(StringIn(member, "given_name"), " ", StringIn(member, "family_name"));
    if (!user.empty() && name.size() > 1 && name.size() <= kMostMemberBytes && names.size() < kMostMembers) {
      names[user] = std::move(name);
    }
  }
}

}  // namespace

absl::Status StatusOfHttp(const std::string& who, long status) {
  if (status >= 200 && status < 300) return absl::OkStatus();
  const std::string text = absl::StrCat(who, " answers with HTTP status ", status);
  const bool final = status == 400 || status == 404 || status == 422;
  return final ? absl::InvalidArgumentError(text) : absl::UnavailableError(text);
}

void PlatformClient::ForgetToken(const std::string& scope) {
  absl::MutexLock lock(&mutex_);
  tokens_.erase(scope);
}

absl::StatusOr<std::string> PlatformClient::AccessToken(const std::string& scope) {
  const absl::Time now = absl::Now();
  {
    absl::MutexLock lock(&mutex_);
    const auto kept = tokens_.find(scope);
    if (kept != tokens_.end() && kept->second.expires > now) return kept->second.text;
  }
  const std::int64_t seconds = absl::ToUnixSeconds(now);
  const auto assertion = key_.Sign({{"iss", platform_.client_id},
                                    {"sub", platform_.client_id},
                                    {"aud", platform_.audience},
                                    {"iat", seconds},
                                    {"exp", seconds + kAssertionSeconds},
                                    {"jti", NewToken()}});
  if (!assertion.ok()) return assertion.status();
  const auto answer =
      exchange_({.address = platform_.token_url,
                 .headers = {"Content-Type: application/x-www-form-urlencoded", "Accept: application/json"},
                 .post = true,
                 .body = WriteForm({{"grant_type", "client_credentials"},
                                    {"client_assertion_type", "urn:ietf:params:oauth:client-assertion-type:jwt-bearer"},
                                    {"client_assertion", *assertion},
                                    {"scope", scope}})});
  if (!answer.ok()) return answer.status();
  // A wrong setting on either side can be corrected, so that no refusal of a token is final.
  if (absl::Status status = StatusOfHttp(OriginOf(platform_.token_url), answer->status); !status.ok()) {
    return absl::UnavailableError(absl::StrCat("no access token: ", status.message()));
  }
  const json granted = json::parse(answer->body, nullptr, false);
  const std::string token = StringIn(granted, "access_token");
  const auto fits = [](unsigned char c) { return c > ' ' && c < 0x7F; };
  if (token.empty() || !std::all_of(token.begin(), token.end(), fits)) {
    return absl::UnavailableError(absl::StrCat(OriginOf(platform_.token_url), " gives no access token"));
  }
  const bool timed = granted.contains("expires_in") && granted["expires_in"].is_number();
  const absl::Duration lifetime = absl::Seconds(timed ? granted["expires_in"].get<double>() : 0.0) - kTokenMargin;
  absl::MutexLock lock(&mutex_);
  tokens_[scope] = {token, now + lifetime};
  return token;
}

absl::StatusOr<HttpAnswer> PlatformClient::Call(HttpRequest request, const std::string& scope) {
  constexpr long kUnauthorized = 401;
  const std::vector<std::string> headers = request.headers;
  absl::StatusOr<HttpAnswer> answer;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto token = AccessToken(scope);
    if (!token.ok()) return token.status();
    request.headers = headers;
    request.headers.push_back("Authorization: Bearer " + *token);
    answer = exchange_(request);
    if (!answer.ok() || answer->status != kUnauthorized) break;
    ForgetToken(scope);
  }
  if (!answer.ok()) return answer;
  absl::Status status = StatusOfHttp(OriginOf(request.address), answer->status);
  return status.ok() ? answer : status;
}

absl::Status PlatformClient::SendScore(const std::string& line_item, const json& score) {
  if (absl::Status status = CheckAddress(platform_, "lineitem", line_item); !status.ok()) {
    return absl::InvalidArgumentError(status.message());
  }
  return Call({.address = ScoresOf(line_item),
               .headers = {"Content-Type: application/vnd.ims.lis.v1.score+json"},
               .post = true,
               .body = score.dump()},
              kScore)
      .status();
}

absl::StatusOr<MemberNames> PlatformClient::Members(const std::string& first, absl::Time deadline) {
  MemberNames names;
  std::string address = first;
  for (int page = 0; page < kMostPages && !address.empty(); ++page) {
    if (page > 0 && absl::Now() >= deadline) break;
    absl::Status allowed = CheckAddress(platform_, "context_memberships_url", address);
    if (!allowed.ok() && page == 0) return allowed;
    if (!allowed.ok()) break;
    const auto answer =
        Call({.address = address, .headers = {"Accept: application/vnd.ims.lti-nrps.v2.membershipcontainer+json"}},
             kMembers);
    if (!answer.ok() && page == 0) return answer.status();
    if (!answer.ok()) break;
    AddMembers(answer->body, names);
    address = NextOf(answer->link);
  }
  return names;
}

}  // namespace phrenic::lti
