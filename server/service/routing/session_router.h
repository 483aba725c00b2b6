// What a cluster's servers listen with: each call goes to the server that has its session, this one or another.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_

#include <grpcpp/channel.h>
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/cluster/cluster.h"

namespace phrenic::service {

// Any thread may call. A call names its session by its request's session_id, else by "x-session-id" in its metadata.
// Calls of no session are this server's own; what it does not find (an export, a study) it asks the others for, and
// lists are those of all of them together. Who was passed a call by another server does not pass it on.
class SessionRouter final : public grpc::CallbackGenericService {
 public:
  using Metadata = std::multimap<std::string, std::string>;

  // A server, and what it is told of the caller.
  struct Target {
    std::shared_ptr<grpc::GenericStub> stub;
    std::string address;  // empty: this one
  };
  struct Route {
    std::string session;          // empty: none
    std::vector<Target> targets;  // one after the other, while they do not find it
    bool all = false;             // of each, put together
  };

  explicit SessionRouter(cluster::Cluster& cluster) : cluster_(cluster) {}
  // Where this server's own calls go; before any call comes.
  void set_here(std::shared_ptr<grpc::Channel> channel);

  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override;

  // UNAVAILABLE where the session is with nobody for the moment, or nobody can tell.
  absl::StatusOr<Route> Find(const std::string& method, const Metadata& metadata, const grpc::ByteBuffer& request);
  // That server did not answer.
  void NoteGone(const Route& route);
  // A call went to another server.
  void CountForwarded() { ++forwarded_; }
  std::int64_t forwarded() const { return forwarded_; }

  // What a call may carry to another server, of what its caller sent.
  static Metadata MetadataOf(const grpc::GenericCallbackServerContext& context);
  // The same, with what the servers tell each other.
  Metadata MetadataFor(const Target& target, Metadata metadata, const std::string& peer) const;

 private:
  std::shared_ptr<grpc::GenericStub> StubOf(const std::string& address) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Route> FindSession(const std::string& id);
  void AddOthers(Route& route);

  cluster::Cluster& cluster_;
  std::shared_ptr<grpc::GenericStub> here_;
  std::atomic<std::int64_t> forwarded_ = 0;
  absl::Mutex mutex_;
  std::map<std::string, std::shared_ptr<grpc::GenericStub>> stubs_ ABSL_GUARDED_BY(mutex_);
};

// The answers of several servers to one method as one; `request` is what each was asked.
grpc::ByteBuffer Together(const std::string& method, const grpc::ByteBuffer& request,
                          const std::vector<grpc::ByteBuffer>& answers);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_
