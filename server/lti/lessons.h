// The shipped lessons, as the viewer's files have them, and the right answers to their questions.
#ifndef PHRENIC_SERVER_LTI_LESSONS_H_
#define PHRENIC_SERVER_LTI_LESSONS_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/answers.pb.h"
#include "phrenic/v1/lesson.pb.h"

namespace phrenic::lti {

// Thread-safe. Reads the files at each call, so that a viewer built meanwhile is used.
class Lessons {
 public:
  // `folder` has index.json and NAME.json.
  explicit Lessons(std::string folder) : folder_(std::move(folder)) {}

  // Returns a lesson. NOT_FOUND if no lesson has this name; INTERNAL if its file cannot be parsed.
  absl::StatusOr<v1::Lesson> Find(const std::string& name) const;
  // Returns all lessons by name, in the order in which they are taught. Leaves out those that cannot be read.
  std::vector<std::pair<std::string, v1::Lesson>> List() const;

 private:
  const std::string folder_;
};

// True if the step has a question whose answer counts towards the score. A prediction's does not: it needs control of
// the session, which learners may not have.
bool IsGraded(const v1::LessonStep& step);

// Returns the number of such questions of a lesson, its highest score.
int QuestionCount(const v1::Lesson& lesson);

// True if the answer is right by the lesson's question of its step. NOT_FOUND if the step has no question.
absl::StatusOr<bool> IsRight(const v1::Lesson& lesson, const v1::SubmitAnswerRequest& answer);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_LESSONS_H_
