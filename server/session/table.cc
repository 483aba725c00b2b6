#include "server/session/table.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/crypto/secret.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/mechanics/pulls.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/schema/id.h"
#include "server/schema/names.h"
#include "server/schema/schema.h"

namespace phrenic::session {
namespace {

// Each session has copies of its state, also if another account made the model. Limits of the vertices of all sessions,
// in multiples of --max-vertices.
constexpr std::int64_t kScenesOfAccount = 2, kScenesInAll = 4;

using Sessions = std::map<std::string, std::shared_ptr<Session>>;

// Checks that a session of `model` may be added for the account.
absl::Status CheckVertices(const Sessions& sessions, const Model& model, const std::string& account,
                           std::int64_t of_scene) {
  std::int64_t own = model.rest.cols(), all = own;
  for (const auto& [id, session] : sessions) {
    if (session == nullptr) continue;
    all += session->model().rest.cols();
    if (session->access()->account == account) own += session->model().rest.cols();
  }
  const bool too_many = !account.empty() && own > kScenesOfAccount * of_scene;
  if (!too_many && all <= kScenesInAll * of_scene) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrCat(
      too_many ? "your" : "all", " sessions would have ", too_many ? own : all, " vertices, and may have ",
      (too_many ? kScenesOfAccount : kScenesInAll) * of_scene,
      " together; delete one first, choose a coarser scene, or start the server with a larger --max-vertices"));
}

constexpr int kUsualPage = 100;
constexpr int kLargestPage = 1000;
constexpr double kTemporaryMinutes = 1;  // a temporary copy without viewers or calls is kept

}  // namespace

Table::Table(Models& models, const Clock& clock, const Limits& limits, store::Store* store, store::Ownership* ownership)
    : models_(models), clock_(clock), limits_(limits), store_(store), ownership_(ownership) {}

Table::~Table() { Close(absl::UnavailableError("the server is shutting down")); }

std::string Table::StemOf(const std::string& scene) const {
  const std::vector<std::string> names = models_.catalogue().Names();
  return std::find(names.begin(), names.end(), scene) == names.end() ? "session" : scene;
}

std::string Table::FreeId(const std::string& stem, const std::string& account,
                          const std::set<std::string>& elsewhere) const {
  constexpr std::size_t kDigits = 12;  // of 4 bits
  const std::string base = account.empty() ? stem : absl::StrCat(stem, "-", NewToken().substr(0, kDigits));
  return schema::FreeId(base, "session", [this, &elsewhere](const std::string& id) {
    mutex_.AssertHeld();
    return sessions_.contains(id) || lost_.contains(id) || elsewhere.contains(id);
  });
}

absl::Status Table::CheckRoom(const std::string& account) const {
  if (static_cast<int>(sessions_.size()) >= limits_.sessions) {
    return absl::ResourceExhaustedError(absl::StrCat("there are ", sessions_.size(),
                                                     " sessions, and no more are allowed; delete one first, or "
                                                     "start the server with a larger --max-sessions"));
  }
  if (account.empty()) return absl::OkStatus();
  const auto own = std::count_if(sessions_.begin(), sessions_.end(),
                                 [&account](const auto& each) {
                                   return each.second != nullptr && each.second->access()->account == account;
                                 }) +
                   std::count_if(reserved_.begin(), reserved_.end(),
                                 [&account](const auto& each) { return each.second == account; });
  if (own < limits_.sessions_of_user) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrCat(account, " has ", own,
                   " sessions, the most that an account may have; delete one first, or start "
                   "the server with a larger --max-sessions-of-user"));
}

absl::StatusOr<std::string> Table::Reserve(const char* field, const std::string& wanted, const std::string& stem,
                                           const std::string& account, const std::set<std::string>& elsewhere) {
  if (absl::Status status = schema::CheckId(field, wanted); !status.ok()) return status;
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return *closed_;
  if (sessions_.contains(wanted)) {
    return absl::AlreadyExistsError(absl::StrCat(field, ": there is a session \"", wanted, "\" already"));
  }
  if (const auto lost = lost_.find(wanted); lost != lost_.end()) {
    const bool may_know = ControlOf(lost->second).account == account;
    return absl::AlreadyExistsError(absl::StrCat(
        field, ": the store has a session \"", wanted, "\" that could not be restored",
        may_know ? absl::StrCat(" (", lost->second.problem.message(), ")") : "", "; delete it, or choose another id"));
  }
  if (absl::Status room = CheckRoom(account); !room.ok()) return room;
  const std::string id = wanted.empty() ? FreeId(stem, account, elsewhere) : wanted;
  sessions_.emplace(id, nullptr);
  reserved_.emplace(id, account);
  return id;
}

absl::StatusOr<Table::Claim> Table::ReserveEverywhere(const char* field, const std::string& wanted,
                                                      const std::string& scene, const std::string& account) {
  std::set<std::string> elsewhere;
  const std::string stem = StemOf(scene);
  for (;;) {
    auto id = Reserve(field, wanted, stem, account, elsewhere);
    if (!id.ok()) return id.status();
    if (ownership_ == nullptr) return Claim{*std::move(id)};
    const absl::StatusOr<std::int64_t> epoch = ownership_->Claim(*id);
    if (epoch.ok()) return Claim{*std::move(id), *epoch};
    {
      absl::MutexLock lock(&mutex_);
      sessions_.erase(*id);
      reserved_.erase(*id);
    }
    if (!wanted.empty() || !absl::IsAlreadyExists(epoch.status())) {
      return absl::Status(epoch.status().code(), absl::StrCat(field, ": ", epoch.status().message()));
    }
    elsewhere.insert(*id);
  }
}

absl::StatusOr<std::shared_ptr<Session>> Table::Make(const Claim& claim, const v1::CreateSessionRequest& request,
                                                     ControlBook control, const Requester& by) {
  auto compiled = models_.Compile(request.source(), by);
  if (!compiled.ok()) return compiled.status();
  const std::shared_ptr<const Model>& model = compiled->model;
  v1::Parameters parameters = model->parameters;
  const absl::StatusOr<v1::Parameters> preset = FindPreset(model->scene, request.preset());
  if (!preset.ok()) return preset.status();
  parameters.MergeFrom(*preset);
  parameters.MergeFrom(request.parameters());
  const v1::StableStep stable = StableStepOf(*model, parameters);
  const bool named =
      request.parameters().has_time_step() || preset->has_time_step() || model->scene.parameters().has_time_step();
  if (!named) parameters.set_time_step(ChosenStep(stable));
  if (absl::Status status = schema::Validate(parameters); !status.ok()) return status;
  const auto changes = FindPulls(*model, request.pulls(), "pulls");
  if (!changes.ok()) return changes.status();
  Session::Fork start{std::move(parameters), model->InitialState(), stable.seconds()};
  if (absl::Status status = ChangePulls(*changes, true, start.state.pulls); !status.ok()) return status;
  auto origin = Begin(claim, *model, std::move(compiled->surfaces), std::move(control));
  if (!origin.ok()) return origin.status();
  return std::make_shared<Session>(claim.id, model, std::move(start), clock_, limits_, *std::move(origin));
}

absl::StatusOr<std::shared_ptr<Session>> Table::MakeFork(const Claim& claim, Session& of, bool temporary,
                                                         ControlBook control) const {
  absl::StatusOr<Session::Fork> start = of.MakeFork();
  if (!start.ok()) return start.status();
  auto origin = Begin(claim, of.model(), of.surfaces(), std::move(control));
  if (!origin.ok()) return origin.status();
  origin->temporary = temporary;
  return std::make_shared<Session>(claim.id, of.shared_model(), *std::move(start), clock_, limits_, *std::move(origin));
}

absl::StatusOr<std::shared_ptr<Session>> Table::Create(const v1::CreateSessionRequest& request, ControlBook control,
                                                       const Requester& by) {
  const std::string scene = request.source().has_scene() ? request.source().scene().name() : request.source().name();
  const std::string account = control.state().account;
  return Admit("session_id", request.session_id(), scene, account,
               [&](const Claim& claim) { return Make(claim, request, std::move(control), by); });
}

absl::StatusOr<std::shared_ptr<Session>> Table::Fork(const v1::ForkSessionRequest& request, ControlBook control) {
  const absl::StatusOr<std::shared_ptr<Session>> of = Find(request.session_id());
  if (!of.ok()) return of.status();
  const std::string account = control.state().account;
  {
    absl::MutexLock lock(&mutex_);
    absl::Status room = CheckVertices(sessions_, (*of)->model(), account, limits_.vertices);
    if (!room.ok()) return room;
  }
  return Admit("fork_id", request.fork_id(), (*of)->model().scene.name(), account,
               [&](const Claim& claim) { return MakeFork(claim, **of, request.temporary(), std::move(control)); });
}

absl::StatusOr<std::shared_ptr<Session>> Table::Admit(const char* field, const std::string& wanted,
                                                      const std::string& scene, const std::string& account,
                                                      absl::FunctionRef<Maker> make) {
  const absl::StatusOr<Claim> claim = ReserveEverywhere(field, wanted, scene, account);
  if (!claim.ok()) return claim.status();
  absl::StatusOr<std::shared_ptr<Session>> session = make(*claim);
  if (session.ok()) {
    absl::Status saved;
    {
      absl::MutexLock lock(&mutex_);
      saved = CheckVertices(sessions_, (*session)->model(), account, limits_.vertices);
    }
    if (saved.ok()) saved = (*session)->Flush();
    if (saved.ok()) saved = (*session)->Acknowledge();
    if (!saved.ok()) {
      (*session)->Forget();
      session = saved;
    }
  }
  if (!session.ok() && ownership_ != nullptr) ownership_->Abandon(claim->id);
  absl::MutexLock lock(&mutex_);
  reserved_.erase(claim->id);
  if (closed_.has_value()) return *closed_;
  if (session.ok()) {
    sessions_[claim->id] = *session;
  } else {
    sessions_.erase(claim->id);
  }
  return session;
}

absl::Status Table::NoSession(const std::string& id) const {
  std::vector<std::string> ids;
  for (const auto& [other, session] : sessions_) {
    if (session != nullptr && session->access()->account.empty()) ids.push_back(other);
  }
  return absl::NotFoundError(
      absl::StrCat("session_id: there is no session \"", schema::ShortId(id), "\"", schema::ThereAre(id, ids)));
}

absl::StatusOr<std::shared_ptr<Session>> Table::Find(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const auto found = sessions_.find(id);
  if (found == sessions_.end() || found->second == nullptr) return NoSession(id);
  found->second->NoteAttention();
  return found->second;
}

Table::Page Table::List(int page_size, const std::string& after,
                        const std::function<bool(const Session& session)>& visible) const {
  const int limit = page_size <= 0 ? kUsualPage : std::min(page_size, kLargestPage);
  Page page;
  absl::MutexLock lock(&mutex_);
  for (auto next = sessions_.upper_bound(after); next != sessions_.end(); ++next) {
    if (next->second == nullptr || (visible != nullptr && !visible(*next->second))) continue;
    if (static_cast<int>(page.sessions.size()) == limit) {
      page.last = page.sessions.back()->id();
      break;
    }
    page.sessions.push_back(next->second);
  }
  return page;
}

absl::Status Table::Delete(const std::string& id, std::string_view token) { return Remove(id, token); }

absl::Status Table::DeleteAnyway(const std::string& id) { return Remove(id, std::nullopt); }

absl::Status Table::Remove(const std::string& id, std::optional<std::string_view> token) {
  {
    absl::MutexLock lock(&mutex_);
    if (lost_.contains(id)) return DeleteLost(id, token);
  }
  const absl::StatusOr<std::shared_ptr<Session>> wanted = Find(id);
  if (!wanted.ok()) return wanted.status();
  if (token.has_value()) {
    if (absl::Status status = (*wanted)->CheckControl(*token); !status.ok()) return status;
  }
  if (ownership_ != nullptr) {
    if (absl::Status status = ownership_->Delete(id); !status.ok()) return status;
  }
  std::shared_ptr<Session> session;
  {
    absl::MutexLock lock(&mutex_);
    const auto found = sessions_.find(id);
    if (found == sessions_.end() || found->second != *wanted) return NoSession(id);
    session = std::move(found->second);
    sessions_.erase(found);
  }
  session->Forget();
  session->Flush().IgnoreError();
  session->Stop(absl::NotFoundError(absl::StrCat("session ", id, " was deleted")));
  return absl::OkStatus();
}

void Table::Drop(const std::string& id) {
  std::shared_ptr<Session> session;
  {
    absl::MutexLock lock(&mutex_);
    const auto found = sessions_.find(id);
    if (found == sessions_.end() || found->second == nullptr) return;
    session = dropped_.emplace_back(std::move(found->second));
    sessions_.erase(found);
  }
  session->Forget();
  session->Stop(absl::UnavailableError(absl::StrCat("session ", id, " continues on another server; call again")));
}

void Table::Tend() {
  std::vector<std::shared_ptr<Session>> dropped, tended;
  {
    absl::MutexLock lock(&mutex_);
    dropped.swap(dropped_);
    for (const auto& [id, session] : sessions_) {
      if (session != nullptr) tended.push_back(session);
    }
  }
  const absl::Time now = clock_.Now();
  const auto over = [now](const Session& session, double minutes) {
    return minutes > 0 && now - session.attended() >= absl::Minutes(minutes);
  };
  for (const auto& session : tended) {
    const v1::Session status = session->status();
    if (status.viewers() > 0) session->NoteAttention();
    session->AnnounceNotSaved();
    const bool plays = status.state() == v1::SESSION_STATE_PLAYING && !status.keep_playing();
    if (plays && over(*session, limits_.pause_minutes)) session->Rest();
    const bool ended = status.temporary() && over(*session, kTemporaryMinutes);
    if (ended || over(*session, limits_.delete_minutes)) DeleteAnyway(session->id()).IgnoreError();
  }
}

void Table::Close(const absl::Status& reason) {
  std::map<std::string, std::shared_ptr<Session>> sessions;
  {
    absl::MutexLock lock(&mutex_);
    if (!closed_.has_value()) closed_ = reason;
    sessions.swap(sessions_);
  }
  for (const auto& [id, session] : sessions) {
    if (session != nullptr) session->Stop(reason);
  }
  // Other holders may keep a session longer than the store exists.
  for (const auto& [id, session] : sessions) {
    if (session == nullptr) continue;
    session->AwaitEnd();
    if (session->Flush().ok() && ownership_ != nullptr && session->Acknowledge().ok()) ownership_->Release(id);
  }
}

}  // namespace phrenic::session
