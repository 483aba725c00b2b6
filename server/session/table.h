// The sessions of a server, by id.
#ifndef PHRENIC_SERVER_SESSION_TABLE_H_
#define PHRENIC_SERVER_SESSION_TABLE_H_

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/session/limits.h"
#include "server/session/models.h"
#include "server/session/session.h"
#include "server/store/store.h"

namespace phrenic::session {

struct Compiled;
struct Replayed;

// Creates, finds, restores and deletes sessions. Thread-safe. The server owns one (service/server.cc). Sessions are
// shared with their callers and may outlive their entry. mutex_ guards the maps; it is not held while a scene compiles
// or a stepping thread ends.
class Table {
 public:
  struct Page {
    std::vector<std::shared_ptr<Session>> sessions;  // sorted by id
    std::string last;                                // id of the last one, if more follow
  };

  // `store` saves the sessions; null: nothing is saved. `ownership` knows which sessions of a cluster this server owns;
  // null: a single server owns all. Both outlive the table. `models` and `clock` outlive it as well.
  Table(Models& models, const Clock& clock, const Limits& limits, store::Store* store = nullptr,
        store::Ownership* ownership = nullptr);
  // Calls Close with UNAVAILABLE.
  ~Table();

  // Gives the present name of an account that an earlier version stored.
  using AccountNames = std::function<std::string(const std::string& stored)>;
  // Sets the names for Restore and TakeOver; null: they are unchanged. Call it before them.
  void set_account_names(AccountNames names) { account_names_ = std::move(names); }

  // Restores the sessions of an earlier server from the store, as many at a time as there are processor cores. Calls
  // `progress` before each, one call at a time. Sessions that played continue to play once all are restored, so that
  // they do not delay the others. A session whose scene compiles to another model in this build is carried over
  // (CarryOver). Returns the sessions that could not be restored, with the reason; they stay in the store under their
  // id until they are deleted, and the next server tries again. The errors of store::Store::Load; UNAVAILABLE if the
  // cluster cannot say who owns a session. Requires: there is a store, and no session was created yet.
  absl::StatusOr<std::map<std::string, absl::Status>> Restore(absl::FunctionRef<void(const std::string& id)> progress)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns what Restore and TakeOver carried over, as v1::Session.carried_over, by id.
  std::map<std::string, std::string> carried_over() const ABSL_LOCKS_EXCLUDED(mutex_);

  // Continues a session of a server that is gone. The errors of Restore. `epoch` is the one that this server has
  // claimed. Returns the reason of Close if the table is closed.
  absl::Status TakeOver(const store::SavedSession& saved, std::int64_t epoch) ABSL_LOCKS_EXCLUDED(mutex_);
  // Ends a session that another server continues, and its viewers with UNAVAILABLE. Does not wait. Removes it from this
  // server's store; Tend releases it later. Does nothing if there is no such session.
  void Drop(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

  // Compiles the scene on behalf of `by` and creates a paused session. An empty id is chosen (FreeId). The errors of
  // Models::Compile; INVALID_ARGUMENT, ALREADY_EXISTS or RESOURCE_EXHAUSTED for the id, the fields and the number of
  // sessions. Runs on the calling thread and waits for the compile. Returns once the session is in the store, and in a
  // cluster where another server can continue it; otherwise removes it and returns the error. After Close, returns its
  // reason.
  absl::StatusOr<std::shared_ptr<Session>> Create(const v1::CreateSessionRequest& request, ControlBook control = {},
                                                  const Requester& by = {}) ABSL_LOCKS_EXCLUDED(mutex_);
  // Creates a paused session at the present state of another one (Session::MakeFork). The same errors. NOT_FOUND if
  // there is no session to copy; FAILED_PRECONDITION if it has diverged.
  absl::StatusOr<std::shared_ptr<Session>> Fork(const v1::ForkSessionRequest& request, ControlBook control = {})
      ABSL_LOCKS_EXCLUDED(mutex_);
  // NOT_FOUND lists the ids of sessions that no account owns. Counts as attention (Session::NoteAttention). A session
  // that is still being created is not found.
  absl::StatusOr<std::shared_ptr<Session>> Find(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the sessions that are `visible` (null: all), sorted by id, after the id `after`. A page has 100 sessions if
  // `page_size` is not positive, and 1000 at most. `visible` runs with the mutex held: it must not call the table.
  Page List(int page_size, const std::string& after,
            const std::function<bool(const Session& session)>& visible = nullptr) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Deletes the session if the token's bearer may (Session::CheckControl), and ends its viewers with NOT_FOUND. Also
  // deletes a session that could not be restored, by its saved control. NOT_FOUND if no session has this id.
  absl::Status Delete(const std::string& id, std::string_view token = {}) ABSL_LOCKS_EXCLUDED(mutex_);
  // Deletes the session without regard to control. For administrators and Tend.
  absl::Status DeleteAnyway(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Pauses and deletes sessions that have had no viewer and no call for as long as the limits say, unless they were
  // asked to keep playing; deletes temporary copies after a minute. A PeriodicTask calls it. Also announces to viewers
  // why a session is not saved.
  void Tend() ABSL_LOCKS_EXCLUDED(mutex_);
  // Stops and saves every session, for another server to continue. No session can be created afterwards, and none steps
  // or writes to the store any more, even if a caller still holds it. Waits for every stepping thread and for the
  // store. In a cluster, gives up the ownership of the sessions whose last state other servers have. A second call
  // keeps the first reason.
  void Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // A session's id, and its epoch in a cluster.
  struct Claim {
    std::string id;
    std::int64_t epoch = 0;  // 0: no cluster
  };
  using Maker = absl::StatusOr<std::shared_ptr<Session>>(const Claim& claim);

  // Reserves an id, under which sessions_ has null until the session is created. The field `field` of the request holds
  // the wanted id; `elsewhere` are ids that other servers have. INVALID_ARGUMENT for a bad id, ALREADY_EXISTS for a
  // taken one, the errors of CheckRoom, and the reason of Close.
  absl::StatusOr<std::string> Reserve(const char* field, const std::string& wanted, const std::string& stem,
                                      const std::string& account, const std::set<std::string>& elsewhere)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Reserves an id in the whole cluster. An id that was not wanted is chosen again while another server has it. The
  // errors of Reserve and of store::Ownership::Claim.
  absl::StatusOr<Claim> ReserveEverywhere(const char* field, const std::string& wanted, const std::string& scene,
                                          const std::string& account) ABSL_LOCKS_EXCLUDED(mutex_);
  // RESOURCE_EXHAUSTED if limits.sessions are reached, or limits.sessions_of_user of the account; empty: none.
  absl::Status CheckRoom(const std::string& account) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Reserves an id, creates the session by `make`, and enters it. Gives the id free again if `make` or the store fails.
  absl::StatusOr<std::shared_ptr<Session>> Admit(const char* field, const std::string& wanted, const std::string& scene,
                                                 const std::string& account, absl::FunctionRef<Maker> make)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Compiles the scene, merges its parameters, the preset and the request's parameters, in this order, and starts the
  // session. If neither the scene nor the request sets a time step, and the stiffness or the integrator differs from
  // the scene's, it chooses one.
  absl::StatusOr<std::shared_ptr<Session>> Make(const Claim& claim, const v1::CreateSessionRequest& request,
                                                ControlBook control, const Requester& by);
  absl::StatusOr<std::shared_ptr<Session>> MakeFork(const Claim& claim, Session& of, bool temporary,
                                                    ControlBook control) const;
  // Begins the journal of a new session, if there is a store. Returns the errors of SaveScene.
  absl::StatusOr<SessionOrigin> Begin(const Claim& claim, const Model& model, std::vector<Uploads::Held> surfaces,
                                      ControlBook control) const;
  struct Restoring;
  // Restores sessions one after the other until none is left. Several threads call it at the same time.
  void RestoreNext(Restoring& restoring) ABSL_LOCKS_EXCLUDED(mutex_);
  // Restores the session, or keeps it in lost_ and sets `lost` to the reason. Errors: those of Restore.
  absl::Status RestoreOne(store::SavedSession saved, absl::Status& lost) ABSL_LOCKS_EXCLUDED(mutex_);
  // Lets all sessions play (Session::Release).
  void ReleaseAll() const ABSL_LOCKS_EXCLUDED(mutex_);
  // `taken`: another server had the session, and this server's store gets all of it. Otherwise the session is held
  // until ReleaseAll. Compiles the scene, then replays the journal, or carries the state over if the model differs.
  absl::StatusOr<std::shared_ptr<Session>> Restored(const store::SavedSession& saved, std::int64_t epoch, bool taken);
  // Returns the journal to continue; a new one if the session was carried over or taken.
  absl::StatusOr<std::shared_ptr<store::Journal>> JournalOf(const store::SavedSession& saved, const Compiled& compiled,
                                                            const Replayed& replayed, bool taken) const;
  // Returns the session's epoch. FAILED_PRECONDITION if another server has it; it is then removed from this store.
  absl::StatusOr<std::int64_t> Reclaim(const store::SavedSession& saved);
  // `token` of the caller; nullopt: without regard to control.
  absl::Status Remove(const std::string& id, std::optional<std::string_view> token) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the control of a saved session, with the present name of its account.
  ControlState ControlOf(const store::SavedSession& saved) const;
  // Deletes a session that could not be restored; waits for the store with the mutex held.
  absl::Status DeleteLost(const std::string& id, std::optional<std::string_view> token)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns what an id may begin with: the scene's name if the catalogue has it, and otherwise "session", since the
  // name of a scene that a client sends may be a patient's.
  std::string StemOf(const std::string& scene) const;
  // Returns "thorax", "thorax-2" ...; with an account "thorax-5f0c...", which tells others nothing.
  std::string FreeId(const std::string& stem, const std::string& account, const std::set<std::string>& elsewhere) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns NOT_FOUND, which lists sessions that no account owns (schema::ThereAre).
  absl::Status NoSession(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  Models& models_;
  const Clock& clock_;
  const Limits limits_;  // also those of each session
  store::Store* const store_;
  store::Ownership* const ownership_;
  AccountNames account_names_;  // set before the first session, then constant
  mutable absl::Mutex mutex_;
  std::map<std::string, std::shared_ptr<Session>> sessions_ ABSL_GUARDED_BY(mutex_);  // null: being created
  std::map<std::string, std::string> reserved_ ABSL_GUARDED_BY(mutex_);      // accounts, by the ids that are reserved
  std::map<std::string, store::SavedSession> lost_ ABSL_GUARDED_BY(mutex_);  // could not be restored
  std::map<std::string, std::string> carried_over_ ABSL_GUARDED_BY(mutex_);
  std::vector<std::shared_ptr<Session>> dropped_ ABSL_GUARDED_BY(mutex_);  // Tend releases them
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);             // the reason of Close
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_TABLE_H_
