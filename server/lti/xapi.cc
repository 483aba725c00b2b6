#include "server/lti/xapi.h"

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "server/crypto/secret.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

// Returns an UUID of version 4 (RFC 4122 section 4.4) of 122 random bits.
std::string NewStatementId() {
  std::string digits = NewToken();
  digits[12] = '4';
  digits[16] = "89ab"[digits[16] % 4];
  return absl::StrCat(digits.substr(0, 8), "-", digits.substr(8, 4), "-", digits.substr(12, 4), "-",
                      digits.substr(16, 4), "-", digits.substr(20));
}

const char* VerbName(Deed::Verb verb) {
  switch (verb) {
    case Deed::Verb::kLaunched:
      return "launched";
    case Deed::Verb::kAnswered:
      return "answered";
    case Deed::Verb::kCompleted:
      return "completed";
  }
  return "";
}

json ObjectOf(const Deed& deed) {
  const bool question = deed.verb == Deed::Verb::kAnswered;
  std::string id = absl::StrCat(deed.url, "/lessons/", deed.lesson);
  if (question) absl::StrAppend(&id, "#step-", deed.step);
  const std::string type = question ? "cmi.interaction" : "lesson";
  return {{"objectType", "Activity"},
          {"id", id},
          {"definition", {{"type", "http://adlnet.gov/expapi/activities/" + type}, {"name", {{"en", deed.words}}}}}};
}

}  // namespace

json StatementOf(const Deed& deed, absl::Time now) {
  const char* verb = VerbName(deed.verb);
  json statement = {
      {"id", NewStatementId()},
      {"actor", {{"objectType", "Agent"}, {"account", {{"homePage", deed.platform}, {"name", deed.user}}}}},
      {"verb", {{"id", absl::StrCat("http://adlnet.gov/expapi/verbs/", verb)}, {"display", {{"en", verb}}}}},
      {"object", ObjectOf(deed)},
      {"timestamp", absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", now, absl::UTCTimeZone())}};
  if (deed.verb == Deed::Verb::kAnswered) {
    statement["result"] = {{"success", deed.right}, {"response", deed.response}};
  }
  if (deed.verb == Deed::Verb::kCompleted && deed.most > 0) {
    statement["result"] = {{"completion", true},
                           {"score",
                            {{"scaled", static_cast<double>(deed.score) / deed.most},
                             {"raw", deed.score},
                             {"min", 0},
                             {"max", deed.most}}}};
  }
  return statement;
}

absl::Status SendStatement(const Lrs& lrs, const json& statement, const ExchangeHttp& exchange) {
  constexpr long kConflict = 409;
  const auto answer =
      exchange({.address = lrs.url + "/statements",
                .headers = {"Content-Type: application/json", "X-Experience-API-Version: 1.0.3",
                            "Authorization: Basic " + absl::Base64Escape(absl::StrCat(lrs.user, ":", lrs.password))},
                .post = true,
                .body = statement.dump()});
  if (!answer.ok()) return answer.status();
  return answer->status == kConflict ? absl::OkStatus() : StatusOfHttp(OriginOf(lrs.url), answer->status);
}

}  // namespace phrenic::lti
