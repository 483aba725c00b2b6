// Follows what learners do in lessons, and reports it: scores to their platform, statements to the store of records.
#ifndef PHRENIC_SERVER_LTI_GRADING_H_
#define PHRENIC_SERVER_LTI_GRADING_H_

#include <functional>
#include <list>
#include <map>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "phrenic/v1/answers.pb.h"
#include "server/jobs/records.h"
#include "server/lti/launch.h"
#include "server/lti/learner.h"
#include "server/lti/lessons.h"
#include "server/lti/outbox.h"
#include "server/lti/platform.h"

namespace phrenic::lti {

// Returns the key of a platform: issuer and client.
std::string KeyOf(const Platform& platform);

// Thread-safe. Keeps the 10,000 learners who launched last, also over a restart if there is a store.
//
// The score of a lesson is the number of its questions whose last answer is right, by the lesson's file on this server;
// what a page says of its own answers does not count, nor do predicted curves (IsGraded). It is sent once all other
// questions have an answer, and again at each change, and to another line item when the lesson is opened from another
// activity. Answers of the test before a lesson do not count, those of the test after it do.
class Grading {
 public:
  // All outlive it. `url` is this server's origin. Either outbox is null if nothing is reported there.
  struct Parts {
    std::string url;
    const Lessons* lessons;
    Outbox* scores;
    Outbox* statements;
  };
  Grading(Parts parts, jobs::Records records) : parts_(std::move(parts)), records_(std::move(records)) {}

  // Notes that a learner opens a lesson in a session; `course` tells courses of a platform apart. Returns the secret
  // with which the learner's page answers.
  std::string Enter(const Platform& platform, const Launch& launch, const std::string& course,
                    const std::string& session, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // Notes an answer, if it is of a learner who was launched into this session.
  void Answered(const v1::SubmitAnswerRequest& answer, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // True if the secret is of a learner who was launched into the session.
  bool Launched(const std::string& session, const std::string& respondent) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the users of a session by their secrets.
  std::map<std::string, std::string> Users(const std::string& session) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Adds a learner of an earlier server. INVALID_ARGUMENT if the text is damaged.
  absl::Status Restore(const std::string& bytes) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  bool Knows(const std::string& respondent) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Makes room for another learner.
  void DropOldest() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Save(const Learner& learner) const;
  void ReportAnswer(const Learner& learner, const v1::SubmitAnswerRequest& answer, const v1::Lesson& lesson, bool right,
                    absl::Time now) const;
  // States that a lesson all of whose graded questions have an answer is completed, and sends its score.
  void ReportScore(const Learner& learner, const std::string& name, const v1::Lesson& lesson, absl::Time now) const;
  // Sends the score of such a lesson to its line item.
  void SendScore(const Learner& learner, const std::string& name, const v1::Lesson& lesson, absl::Time now) const;

  const Parts parts_;
  const jobs::Records records_;
  mutable absl::Mutex mutex_;
  std::map<std::string, Learner> learners_ ABSL_GUARDED_BY(mutex_);           // by KeyOf
  std::map<std::string, std::string> by_respondent_ ABSL_GUARDED_BY(mutex_);  // keys of learners_
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_GRADING_H_
