#include "server/lti/learner.h"

#include <nlohmann/json.hpp>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

absl::Status NoLearner() { return absl::InvalidArgumentError("is no learner"); }

bool ReadAssignment(const json& saved, Learner::Assignment& assignment) {
  if (!saved.is_object() || !saved.contains("line_item") || !saved["line_item"].is_string()) return false;
  assignment.line_item = saved["line_item"].get<std::string>();
  if (!saved.contains("right") || !saved["right"].is_object()) return false;
  for (const auto& [step, right] : saved["right"].items()) {
    int number = 0;
    if (!absl::SimpleAtoi(step, &number) || !right.is_boolean()) return false;
    assignment.right[number] = right.get<bool>();
  }
  return true;
}

}  // namespace

std::string KeyOf(const Learner& learner) {
  return Sha256Hex(json::array({learner.platform, learner.course, learner.user}).dump());
}

std::string WriteLearner(const Learner& learner) {
  json assignments = json::object();
  for (const auto& [lesson, assignment] : learner.assignments) {
    json right = json::object();
    for (const auto& [step, is_right] : assignment.right) right[absl::StrCat(step)] = is_right;
    assignments[lesson] = {{"line_item", assignment.line_item}, {"right", right}};
  }
  return json{
      {"platform", learner.platform}, {"course", learner.course},         {"user", learner.user},
      {"session", learner.session},   {"respondent", learner.respondent}, {"seen", absl::ToUnixSeconds(learner.seen)},
      {"assignments", assignments}}
      .dump();
}

absl::StatusOr<Learner> ReadLearner(const std::string& text) {
  const json saved = json::parse(text, nullptr, false);
  if (!saved.is_object()) return NoLearner();
  Learner learner;
  for (const auto& [name, value] : {std::pair("platform", &learner.platform),
                                    {"course", &learner.course},
                                    {"user", &learner.user},
                                    {"session", &learner.session},
                                    {"respondent", &learner.respondent}}) {
    if (!saved.contains(name) || !saved[name].is_string()) return NoLearner();
    *value = saved[name].get<std::string>();
  }
  if (!saved.contains("seen") || !saved["seen"].is_number_integer() || !saved.contains("assignments") ||
      !saved["assignments"].is_object()) {
    return NoLearner();
  }
  learner.seen = absl::FromUnixSeconds(saved["seen"].get<std::int64_t>());
  for (const auto& [lesson, assignment] : saved["assignments"].items()) {
    if (!ReadAssignment(assignment, learner.assignments[lesson])) return NoLearner();
  }
  return learner;
}

}  // namespace phrenic::lti
