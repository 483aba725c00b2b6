#include "server/lti/lessons.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/schema/file_bytes.h"

namespace phrenic::lti {
namespace {

constexpr std::size_t kMostLessonBytes = 1 << 20, kMostLessonName = 80;

bool IsLessonName(const std::string& name) {
  const auto allowed = [](char c) { return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '-'; };
  return !name.empty() && name.size() <= kMostLessonName && std::all_of(name.begin(), name.end(), allowed);
}

}  // namespace

absl::StatusOr<v1::Lesson> Lessons::Find(const std::string& name) const {
  const auto text =
      IsLessonName(name) ? ReadBytes(absl::StrCat(folder_, "/", name, ".json"), kMostLessonBytes) : std::nullopt;
  if (!text.has_value()) {
    return absl::NotFoundError("The lesson of this activity is not on this server: choose another one in your course.");
  }
  v1::Lesson lesson;
  if (google::protobuf::util::JsonStringToMessage(*text, &lesson).ok()) return lesson;
  return absl::InternalError(absl::StrCat("lessons/", name, ".json: cannot be parsed"));
}

std::vector<std::pair<std::string, v1::Lesson>> Lessons::List() const {
  std::vector<std::pair<std::string, v1::Lesson>> lessons;
  const auto text = ReadBytes(folder_ + "/index.json", kMostLessonBytes);
  const auto names = nlohmann::json::parse(text.value_or(""), nullptr, false);
  if (!names.is_array()) return lessons;
  for (const auto& name : names) {
    auto lesson = name.is_string() ? Find(name.get<std::string>()) : absl::NotFoundError("");
    if (lesson.ok()) lessons.emplace_back(name.get<std::string>(), *std::move(lesson));
  }
  return lessons;
}

bool IsGraded(const v1::LessonStep& step) { return step.has_question() && !step.question().has_prediction(); }

int QuestionCount(const v1::Lesson& lesson) {
  return static_cast<int>(std::count_if(lesson.steps().begin(), lesson.steps().end(), IsGraded));
}

absl::StatusOr<bool> IsRight(const v1::Lesson& lesson, const v1::SubmitAnswerRequest& answer) {
  const int step = answer.step() - 1;
  if (step < 0 || step >= lesson.steps_size() || !lesson.steps(step).has_question()) {
    return absl::NotFoundError("the step has no question");
  }
  const v1::Question& question = lesson.steps(step).question();
  if (question.has_prediction()) {
    return answer.has_number() && answer.number() >= 0 && answer.number() <= question.prediction().tolerance();
  }
  if (question.has_number()) {
    return answer.has_number() &&
           std::abs(answer.number() - question.number().value()) <= question.number().tolerance();
  }
  const auto chosen = [&](int i) {
    return std::find(answer.choices().begin(), answer.choices().end(), i) != answer.choices().end();
  };
  for (int i = 0; i < question.answers_size(); ++i) {
    if (question.answers(i).right() != chosen(i)) return false;
  }
  return true;
}

}  // namespace phrenic::lti
