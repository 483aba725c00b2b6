// Statements about what learners do (xAPI 1.0.3), for a store of learning records.
#ifndef PHRENIC_SERVER_LTI_XAPI_H_
#define PHRENIC_SERVER_LTI_XAPI_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "server/lti/platform.h"
#include "server/lti/platform_client.h"

namespace phrenic::lti {

// Who did what to a lesson. Plain data.
struct Deed {
  enum class Verb { kLaunched, kAnswered, kCompleted };
  Verb verb = Verb::kLaunched;
  std::string platform, user;  // issuer and "sub": the actor is an account, without a name
  std::string url;             // origin of this server: activities are URL/lessons/NAME and URL/lessons/NAME#step-N
  std::string lesson;
  std::string words;  // title of the lesson or the question
  int step = 0;       // of an answer
  std::string response = "";
  bool right = false;
  int score = 0, most = 0;  // of a completed lesson
};

// Returns the statement, with a new id: a repeat of the same statement is stored once. Thread-safe.
nlohmann::json StatementOf(const Deed& deed, absl::Time now);

// Sends a statement. The errors of StatusOfHttp and of `exchange`. A statement that is stored already counts as sent.
absl::Status SendStatement(const Lrs& lrs, const nlohmann::json& statement, const ExchangeHttp& exchange);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_XAPI_H_
