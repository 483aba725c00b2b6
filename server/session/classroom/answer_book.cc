#include "server/session/classroom/answer_book.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace phrenic::session {
namespace {

constexpr std::size_t kShortestSecret = 16, kLongestSecret = 64, kLongestLesson = 80;

absl::Status CheckRespondent(const std::string& secret) {
  const auto allowed = [](char c) { return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '-'; };
  if (secret.size() >= kShortestSecret && secret.size() <= kLongestSecret &&
      std::all_of(secret.begin(), secret.end(), allowed)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat("respondent: choose a random text of ", kShortestSecret, " to ",
                                                 kLongestSecret, " characters of a-z, 0-9 and \"-\""));
}

absl::Status CheckAnswer(const v1::SubmitAnswerRequest& request) {
  if (absl::Status status = CheckRespondent(request.respondent()); !status.ok()) return status;
  if (request.lesson().empty() || request.lesson().size() > kLongestLesson) {
    return absl::InvalidArgumentError(absl::StrCat("lesson: its name has 1 to ", kLongestLesson, " bytes"));
  }
  if (request.choices().empty() == !request.has_number()) {
    return absl::InvalidArgumentError("choices: give either the chosen answers or a number");
  }
  if (request.has_number() && !std::isfinite(request.number())) {
    return absl::InvalidArgumentError("number: it must be finite");
  }
  const auto known = [](int choice) { return choice >= 0 && choice < kMostChoices; };
  if (request.choices_size() > kMostChoices ||
      !std::all_of(request.choices().begin(), request.choices().end(), known)) {
    return absl::InvalidArgumentError(
        absl::StrCat("choices: at most ", kMostChoices, " indices from 0 to ", kMostChoices - 1));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status AnswerBook::CheckRoom(const Respondent* respondent, const AnswerSource& source) const {
  if (answers_.size() >= kMostClassAnswers || (respondent == nullptr && respondents_.size() >= kMostRespondents)) {
    return absl::ResourceExhaustedError(absl::StrCat("the session keeps ", kMostClassAnswers, " answers of ",
                                                     kMostRespondents, " respondents; delete them to begin again"));
  }
  if (respondent != nullptr && respondent->answers >= kMostAnswersOfOne) {
    return absl::ResourceExhaustedError(
        absl::StrCat("respondent: the session keeps ", kMostAnswersOfOne, " answers of one; change one of these"));
  }
  const auto known = sources_.find(source.name);
  if (respondent == nullptr && known != sources_.end() && known->second >= source.most_respondents) {
    return absl::ResourceExhaustedError(
        absl::StrCat("respondent: the session keeps the answers of ", source.most_respondents,
                     " browsers of this account or address; answer in one that has answered before"));
  }
  return absl::OkStatus();
}

absl::StatusOr<int> AnswerBook::Submit(const v1::SubmitAnswerRequest& request, const AnswerSource& source) {
  if (absl::Status status = CheckAnswer(request); !status.ok()) return status;
  const absl::MutexLock lock(&mutex_);
  auto found = respondents_.find(request.respondent());
  const int number = found == respondents_.end() ? static_cast<int>(respondents_.size()) + 1 : found->second.number;
  const Key key(request.lesson(), request.step(), request.phase(), number);
  const bool is_new = !answers_.contains(key);
  if (is_new) {
    const Respondent* known = found == respondents_.end() ? nullptr : &found->second;
    if (absl::Status room = CheckRoom(known, source); !room.ok()) return room;
    if (known == nullptr) ++sources_[source.name];
  }
  Respondent& respondent = respondents_[request.respondent()];
  respondent.number = number;
  if (is_new) ++respondent.answers;
  if (!request.name().empty()) respondent.name = request.name();
  v1::ClassAnswer& answer = answers_[key];
  if (answer.attempts() == 0) answer.set_first_right(request.right());
  answer.set_respondent(number);
  answer.set_lesson(request.lesson());
  answer.set_step(request.step());
  answer.set_phase(request.phase());
  *answer.mutable_choices() = request.choices();
  answer.clear_number();
  if (request.has_number()) answer.set_number(request.number());
  answer.set_right(request.right());
  answer.set_attempts(answer.attempts() + 1);
  return answer.attempts();
}

v1::ListAnswersResponse AnswerBook::List(const std::string& lesson, bool include_names,
                                         const std::map<std::string, std::string>& known) const {
  const absl::MutexLock lock(&mutex_);
  std::vector<std::string> names(respondents_.size() + 1);  // by number
  for (const auto& [secret, respondent] : respondents_) {
    const auto told = known.find(secret);
    names[static_cast<std::size_t>(respondent.number)] = told == known.end() ? respondent.name : told->second;
  }
  v1::ListAnswersResponse response;
  response.set_respondents(static_cast<int>(respondents_.size()));
  for (const auto& [key, answer] : answers_) {
    if (!lesson.empty() && answer.lesson() != lesson) continue;
    v1::ClassAnswer& listed = *response.add_answers();
    listed = answer;
    if (include_names) listed.set_name(names[static_cast<std::size_t>(answer.respondent())]);
  }
  return response;
}

void AnswerBook::Clear() {
  const absl::MutexLock lock(&mutex_);
  respondents_.clear();
  sources_.clear();
  answers_.clear();
}

}  // namespace phrenic::session
