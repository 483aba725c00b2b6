// This server as a tool of learning platforms (LTI 1.3 core, Security Framework 1.0, Deep Linking 2.0).
#ifndef PHRENIC_SERVER_LTI_TOOL_H_
#define PHRENIC_SERVER_LTI_TOOL_H_

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "phrenic/v1/answers.pb.h"
#include "server/lti/classroom.h"
#include "server/lti/form.h"
#include "server/lti/grading.h"
#include "server/lti/http.h"
#include "server/lti/launch.h"
#include "server/lti/lessons.h"
#include "server/lti/logins.h"
#include "server/lti/outbox.h"
#include "server/lti/platform_client.h"
#include "server/lti/platform_keys.h"
#include "server/lti/tickets.h"
#include "server/lti/tool_key.h"
#include "server/store/store.h"

namespace phrenic::lti {

// Thread-safe. Two threads of its own deliver scores and statements. The server owns one if the settings name a
// platform.
//
// A launch has two steps: /lti/login (the platform's page sends the browser here; it is sent back with a state and a
// nonce, and the state is bound to the browser by a cookie) and /lti/launch (the platform's page posts a signed token).
// A teacher who chooses a lesson (deep linking) sees a page between, whose form goes to /lti/select.
class Tool {
 public:
  // What the tool is made of. `classroom` and `store` (null: nothing is kept) outlive it.
  struct Parts {
    Settings settings;
    std::unique_ptr<ToolKey> key;
    std::string lessons_folder;
    Classroom* classroom = nullptr;
    store::Store* store = nullptr;
    ExchangeHttp exchange = access::Exchange;
  };
  explicit Tool(Parts parts);
  // Calls Cancel.
  ~Tool();

  // Ends all requests to other servers, now and later. What was to be delivered stays in the store.
  void Cancel() { cancelled_ = true; }

  // Answers a request to an address below /lti/. Blocks while a platform's keys are fetched and a session is made.
  // Errors are pages in plain words, and lines of the log.
  Response Handle(const Request& request, absl::Time now);

  // Notes an answer of a learner. Reads the lesson's file, but waits for no other server.
  void Answered(const v1::SubmitAnswerRequest& answer, absl::Time now) { grading_.Answered(answer, now); }
  // True if the secret is of a learner who was launched into the session. Returns at once.
  bool Launched(const std::string& session, const std::string& respondent) const {
    return grading_.Launched(session, respondent);
  }
  // Returns the names of a session's learners by the secrets with which they answer, as the platform gives them; empty
  // if it does not. Keeps names for ten minutes. One call at a time asks the platform, and blocks for ten seconds, or
  // twenty if a request begins late; others return the names of the time before meanwhile.
  std::map<std::string, std::string> Names(const std::string& session, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);

  // Continues with what an earlier server kept. A damaged record is in `lost`.
  void Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost);

 private:
  struct Choice {
    std::size_t platform = 0;
    Launch launch;
  };
  // Where the names of a session's learners are.
  struct Course {
    std::size_t platform = 0;
    std::string memberships;
    MemberNames names;
    absl::Time read = absl::InfinitePast();
    bool reading = false;  // a call asks the platform now
  };

  Response OnLogin(const Fields& fields, absl::Time now);
  Response OnLaunch(const Fields& fields, const std::string& cookies, absl::Time now);
  Response OnSelect(const Fields& fields, absl::Time now);
  // Returns the launch of a token, and notes its platform.
  absl::StatusOr<Choice> ReadToken(const Fields& fields, const std::string& cookies, absl::Time now);
  absl::StatusOr<Response> OpenLesson(const Choice& choice, absl::Time now);
  absl::StatusOr<Response> SendChoice(const Choice& choice, const Fields& fields, absl::Time now);
  void NoteCourse(const std::string& session, std::size_t platform, const std::string& memberships)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the names of all members of the session's course by their users; asks the platform if it is time.
  MemberNames NamesOfCourse(const std::string& session, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status DeliverScore(const Parcel& parcel);
  // Returns all origins that may frame a page that belongs to no launch yet.
  std::vector<std::string> AllFramers() const;

  std::atomic<bool> cancelled_ = false;
  const Parts parts_;
  const ExchangeHttp exchange_;  // that of parts_, with cancelled_
  const Lessons lessons_;
  const jobs::Records learners_, scores_kept_, statements_kept_;
  std::vector<std::unique_ptr<PlatformKeys>> keys_;       // by platform
  std::vector<std::unique_ptr<PlatformClient>> clients_;  // by platform
  Logins logins_;
  Tickets<Choice> choices_;
  absl::Mutex mutex_;
  std::map<std::string, Course> courses_ ABSL_GUARDED_BY(mutex_);  // by session
  std::unique_ptr<Outbox> scores_, statements_;                    // statements_ null: no store of records
  Grading grading_;
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_TOOL_H_
