// A learner of a platform's course, and the answers that count for scores.
#ifndef PHRENIC_SERVER_LTI_LEARNER_H_
#define PHRENIC_SERVER_LTI_LEARNER_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace phrenic::lti {

// Plain data; kept in the store as JSON, without a name.
struct Learner {
  // A lesson that the learner has opened from the course.
  struct Assignment {
    std::string line_item;                  // empty: no score is sent
    std::map<int, bool> right;              // whether the last answer to each question is right, by step
    std::map<int, std::string> given = {};  // these answers; not kept in the store
  };

  std::string platform;                                // key of the platform (KeyOf)
  std::string course;                                  // deployment and course
  std::string user;                                    // "sub"
  std::string session = "";                            // in which the learner answers
  std::string respondent = "";                         // secret of SubmitAnswerRequest
  std::map<std::string, Assignment> assignments = {};  // by lesson; 100 at most
  absl::Time seen = absl::InfinitePast();              // the last launch
};

// Returns the key under which the learner is kept: no part of it can be read from it.
std::string KeyOf(const Learner& learner);

// Write and read a learner. INVALID_ARGUMENT if the text is no learner. Pure functions, thread-safe.
std::string WriteLearner(const Learner& learner);
absl::StatusOr<Learner> ReadLearner(const std::string& text);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_LEARNER_H_
