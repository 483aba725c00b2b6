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
class SessionRouter {
 public:
  using Metadata = service::Metadata;

  struct Target {
    std::shared_ptr<grpc::GenericStub> stub;
    std::string address;  // "HOST:PORT"; empty: this server
  };
  struct Route {
    std::string session;          // empty: the call has none
    std::vector<Target> targets;  // tried in order until one does not return NOT_FOUND
    bool fan_out = false;         // calls all targets at once and merges the responses
  };

  // `credentials` are those of calls to the other servers. `cluster` and `page_tokens` outlive the router.
  SessionRouter(cluster::Cluster& cluster, std::shared_ptr<grpc::ChannelCredentials> credentials,
                const PageTokens& page_tokens)
      : cluster_(cluster), credentials_(std::move(credentials)), page_tokens_(page_tokens) {}
  const PageTokens& page_tokens() const { return page_tokens_; }
  // Sets the channel to this server's own services. Call it before Find.
  void set_local_channel(std::shared_ptr<grpc::Channel> channel);

  // Returns UNAVAILABLE, which clients retry, if no server has the session at the moment or if Redis cannot be asked.
  absl::StatusOr<Route> Find(const std::string& method, const Metadata& metadata, const grpc::ByteBuffer& request);
  // Reports that the server of the route's session did not answer; the next Find asks Redis again.
  void ReportUnreachable(const Route& route);
  void CountForwarded() { ++forwarded_; }
  // Returns the number of calls forwarded to other servers.
  std::int64_t forwarded() const { return forwarded_; }

  // Returns the metadata of a call that are forwarded: "x-..." and "authorization", without kPeerKey.
  static Metadata ForwardedMetadata(const grpc::ServerContextBase& context);
  // Adds what the target needs to know: kPeerKey for this server, kForwardedByKey for another one.
  Metadata MetadataFor(const Target& target, Metadata metadata, const std::string& peer) const;

 private:
  std::shared_ptr<grpc::GenericStub> StubOf(const std::string& address) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Route> FindForwarded(const std::string& session);
  absl::StatusOr<Route> FindSession(const std::string& id);
  void AddOtherServers(Route& route);

  cluster::Cluster& cluster_;
  const std::shared_ptr<grpc::ChannelCredentials> credentials_;
  const PageTokens& page_tokens_;
  std::shared_ptr<grpc::GenericStub> local_;
  std::atomic<std::int64_t> forwarded_ = 0;
  absl::Mutex mutex_;
  std::map<std::string, std::shared_ptr<grpc::GenericStub>> stubs_ ABSL_GUARDED_BY(mutex_);  // by address
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_SESSION_ROUTER_H_
