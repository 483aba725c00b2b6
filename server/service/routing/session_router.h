// Decides which servers of a cluster handle a call: the one that has the call's session, this one, or all of them.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_

#include <grpcpp/channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/cluster/cluster.h"
#include "server/service/calls/page_tokens.h"
#include "server/service/net/metadata.h"

namespace phrenic::service {

// A call names its session by the session_id of its request, or else by kSessionKey in its metadata. A call without a
// session goes to this server; if it names an export, study or upload that this server does not find, it goes to the
// others in turn. List methods go to all servers. A forwarded call is never forwarded again. Thread-safe.
//
// Only a server in a cluster has one. The locations come from cluster::Cluster, which caches them; Find may wait for
// Redis (Redis::kTimeout), so it runs on a thread that may block. mutex_ guards the channels alone.
class SessionRouter {
 public:
  using Metadata = service::Metadata;

  // A server that may handle the call.
  struct Target {
    std::shared_ptr<grpc::GenericStub> stub;
    std::string address;  // "HOST:PORT"; empty: this server
  };
  // Where a call goes. There is at least one target.
  struct Route {
    std::string session;          // empty: the call has none
    std::vector<Target> targets;  // tried in order until one does not return NOT_FOUND
    bool fan_out = false;         // calls all targets at once, this server first, and merges the responses
  };

  // `credentials` are those of calls to the other servers. `cluster` and `page_tokens` outlive the router. Connects to
  // no server yet.
  SessionRouter(cluster::Cluster& cluster, std::shared_ptr<grpc::ChannelCredentials> credentials,
                const PageTokens& page_tokens)
      : cluster_(cluster), credentials_(std::move(credentials)), page_tokens_(page_tokens) {}
  // Returns the tokens that every server of the cluster can open.
  const PageTokens& page_tokens() const { return page_tokens_; }
  // Sets the channel to this server's own services. Call it before Find. Not thread-safe.
  void set_local_channel(std::shared_ptr<grpc::Channel> channel);

  // Returns UNAVAILABLE, which clients retry, if no server has the session at the moment or if Redis cannot be asked.
  // An unknown session counts as this server's, which then says NOT_FOUND. A forwarded call has this server as its only
  // target, and gets UNAVAILABLE if the session has moved on. A request of an unknown method is not parsed.
  absl::StatusOr<Route> Find(const std::string& method, const Metadata& metadata, const grpc::ByteBuffer& request);
  // Reports that the server of the route's session did not answer; the next Find asks Redis again. Does nothing for a
  // call without a session.
  void ReportUnreachable(const Route& route);
  // A call that tries several servers in turn counts for each; a fan-out does not count. Metrics report the number.
  void CountForwarded() { ++forwarded_; }
  // Returns the number of calls forwarded to other servers.
  std::int64_t forwarded() const { return forwarded_; }

  // Returns the metadata of a call that are forwarded: "x-..." and "authorization", without kPeerKey. The deadline is
  // not among them. Requires: the call is not done.
  static Metadata ForwardedMetadata(const grpc::ServerContextBase& context);
  // Adds what the target needs to know: kPeerKey for this server, kForwardedByKey for another one. `peer` is the IP
  // address of the client. Another server sees the address of this one as that of the caller.
  Metadata MetadataFor(const Target& target, Metadata metadata, const std::string& peer) const;

 private:
  // Returns the channel to another server, which is made at the first call and kept. It connects on demand, again
  // within 1 s after that server restarts, and notices a dead one within 13 s.
  std::shared_ptr<grpc::GenericStub> StubOf(const std::string& address) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the route of a call that another server has forwarded: this server, unless another one has the session.
  absl::StatusOr<Route> FindForwarded(const std::string& session);
  // Returns the route to the session's server. UNAVAILABLE while it moves, or if Redis does not answer.
  absl::StatusOr<Route> FindSession(const std::string& id);
  // Adds the cluster's other servers that accept sessions as further targets.
  void AddOtherServers(Route& route);

  cluster::Cluster& cluster_;
  const std::shared_ptr<grpc::ChannelCredentials> credentials_;
  const PageTokens& page_tokens_;
  std::shared_ptr<grpc::GenericStub> local_;  // to this server, in process; constant once calls arrive
  std::atomic<std::int64_t> forwarded_ = 0;
  absl::Mutex mutex_;
  std::map<std::string, std::shared_ptr<grpc::GenericStub>> stubs_ ABSL_GUARDED_BY(mutex_);  // by address
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_
