// The table's sessions in the store.
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/session/carry_over.h"
#include "server/session/saving.h"
#include "server/session/table.h"

namespace phrenic::session {

// State shared by the threads that restore sessions.
struct Table::Restoring {
  std::vector<store::SavedSession> sessions;  // each is used by the thread that took it with the mutex held
  absl::FunctionRef<void(const std::string& id)> progress;
  absl::Mutex mutex = {};
  std::size_t next = 0;                           // index of the next session to restore
  std::map<std::string, absl::Status> lost = {};  // by id
  absl::Status problem = {};                      // not OK: no further session is restored
};

absl::StatusOr<SessionOrigin> Table::Begin(const Claim& claim, const Model& model, std::vector<Uploads::Held> surfaces,
                                           ControlBook control) const {
  SessionOrigin origin{std::move(control), nullptr, std::nullopt, claim.epoch, std::move(surfaces)};
  if (store_ == nullptr) return origin;
  auto scene = SaveScene(model, origin.surfaces);
  if (!scene.ok()) return scene.status();
  origin.journal = store_->Begin(claim.id, *std::move(scene));
  return origin;
}

// A session that is carried over begins a new record, under its id.
absl::StatusOr<std::shared_ptr<store::Journal>> Table::JournalOf(const store::SavedSession& saved,
                                                                 const Compiled& compiled, const Replayed& replayed,
                                                                 bool taken) const {
  if (replayed.carried_over.empty()) return taken ? store_->Begin(saved.id, saved.scene) : store_->Continue(saved);
  auto scene = SaveScene(*compiled.model, compiled.surfaces);
  if (!scene.ok()) return scene.status();
  return store_->Begin(saved.id, *std::move(scene));
}

ControlState Table::ControlOf(const store::SavedSession& saved) const {
  const v1::SavedControl& control = (saved.later.empty() ? saved.moment : saved.later.back()).control();
  ControlState state = RestoreControl(control);
  const bool current = control.account_qualified() || account_names_ == nullptr || state.account.empty();
  if (!current) state.account = account_names_(state.account);
  return state;
}

absl::StatusOr<std::shared_ptr<Session>> Table::Restored(const store::SavedSession& saved, std::int64_t epoch,
                                                         bool taken) {
  if (!saved.problem.ok()) return saved.problem;
  auto compiled = CompileSaved(saved.scene, ControlOf(saved).account, models_);
  if (!compiled.ok()) return compiled.status();
  absl::StatusOr<Replayed> replayed =
      compiled->same ? Replay(compiled->model, saved) : CarryOver(compiled->model, saved);
  // The same scene, of which another build has other states or takes other steps.
  if (!replayed.ok() && compiled->same) replayed = CarryOver(compiled->model, saved);
  if (!replayed.ok()) return replayed.status();
  if (!replayed->carried_over.empty()) {
    replayed->moment.mutable_session()->set_carried_over(replayed->carried_over);
    absl::MutexLock lock(&mutex_);
    carried_over_[saved.id] = replayed->carried_over;
  }
  auto journal = JournalOf(saved, *compiled, *replayed, taken);
  if (!journal.ok()) return journal.status();
  const v1::Session& last = replayed->moment.session();
  Session::Fork start{SavedParameters(*compiled->model, last.parameters()), std::move(replayed->state),
                      last.largest_stable_step()};
  Session::Origin origin{ControlBook(ControlOf(saved)), *std::move(journal), replayed->moment, epoch,
                         std::move(compiled->surfaces)};
  origin.held = !taken;
  return std::make_shared<Session>(saved.id, compiled->model, std::move(start), clock_, limits_, std::move(origin));
}

absl::StatusOr<std::map<std::string, absl::Status>> Table::Restore(
    absl::FunctionRef<void(const std::string& id)> progress) {
  auto sessions = store_->Load();
  if (!sessions.ok()) return sessions.status();
  Restoring restoring{*std::move(sessions), progress};
  std::vector<std::thread> others;
  for (int i = 1; i < CompileThreads(); ++i) others.emplace_back([&] { RestoreNext(restoring); });
  RestoreNext(restoring);
  for (std::thread& other : others) other.join();
  absl::MutexLock lock(&restoring.mutex);
  if (!restoring.problem.ok()) return restoring.problem;
  ReleaseAll();
  return restoring.lost;
}

void Table::RestoreNext(Restoring& restoring) {
  for (;;) {
    store::SavedSession saved;
    {
      absl::MutexLock lock(&restoring.mutex);
      if (!restoring.problem.ok() || restoring.next == restoring.sessions.size()) return;
      saved = std::move(restoring.sessions[restoring.next++]);
      restoring.progress(saved.id);
    }
    const std::string id = saved.id;
    absl::Status lost;
    const absl::Status restored = RestoreOne(std::move(saved), lost);
    absl::MutexLock lock(&restoring.mutex);
    if (!restored.ok()) restoring.problem = restored;
    if (!lost.ok()) restoring.lost[id] = lost;
  }
}

absl::Status Table::RestoreOne(store::SavedSession saved, absl::Status& lost) {
  const absl::StatusOr<std::int64_t> epoch = Reclaim(saved);
  if (absl::IsUnavailable(epoch.status())) return epoch.status();
  if (absl::IsFailedPrecondition(epoch.status())) return absl::OkStatus();
  absl::StatusOr<std::shared_ptr<Session>> session = epoch.ok() ? Restored(saved, *epoch, false) : epoch.status();
  if (epoch.ok() && !session.ok() && ownership_ != nullptr) ownership_->Abandon(saved.id);
  absl::MutexLock lock(&mutex_);
  if (session.ok()) {
    sessions_[saved.id] = *std::move(session);
    return absl::OkStatus();
  }
  lost = saved.problem = session.status();
  std::string id = saved.id;
  lost_.emplace(std::move(id), std::move(saved));
  return absl::OkStatus();
}

void Table::ReleaseAll() const {
  std::vector<std::shared_ptr<Session>> held;
  {
    absl::MutexLock lock(&mutex_);
    for (const auto& [id, session] : sessions_) {
      if (session != nullptr) held.push_back(session);
    }
  }
  for (const auto& session : held) session->Release();
}

std::map<std::string, std::string> Table::carried_over() const {
  absl::MutexLock lock(&mutex_);
  return carried_over_;
}

absl::StatusOr<std::int64_t> Table::Reclaim(const store::SavedSession& saved) {
  const std::int64_t before = (saved.later.empty() ? saved.moment : saved.later.back()).session().epoch();
  if (ownership_ == nullptr || !saved.problem.ok()) return before;
  absl::StatusOr<std::int64_t> epoch = ownership_->Reclaim(saved);
  if (!absl::IsFailedPrecondition(epoch.status())) return epoch;
  // A session that was never the cluster's stays, although another server has a session of its id.
  if (before == 0) return absl::AlreadyExistsError(epoch.status().message());
  const auto journal = store_->Continue(saved);
  journal->Forget();
  if (absl::Status status = journal->Flush(); !status.ok()) return absl::UnavailableError(status.message());
  return epoch;
}

absl::Status Table::TakeOver(const store::SavedSession& saved, std::int64_t epoch) {
  absl::StatusOr<std::shared_ptr<Session>> session = Restored(saved, epoch, true);
  if (!session.ok()) return session.status();
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return *closed_;
  lost_.erase(saved.id);
  sessions_[saved.id] = *std::move(session);
  return absl::OkStatus();
}

// A caller who could delete the session while it ran can delete it now.
absl::Status Table::DeleteLost(const std::string& id, std::optional<std::string_view> token) {
  const auto lost = lost_.find(id);
  const store::SavedSession& saved = lost->second;
  ControlBook control(ControlOf(saved));
  if (token.has_value()) {
    if (absl::Status status = control.Check(*token, clock_.Now()); !status.ok()) return status;
  }
  const auto journal = store_->Continue(saved);
  journal->Forget();
  if (absl::Status status = journal->Flush(); !status.ok()) return status;
  lost_.erase(lost);
  return absl::OkStatus();
}

}  // namespace phrenic::session
