#include "server/lti/grading.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/lti/xapi.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLearners = 10'000, kMostAssignments = 100;

std::string ResponseOf(const v1::SubmitAnswerRequest& answer) {
  return answer.has_number() ? absl::StrCat(answer.number()) : absl::StrJoin(answer.choices(), "[,]");
}

std::string IssuerOf(const Learner& learner) { return learner.platform.substr(0, learner.platform.find(' ')); }

// Returns the number of right answers to the lesson's graded questions; nothing while one has no answer, or if it has
// none. An answer to a step that is no question any more does not count.
std::optional<int> ScoreOf(const Learner::Assignment& assignment, const v1::Lesson& lesson) {
  int score = 0;
  for (int step = 1; step <= lesson.steps_size(); ++step) {
    if (!IsGraded(lesson.steps(step - 1))) continue;
    const auto answer = assignment.right.find(step);
    if (answer == assignment.right.end()) return std::nullopt;
    if (answer->second) ++score;
  }
  return QuestionCount(lesson) == 0 ? std::nullopt : std::optional(score);
}

void AddStatement(Outbox* statements, const Deed& deed, absl::Time now) {
  if (statements == nullptr) return;
  json statement = StatementOf(deed, now);
  std::string id = statement["id"].get<std::string>();
  statements->Add({.id = std::move(id), .receiver = "", .address = "", .content = std::move(statement)}, now);
}

}  // namespace

std::string KeyOf(const Platform& platform) { return absl::StrCat(platform.issuer, " ", platform.client_id); }

void Grading::Save(const Learner& learner) const { records_.Put(KeyOf(learner), WriteLearner(learner)); }

void Grading::DropOldest() {
  const auto oldest = std::min_element(learners_.begin(), learners_.end(),
                                       [](const auto& a, const auto& b) { return a.second.seen < b.second.seen; });
  records_.Remove(oldest->first);
  by_respondent_.erase(oldest->second.respondent);
  learners_.erase(oldest);
}

std::string Grading::Enter(const Platform& platform, const Launch& launch, const std::string& course,
                           const std::string& session, absl::Time now) {
  Learner one{.platform = KeyOf(platform), .course = course, .user = launch.user};
  const std::string key = KeyOf(one);
  const auto lesson = parts_.lessons->Find(launch.lesson);
  const std::string title = lesson.ok() ? lesson->title() : launch.lesson;
  Deed deed{Deed::Verb::kLaunched, platform.issuer, launch.user, parts_.url, launch.lesson, title};
  std::string respondent;
  {
    absl::MutexLock lock(&mutex_);
    if (!learners_.contains(key) && learners_.size() >= kMostLearners) DropOldest();
    Learner& learner = learners_.try_emplace(key, one).first->second;
    if (learner.respondent.empty()) learner.respondent = NewToken();
    by_respondent_[learner.respondent] = key;
    learner.session = session;
    learner.seen = now;
    const bool known = learner.assignments.contains(launch.lesson);
    if (!launch.lesson.empty() && (known || learner.assignments.size() < kMostAssignments)) {
      std::string& line_item = learner.assignments[launch.lesson].line_item;
      const bool moved = line_item != launch.line_item;
      line_item = launch.line_item;
      if (moved && lesson.ok()) SendScore(learner, launch.lesson, *lesson, now);
    }
    Save(learner);
    respondent = learner.respondent;
  }
  if (!launch.lesson.empty()) AddStatement(parts_.statements, deed, now);
  return respondent;
}

void Grading::ReportAnswer(const Learner& learner, const v1::SubmitAnswerRequest& answer, const v1::Lesson& lesson,
                           bool right, absl::Time now) const {
  Deed deed{Deed::Verb::kAnswered, IssuerOf(learner),
            learner.user,          parts_.url,
            answer.lesson(),       lesson.steps(answer.step() - 1).question().words()};
  deed.step = answer.step();
  deed.response = ResponseOf(answer);
  deed.right = right;
  AddStatement(parts_.statements, deed, now);
}

void Grading::ReportScore(const Learner& learner, const std::string& name, const v1::Lesson& lesson,
                          absl::Time now) const {
  const auto score = ScoreOf(learner.assignments.at(name), lesson);
  if (!score.has_value()) return;
  Deed deed{Deed::Verb::kCompleted, IssuerOf(learner), learner.user, parts_.url, name, lesson.title()};
  deed.score = *score;
  deed.most = QuestionCount(lesson);
  AddStatement(parts_.statements, deed, now);
  SendScore(learner, name, lesson, now);
}

void Grading::SendScore(const Learner& learner, const std::string& name, const v1::Lesson& lesson,
                        absl::Time now) const {
  const Learner::Assignment& assignment = learner.assignments.at(name);
  const auto score = ScoreOf(assignment, lesson);
  if (!score.has_value() || assignment.line_item.empty() || parts_.scores == nullptr) return;
  json content = {{"userId", learner.user},
                  {"scoreGiven", *score},
                  {"scoreMaximum", QuestionCount(lesson)},
                  {"activityProgress", "Completed"},
                  {"gradingProgress", "FullyGraded"},
                  {"timestamp", absl::FormatTime("%Y-%m-%dT%H:%M:%E6SZ", now, absl::UTCTimeZone())}};
  parts_.scores->Add({.id = Sha256Hex(absl::StrCat(KeyOf(learner), " ", name, " ", assignment.line_item)),
                      .receiver = learner.platform,
                      .address = assignment.line_item,
                      .content = std::move(content)},
                     now);
}

bool Grading::Knows(const std::string& respondent) const {
  absl::MutexLock lock(&mutex_);
  return by_respondent_.contains(respondent);
}

bool Grading::Launched(const std::string& session, const std::string& respondent) const {
  absl::MutexLock lock(&mutex_);
  const auto key = by_respondent_.find(respondent);
  return key != by_respondent_.end() && learners_.at(key->second).session == session;
}

void Grading::Answered(const v1::SubmitAnswerRequest& answer, absl::Time now) {
  if (answer.phase() == v1::ANSWER_PHASE_BEFORE || !Knows(answer.respondent())) return;
  const auto lesson = parts_.lessons->Find(answer.lesson());
  if (!lesson.ok()) return;
  const auto right = IsRight(*lesson, answer);
  if (!right.ok()) return;
  absl::MutexLock lock(&mutex_);
  const auto key = by_respondent_.find(answer.respondent());
  if (key == by_respondent_.end()) return;
  Learner& learner = learners_.at(key->second);
  const auto assignment = learner.assignments.find(answer.lesson());
  if (learner.session != answer.session_id() || assignment == learner.assignments.end()) return;
  std::string& given = assignment->second.given[answer.step()];
  const auto before = assignment->second.right.find(answer.step());
  const bool same = before != assignment->second.right.end() && before->second == *right;
  if (same && given == ResponseOf(answer)) return;
  given = ResponseOf(answer);
  ReportAnswer(learner, answer, *lesson, *right, now);
  if (same) return;
  assignment->second.right[answer.step()] = *right;
  Save(learner);
  if (IsGraded(lesson->steps(answer.step() - 1))) ReportScore(learner, answer.lesson(), *lesson, now);
}

std::map<std::string, std::string> Grading::Users(const std::string& session) const {
  std::map<std::string, std::string> users;
  absl::MutexLock lock(&mutex_);
  for (const auto& [key, learner] : learners_) {
    if (learner.session == session) users[learner.respondent] = learner.user;
  }
  return users;
}

absl::Status Grading::Restore(const std::string& bytes) {
  auto learner = ReadLearner(bytes);
  if (!learner.ok()) return learner.status();
  absl::MutexLock lock(&mutex_);
  if (learners_.size() >= kMostLearners) return absl::OkStatus();
  const std::string key = KeyOf(*learner);
  by_respondent_[learner->respondent] = key;
  learners_[key] = *std::move(learner);
  return absl::OkStatus();
}

}  // namespace phrenic::lti
