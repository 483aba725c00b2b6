// The sessions of a server, by their ids.
#ifndef PHRENIC_SERVER_SESSION_TABLE_H_
#define PHRENIC_SERVER_SESSION_TABLE_H_

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
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

// Any thread may call.
class Table {
 public:
  struct Page {
    std::vector<std::shared_ptr<Session>> sessions;
    std::string next_token;
  };

  // `store` outlives the table and saves its sessions; null: nothing is saved.
  // `ownership` outlives the table as well, and says which sessions are this server's; null: all, it is by itself.
  Table(Models& models, const stream::Clock& clock, const Limits& limits, store::Store* store = nullptr,
        store::Ownership* ownership = nullptr);
  ~Table();

  // What the store has of an earlier server's, each as it was: those that played go on. Why a session could not be
  // restored, for each of those: it stays in the store under its id until it is deleted. `progress` hears of each.
  absl::StatusOr<std::map<std::string, absl::Status>> Restore(absl::FunctionRef<void(const std::string& id)> progress)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Goes on with a session of a server that is gone. Why it cannot be: the errors of Restore.
  absl::Status TakeOver(const store::SavedSession& saved, std::int64_t epoch) ABSL_LOCKS_EXCLUDED(mutex_);
  // Another server goes on with it: ends it here, and its viewers with UNAVAILABLE. Does not wait.
  void Drop(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

  // Compiles the scene and makes a paused session. An empty id lets the table choose one from the scene's name.
  // INVALID_ARGUMENT, ALREADY_EXISTS or RESOURCE_EXHAUSTED tell why there is none.
  absl::StatusOr<std::shared_ptr<Session>> Create(const v1::CreateSessionRequest& request, ControlBook control = {})
      ABSL_LOCKS_EXCLUDED(mutex_);
  // A paused session that stands where another one stands (Session::MakeFork); its id is chosen likewise.
  absl::StatusOr<std::shared_ptr<Session>> Fork(const v1::ForkSessionRequest& request, ControlBook control = {})
      ABSL_LOCKS_EXCLUDED(mutex_);
  // NOT_FOUND lists the ids there are.
  absl::StatusOr<std::shared_ptr<Session>> Find(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Sessions in the order of their ids, after the one that `token` names.
  Page List(int page_size, const std::string& token) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Stops the session, where the token's bearer may (Session::CheckControl), and ends its viewers with NOT_FOUND.
  absl::Status Delete(const std::string& id, std::string_view token = {}) ABSL_LOCKS_EXCLUDED(mutex_);
  // The same, whoever controls it.
  absl::Status DeleteAnyway(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Pauses and deletes the sessions that nobody has watched or asked for as long as the limits have it. To be called
  // now and then.
  void Tend() ABSL_LOCKS_EXCLUDED(mutex_);
  // Stops and saves every session, for another server to go on with; none can be made afterwards, and none steps or
  // writes to the store any more, whoever holds it.
  void Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // A session's id, and its epoch in a cluster.
  struct Claim {
    std::string id;
    std::int64_t epoch = 0;
  };
  using Maker = absl::StatusOr<std::shared_ptr<Session>>(const Claim& claim);

  // A place taken while its session is being made: null. `field` of the request holds the wanted id.
  // `elsewhere` are ids that other servers have.
  absl::StatusOr<std::string> Reserve(const char* field, const std::string& wanted, const std::string& scene,
                                      const std::string& account, const std::set<std::string>& elsewhere)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // The same in the whole cluster.
  absl::StatusOr<Claim> ReserveEverywhere(const char* field, const std::string& wanted, const std::string& scene,
                                          const std::string& account) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status CheckRoom(const std::string& account) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Takes a place, has the session made and puts it there.
  absl::StatusOr<std::shared_ptr<Session>> Admit(const char* field, const std::string& wanted, const std::string& scene,
                                                 const std::string& account, absl::FunctionRef<Maker> make)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<std::shared_ptr<Session>> Make(const Claim& claim, const v1::CreateSessionRequest& request,
                                                ControlBook control);
  absl::StatusOr<std::shared_ptr<Session>> MakeFork(const Claim& claim, Session& of, ControlBook control) const;
  // Of a new session: its journal is begun where there is a store.
  absl::StatusOr<SessionOrigin> Begin(const Claim& claim, const Model& model, std::vector<Uploads::Held> surfaces,
                                      ControlBook control) const;
  // `taken`: it was another server's, and the store is to have all of it.
  absl::StatusOr<std::shared_ptr<Session>> Restored(const store::SavedSession& saved, std::int64_t epoch, bool taken);
  // Its epoch; FAILED_PRECONDITION where another server has it, and it goes from this one's store.
  absl::StatusOr<std::int64_t> Reclaim(const store::SavedSession& saved);
  // `token` of who asks; none: whoever it is.
  absl::Status Remove(const std::string& id, std::optional<std::string_view> token) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status DeleteLost(const std::string& id, std::optional<std::string_view> token)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::string FreeId(const std::string& scene, const std::set<std::string>& elsewhere) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status NoSession(const std::string& id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  Models& models_;
  const stream::Clock& clock_;
  const Limits limits_;
  store::Store* const store_;
  store::Ownership* const ownership_;
  mutable absl::Mutex mutex_;
  std::map<std::string, std::shared_ptr<Session>> sessions_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, store::SavedSession> lost_ ABSL_GUARDED_BY(mutex_);  // could not be restored
  std::vector<std::shared_ptr<Session>> dropped_ ABSL_GUARDED_BY(mutex_);    // to be let go of by Tend
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_TABLE_H_
