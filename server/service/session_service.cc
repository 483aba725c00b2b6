#include "server/service/session_service.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/measures/readings.h"
#include "server/service/calls/idempotent_call.h"
#include "server/service/calls/peer.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"
#include "server/stream/state_arrays.h"

namespace phrenic::service {
namespace {

// Sets the response's session, or returns why the change failed.
template <class Response>
absl::Status FillSession(absl::StatusOr<v1::Session> session, Response* response) {
  if (!session.ok()) return session.status();
  *response->mutable_session() = *std::move(session);
  return absl::OkStatus();
}

// Returns the bytes of the parts of the session's state.
std::size_t BytesOf(session::Session& session, const stream::StateParts& parts) {
  return stream::StateBytes(session.model(), session.publisher().layout(), parts);
}

// Sets the response's state, or returns why it cannot be read.
template <class Response>
absl::Status FillState(session::Session& session, const State& state, const stream::StateParts& parts,
                       Response* response) {
  auto arrays = stream::MakeStateArrays(session.model(), session.publisher().layout(), state, parts);
  if (!arrays.ok()) return arrays.status();
  *response->mutable_state() = *std::move(arrays);
  return absl::OkStatus();
}

// Answers to requests with an id are kept, so they must be small.
absl::Status CheckRead(const v1::StepSessionRequest& request) {
  if (!request.read().empty() && !request.request_id().empty()) {
    return absl::InvalidArgumentError(
        "read: not with request_id, because answers with an id are kept for repeats; read the state by GetState, or "
        "send expected_tick in place of request_id");
  }
  return stream::CheckParts(request.read());
}

template <class Number>
std::optional<Number> OptionalOf(bool has, Number value) {
  return has ? std::optional(value) : std::nullopt;
}

// Takes the steps of a request. Ends early when `cancelled` returns true.
template <class Request, class Cancelled>
auto TakeSteps(session::Session& session, const Request& request, Cancelled cancelled) {
  return session.Step(request.ticks(), OptionalOf(request.has_expected_tick(), request.expected_tick()), cancelled,
                      request.control_token());
}

// Changes the parameters of the request, takes its steps and fills the response.
absl::Status ChangeAndStep(ServedCall& call, session::Session& session, const v1::AdvanceRequest& request,
                           v1::AdvanceResponse* response) {
  if (request.has_parameters()) {
    auto updated = session.Update(request.parameters(), std::nullopt, std::nullopt, request.control_token());
    if (!updated.ok()) return updated.status();
    for (std::string& warning : updated->warnings) response->add_warnings(std::move(warning));
  }
  auto stepped = TakeSteps(session, request, [&] { return call.context().IsCancelled(); });
  if (!stepped.ok()) return stepped.status();
  if (request.has_parameters()) *response->mutable_session() = std::move(stepped->session);
  response->set_state_hash(std::move(stepped->state_hash));
  *response->mutable_measures() = std::move(stepped->measures);
  return FillState(session, stepped->frame->state, request.read(), response);
}

// Returns the simulated time reached by the session that this one follows; null if it follows none.
absl::StatusOr<std::shared_ptr<const session::ReachedTime>> LeaderOf(const AccessGuard& guard,
                                                                     const access::Caller& caller,
                                                                     const v1::PlaySessionRequest& request) {
  if (request.in_step_with().empty()) return nullptr;
  if (request.in_step_with() == request.session_id()) {
    return absl::InvalidArgumentError(
        "in_step_with: names the session itself; name another session, or leave it empty");
  }
  const auto leader = guard.Find(caller, request.in_step_with());
  if (leader.ok()) return (*leader)->reached();
  return absl::NotFoundError(
      absl::StrCat("in_step_with: there is no session \"", request.in_step_with(), "\"; see ListSessions"));
}

}  // namespace

void SessionService::AddTo(CallTable& calls) {
  calls.Add(Lane::kWork, *this, &SessionService::CreateSession);
  calls.Add(Lane::kQuick, *this, &SessionService::GetSession);
  calls.Add(Lane::kSession, *this, &SessionService::ForkSession);
  calls.Add(Lane::kQuick, *this, &SessionService::ListSessions);
  calls.Add(Lane::kSession, *this, &SessionService::DeleteSession);
  calls.Add(Lane::kSession, *this, &SessionService::PlaySession);
  calls.Add(Lane::kSession, *this, &SessionService::PauseSession);
  calls.Add(Lane::kSession, *this, &SessionService::StepSession);
  calls.AddConversation(Lane::kStream, *this, &SessionService::Advance);
  calls.Add(Lane::kSession, *this, &SessionService::GetState);
  calls.Add(Lane::kSession, *this, &SessionService::ResetSession);
  calls.Add(Lane::kSession, *this, &SessionService::UpdateParameters);
  calls.Add(Lane::kSession, *this, &SessionService::PullSession);
  calls.Add(Lane::kQuick, *this, &SessionService::SubmitAnswer);
  calls.Add(Lane::kSession, *this, &SessionService::ListAnswers);
  calls.Add(Lane::kSession, *this, &SessionService::DeleteAnswers);
}

template <class Request, class Response, class Make>
grpc::Status SessionService::Add(const grpc::CallbackServerContext& context, const Request& request, Response* response,
                                 Make make) {
  const auto caller = guard_.Admit(context, request);
  if (!caller.ok()) return ToGrpc(caller.status());
  auto control = session::ControlBook::Make(request.control(), request.owner_name(), caller->account.name);
  if (!control.ok()) return ToGrpc(control.status());
  response->set_control_token(control->state().owner.token);
  const auto session = make(*std::move(control), guard_.RequesterOf(*caller, context));
  if (!session.ok()) return ToGrpc(session.status());
  *response->mutable_session() = (*session)->status();
  return grpc::Status::OK;
}

template <class Request, class Response, class Act>
grpc::Status SessionService::Change(const grpc::CallbackServerContext& context, const Request& request,
                                    Response* response, Act act) {
  const auto call = AdmitToSession(guard_, table_, context, request);
  if (!call.ok()) return ToGrpc(call.status());
  return ToGrpc(RunOnce(*call->session, request, response, [&] {
    if constexpr (std::is_invocable_v<Act, session::Session&, const access::Caller&>) {
      return act(*call->session, call->caller);
    } else {
      return act(*call->session);
    }
  }));
}

grpc::Status SessionService::CreateSession(grpc::CallbackServerContext* context,
                                           const v1::CreateSessionRequest* request,
                                           v1::CreateSessionResponse* response) {
  return Add(*context, *request, response, [&](session::ControlBook control, const session::Requester& by) {
    return table_.Create(*request, std::move(control), by);
  });
}

grpc::Status SessionService::ForkSession(grpc::CallbackServerContext* context, const v1::ForkSessionRequest* request,
                                         v1::ForkSessionResponse* response) {
  return Add(*context, *request, response, [&](session::ControlBook control, const session::Requester&) {
    return table_.Fork(*request, std::move(control));
  });
}

grpc::Status SessionService::GetSession(grpc::CallbackServerContext* context, const v1::GetSessionRequest* request,
                                        v1::GetSessionResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const Model& model = call->session->model();
  *response->mutable_report() = model.report;
  *response->mutable_presets() = model.scene.presets();
  *response->mutable_scene_parameters() = model.parameters;
  *response->mutable_session() = call->session->status();
  return grpc::Status::OK;
}

grpc::Status SessionService::ListSessions(grpc::CallbackServerContext* context, const v1::ListSessionsRequest* request,
                                          v1::ListSessionsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (request->page_size() < 0 || request->page_size() > 1000) {
    return ToGrpc(
        absl::InvalidArgumentError(absl::StrCat("page_size: ", request->page_size(), " is outside 0 to 1000")));
  }
  const auto after = page_tokens_.Open(request->page_token(), caller->id());
  if (!after.ok()) return ToGrpc(after.status());
  const session::Table::Page page = table_.List(
      request->page_size(), *after, [&](const session::Session& session) { return guard_.MaySee(*caller, session); });
  for (const auto& session : page.sessions) *response->add_sessions() = session->status();
  if (!page.last.empty()) response->set_next_page_token(page_tokens_.Seal(page.last, caller->id()));
  return grpc::Status::OK;
}

grpc::Status SessionService::DeleteSession(grpc::CallbackServerContext* context,
                                           const v1::DeleteSessionRequest* request,
                                           v1::DeleteSessionResponse* /*response*/) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (guard_.Owns(*caller, request->session_id())) return ToGrpc(table_.DeleteAnyway(request->session_id()));
  return ToGrpc(table_.Delete(request->session_id(), request->control_token()));
}

grpc::Status SessionService::PlaySession(grpc::CallbackServerContext* context, const v1::PlaySessionRequest* request,
                                         v1::PlaySessionResponse* response) {
  return Change(*context, *request, response, [&](session::Session& session, const access::Caller& caller) {
    const auto leader = LeaderOf(guard_, caller, *request);
    if (!leader.ok()) return leader.status();
    const session::PlayRequest play{.speed = OptionalOf(request->has_speed(), request->speed()),
                                    .as_fast_as_possible = request->as_fast_as_possible(),
                                    .until = request->until_time(),
                                    .leader = *leader,
                                    .keep_playing = request->keep_playing()};
    return FillSession(session.Play(play, request->control_token()), response);
  });
}

grpc::Status SessionService::PauseSession(grpc::CallbackServerContext* context, const v1::PauseSessionRequest* request,
                                          v1::PauseSessionResponse* response) {
  return Change(*context, *request, response, [&](session::Session& session) {
    return FillSession(session.Pause(request->control_token()), response);
  });
}

grpc::Status SessionService::StepSession(ServedCall& call, const v1::StepSessionRequest& request,
                                         v1::StepSessionResponse* response) {
  return Change(call.context(), request, response, [&](session::Session& session) {
    if (absl::Status good = CheckRead(request); !good.ok()) return good;
    if (absl::Status reserved = call.Reserve(BytesOf(session, request.read())); !reserved.ok()) return reserved;
    const bool idempotent = !request.request_id().empty();  // a repeat expects the result
    auto stepped = TakeSteps(session, request, [&] { return !idempotent && call.context().IsCancelled(); });
    if (!stepped.ok()) return stepped.status();
    if (!request.read().empty()) {
      absl::Status read = FillState(session, stepped->frame->state, request.read(), response);
      if (!read.ok()) return read;
    }
    response->set_state_hash(std::move(stepped->state_hash));
    *response->mutable_measures() = std::move(stepped->measures);
    return FillSession(std::move(stepped->session), response);
  });
}

grpc::Status SessionService::Advance(ServedCall& call, const v1::AdvanceRequest& request,
                                     v1::AdvanceResponse* response) {
  const auto admitted = AdmitToSession(guard_, table_, call.context(), request);
  if (!admitted.ok()) return ToGrpc(admitted.status());
  session::Session& session = *admitted->session;
  if (absl::Status good = stream::CheckParts(request.read()); !good.ok()) return ToGrpc(good);
  if (absl::Status reserved = call.Reserve(BytesOf(session, request.read())); !reserved.ok()) return ToGrpc(reserved);
  const absl::Status advanced = ChangeAndStep(call, session, request, response);
  if (!MayHaveChanged(advanced)) return ToGrpc(advanced);
  const absl::Status acknowledged = session.Acknowledge();
  return ToGrpc(acknowledged.ok() ? advanced : acknowledged);
}

grpc::Status SessionService::GetState(ServedCall& call, const v1::GetStateRequest& request,
                                      v1::GetStateResponse* response) {
  const auto admitted = AdmitToSession(guard_, table_, call.context(), request);
  if (!admitted.ok()) return ToGrpc(admitted.status());
  session::Session& session = *admitted->session;
  if (absl::Status good = stream::CheckParts(request.read()); !good.ok()) return ToGrpc(good);
  if (absl::Status reserved = call.Reserve(BytesOf(session, request.read())); !reserved.ok()) return ToGrpc(reserved);
  const Model& model = session.model();
  FairShare::Hold turn;
  if (sizeof(double) * static_cast<std::size_t>(model.rest.size()) > kLargeRead) {
    auto taken = AwaitTurn(large_reads_, guard_.KeyOf(admitted->caller, call.context()));
    if (!taken.ok()) return ToGrpc(taken.status());
    if (call.context().IsCancelled()) return grpc::Status::CANCELLED;
    turn = *std::move(taken);
  }
  const auto now = session.ReadState();
  if (!now.ok()) return ToGrpc(now.status());
  response->set_state_hash(session::HashText(now->state()));
  *response->mutable_measures() = ReadMeasures(model, MakeEvalContext(model, now->parameters, now->state()));
  return ToGrpc(FillState(session, now->state(), request.read(), response));
}

grpc::Status SessionService::ResetSession(grpc::CallbackServerContext* context, const v1::ResetSessionRequest* request,
                                          v1::ResetSessionResponse* response) {
  return Change(*context, *request, response, [&](session::Session& session) {
    return FillSession(session.Reset(request->control_token()), response);
  });
}

grpc::Status SessionService::UpdateParameters(grpc::CallbackServerContext* context,
                                              const v1::UpdateParametersRequest* request,
                                              v1::UpdateParametersResponse* response) {
  return Change(*context, *request, response, [&](session::Session& session) {
    auto changes = FindPreset(session.model().scene, request->preset());
    if (!changes.ok()) return changes.status();
    changes->MergeFrom(request->parameters());
    auto updated =
        session.Update(*changes, OptionalOf(request->has_expected_revision(), request->expected_revision()),
                       OptionalOf(request->has_apply_at_tick(), request->apply_at_tick()), request->control_token());
    if (!updated.ok()) return updated.status();
    for (std::string& warning : updated->warnings) response->add_warnings(std::move(warning));
    return FillSession(std::move(updated->session), response);
  });
}

grpc::Status SessionService::PullSession(grpc::CallbackServerContext* context, const v1::PullSessionRequest* request,
                                         v1::PullSessionResponse* response) {
  return Change(*context, *request, response, [&](session::Session& session) {
    if (request->pulls().empty() && !request->release_others()) {
      return absl::InvalidArgumentError("pulls: is empty; name a pull, or set release_others to end all pulls");
    }
    return FillSession(session.Pull(request->pulls(), request->release_others(), request->control_token()), response);
  });
}

template <class Request>
absl::StatusOr<std::shared_ptr<session::Session>> SessionService::AdmitTeacher(
    const grpc::CallbackServerContext& context, const Request& request, bool alone) {
  auto call = AdmitToSession(guard_, table_, context, request);
  if (!call.ok()) return call.status();
  if (guard_.Owns(call->caller, request.session_id())) return std::move(call->session);
  absl::Status control = alone ? call->session->CheckSoleControl(request.control_token())
                               : call->session->CheckControl(request.control_token());
  if (!control.ok()) return control;
  return std::move(call->session);
}

namespace {

// Browsers of an account, and of an address: that of a school, which a class shares. A server without accounts cannot
// tell the browsers of its own machine from those behind a proxy on it.
constexpr std::size_t kMostBrowsersOfAccount = 5, kMostBrowsersOfAddress = 60;

session::AnswerSource SourceOf(const access::Caller& caller) {
  if (caller.known()) return {absl::StrCat("account ", caller.account.name), kMostBrowsersOfAccount};
  return {caller.peer, IsThisMachine(caller.peer) ? session::kMostRespondents : kMostBrowsersOfAddress};
}

}  // namespace

grpc::Status SessionService::SubmitAnswer(grpc::CallbackServerContext* context, const v1::SubmitAnswerRequest* request,
                                          v1::SubmitAnswerResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  if (!request->name().empty()) {
    if (absl::Status name = session::CheckName("name", request->name()); !name.ok()) return ToGrpc(name);
  }
  const bool launched = listener_.launched && listener_.launched(request->session_id(), request->respondent());
  const auto attempts = call->session->answer_book().Submit(
      *request, launched ? session::AnswerSource{.name = "course"} : SourceOf(call->caller));
  // A full book is no reason to lose a score.
  const bool valid = attempts.ok() || absl::IsResourceExhausted(attempts.status());
  if (valid && listener_.answered) listener_.answered(*request);
  if (!attempts.ok()) return ToGrpc(attempts.status());
  response->set_attempts(*attempts);
  return grpc::Status::OK;
}

grpc::Status SessionService::ListAnswers(grpc::CallbackServerContext* context, const v1::ListAnswersRequest* request,
                                         v1::ListAnswersResponse* response) {
  const auto session = AdmitTeacher(*context, *request, request->include_names());
  if (!session.ok()) return ToGrpc(session.status());
  std::map<std::string, std::string> known;
  if (request->include_names() && listener_.names) known = listener_.names(request->session_id());
  *response = (*session)->answer_book().List(request->lesson(), request->include_names(), known);
  return grpc::Status::OK;
}

grpc::Status SessionService::DeleteAnswers(grpc::CallbackServerContext* context,
                                           const v1::DeleteAnswersRequest* request, v1::DeleteAnswersResponse*) {
  const auto session = AdmitTeacher(*context, *request, true);
  if (!session.ok()) return ToGrpc(session.status());
  (*session)->answer_book().Clear();
  return grpc::Status::OK;
}

}  // namespace phrenic::service
