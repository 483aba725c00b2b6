// v1.SessionService: creates sessions, lists them and changes their state.
#ifndef PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "phrenic/v1/session.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/page_tokens.h"
#include "server/service/calls/turn.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
//
// session::Table owns the sessions, and the stepping thread of each makes its changes, one at a time; the service has
// no state and no lock. A change returns when it is saved and, in a cluster, copied (RunOnce). It needs the control
// token of a caller that may change the session, else PERMISSION_DENIED.
//
// ABORTED: the session was not at the expected tick or revision. UNAVAILABLE: the server is shutting down, or cannot
// know whether another server has the session; a repeat with the same request_id takes effect once at most.
class SessionService final {
 public:
  // All outlive the service.
  SessionService(session::Table& table, AccessGuard& guard, const PageTokens& page_tokens)
      : table_(table), guard_(guard), page_tokens_(page_tokens) {}

  // What hears of answers and knows those who answer. All are thread-safe; null: nothing does.
  struct Listener {
    // Hears of each valid answer, also of those for which the session's book has no room. May read a lesson's file.
    std::function<void(const v1::SubmitAnswerRequest& answer)> answered;
    // True if the secret is of a learner whom a platform sent into the session: a class behind one address is not
    // limited as other visitors of that address are. Returns at once.
    std::function<bool(const std::string& session, const std::string& respondent)> launched;
    // Returns names by the secrets of respondents; may block for some seconds.
    std::function<std::map<std::string, std::string>(const std::string& session)> names;
  };
  // Call it before the first call is served.
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kWork, for as long as the compile takes; ends early with CANCELLED if the caller disconnects. The response
  // alone has the owner's control token. RESOURCE_EXHAUSTED above the limits of sessions or of a scene's size.
  grpc::Status CreateSession(grpc::CallbackServerContext* context, const v1::CreateSessionRequest* request,
                             v1::CreateSessionResponse* response);
  // On Lane::kQuick. Does not wait for a step.
  grpc::Status GetSession(grpc::CallbackServerContext* context, const v1::GetSessionRequest* request,
                          v1::GetSessionResponse* response);
  // On Lane::kSession. Copies the state between two steps. FAILED_PRECONDITION if the session has diverged.
  grpc::Status ForkSession(grpc::CallbackServerContext* context, const v1::ForkSessionRequest* request,
                           v1::ForkSessionResponse* response);
  // On Lane::kQuick. Sorted by id; 100 a page by default, 1000 at most. INVALID_ARGUMENT for another page size, and for
  // a token that PageTokens::Open refuses.
  grpc::Status ListSessions(grpc::CallbackServerContext* context, const v1::ListSessionsRequest* request,
                            v1::ListSessionsResponse* response);
  // On Lane::kSession. The owner's account and administrators need no control token. Streams end with NOT_FOUND.
  grpc::Status DeleteSession(grpc::CallbackServerContext* context, const v1::DeleteSessionRequest* request,
                             v1::DeleteSessionResponse* response);
  // On Lane::kSession, as all below but Advance. NOT_FOUND also for a leader (in_step_with) that the caller may not
  // see.
  grpc::Status PlaySession(grpc::CallbackServerContext* context, const v1::PlaySessionRequest* request,
                           v1::PlaySessionResponse* response);
  // Takes effect after the step in progress. A StepSession in progress then ends with ABORTED.
  grpc::Status PauseSession(grpc::CallbackServerContext* context, const v1::PauseSessionRequest* request,
                            v1::PauseSessionResponse* response);
  // Returns after the last step. Ends early with CANCELLED if the caller disconnects, unless the request has a
  // request_id: a repeat then gets the result.
  grpc::Status StepSession(ServedCall& call, const v1::StepSessionRequest& request, v1::StepSessionResponse* response);
  // On Lane::kStream, since a client that does not read blocks its thread. Answers one request of the stream; the next
  // is read after it. A change is acknowledged as StepSession's.
  grpc::Status Advance(ServedCall& call, const v1::AdvanceRequest& request, v1::AdvanceResponse* response);
  // Waits at most for the current step, and leaves the stepping thread no work. RESOURCE_EXHAUSTED, here and above,
  // before the parts of a state are copied that the caller leaves unread (CallLimits::replies).
  grpc::Status GetState(ServedCall& call, const v1::GetStateRequest& request, v1::GetStateResponse* response);
  // Discards updates that wait for a tick. A StepSession in progress ends with ABORTED.
  grpc::Status ResetSession(grpc::CallbackServerContext* context, const v1::ResetSessionRequest* request,
                            v1::ResetSessionResponse* response);
  // Sets the fields of the preset, then those of the request, in one change. The warnings do not stop it.
  grpc::Status UpdateParameters(grpc::CallbackServerContext* context, const v1::UpdateParametersRequest* request,
                                v1::UpdateParametersResponse* response);
  // INVALID_ARGUMENT without a pull and without release_others.
  grpc::Status PullSession(grpc::CallbackServerContext* context, const v1::PullSessionRequest* request,
                           v1::PullSessionResponse* response);
  // On Lane::kQuick. Needs no control: a class answers while its teacher controls.
  grpc::Status SubmitAnswer(grpc::CallbackServerContext* context, const v1::SubmitAnswerRequest* request,
                            v1::SubmitAnswerResponse* response);
  grpc::Status ListAnswers(grpc::CallbackServerContext* context, const v1::ListAnswersRequest* request,
                           v1::ListAnswersResponse* response);
  grpc::Status DeleteAnswers(grpc::CallbackServerContext* context, const v1::DeleteAnswersRequest* request,
                             v1::DeleteAnswersResponse* response);

 private:
  // Admits the call, has `make` add a session with its ControlBook to the table, and returns the session's status. The
  // caller's account, if there is one, owns the new session. Not idempotent: a repeat without an id makes another
  // session.
  template <class Request, class Response, class Make>
  grpc::Status Add(const grpc::CallbackServerContext& context, const Request& request, Response* response, Make make);
  // Admits the call and applies `act` to its session, once per request_id. `act` gets the session, and the caller if it
  // wants it, runs on the lane's thread and returns the status. The errors of AdmitToSession, of RunOnce and of `act`.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::CallbackServerContext& context, const Request& request, Response* response, Act act);

  // Admits a call that is for the teacher: the account that owns the session, or who controls it; if `alone`, who alone
  // controls it.
  template <class Request>
  absl::StatusOr<std::shared_ptr<session::Session>> AdmitTeacher(const grpc::CallbackServerContext& context,
                                                                 const Request& request, bool alone);

  session::Table& table_;
  AccessGuard& guard_;
  const PageTokens& page_tokens_;
  Listener listener_;                    // constant while calls are served
  FairShare large_reads_{LargeReads()};  // of GetState
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
