// The answers of a class to the questions of lessons.
#ifndef PHRENIC_SERVER_SESSION_CLASSROOM_ANSWER_BOOK_H_
#define PHRENIC_SERVER_SESSION_CLASSROOM_ANSWER_BOOK_H_

#include <cstddef>
#include <map>
#include <string>
#include <tuple>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/answers.pb.h"

namespace phrenic::session {

// Limits of a session's book.
inline constexpr std::size_t kMostRespondents = 200;
inline constexpr std::size_t kMostClassAnswers = 4000;
inline constexpr std::size_t kMostAnswersOfOne = 200;  // of a respondent, to all questions and phases
inline constexpr int kMostChoices = 16;                // of an answer; each is an index below this

// Who sends an answer, and how much of the book is theirs at most: a respondent is only a secret of a browser, of which
// one watcher can make many.
struct AnswerSource {
  std::string name;  // an account or an address
  std::size_t most_respondents = kMostRespondents;
};

// Keeps the last answer of each respondent to each question and phase. Thread-safe. A Session owns one; it is not saved
// and ends with the session.
class AnswerBook {
 public:
  // Records an answer and returns how often its respondent has answered the question. INVALID_ARGUMENT names a field
  // that is not as answers.proto says; RESOURCE_EXHAUSTED past kMostRespondents, kMostClassAnswers, kMostAnswersOfOne,
  // or for a new respondent past those of its source. Requires: the name is empty or passes CheckName (control.h).
  absl::StatusOr<int> Submit(const v1::SubmitAnswerRequest& request, const AnswerSource& source = {})
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the answers to the lesson's questions, or all if `lesson` is empty; names only if wanted. `known` has names
  // by the secrets of respondents, which go before those that the respondents gave.
  v1::ListAnswersResponse List(const std::string& lesson, bool include_names,
                               const std::map<std::string, std::string>& known = {}) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Forgets all answers and respondents.
  void Clear() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Respondent {
    int number = 0;    // from 1, in the order of first answers
    std::string name;  // the last one that was given
    std::size_t answers = 0;
  };
  using Key = std::tuple<std::string, int, v1::AnswerPhase, int>;  // lesson, step, phase, number of the respondent

  // Returns why there is no room for a new answer of a respondent, who is null before the first one.
  absl::Status CheckRoom(const Respondent* respondent, const AnswerSource& source) const
      ABSL_SHARED_LOCKS_REQUIRED(mutex_);

  mutable absl::Mutex mutex_;
  std::map<std::string, Respondent> respondents_ ABSL_GUARDED_BY(mutex_);  // by their secret
  std::map<std::string, std::size_t> sources_ ABSL_GUARDED_BY(mutex_);     // respondents by the name of their source
  std::map<Key, v1::ClassAnswer> answers_ ABSL_GUARDED_BY(mutex_);         // without names
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CLASSROOM_ANSWER_BOOK_H_
