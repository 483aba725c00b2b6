// The server as a whole: sessions, gRPC services over a socket and in process, and the web gateway.
#ifndef PHRENIC_SERVER_SERVICE_SERVER_H_
#define PHRENIC_SERVER_SERVICE_SERVER_H_

#include <grpcpp/channel.h>

#include <map>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/service/server_options.h"

namespace phrenic::service {

// Thread-safe, except that one thread at a time calls Shutdown. Its threads: gRPC's, those of calls
// (calls/call_limits.h), two of the gateway, two per session, one per running export, two for maintenance.
//
// phrenicd has one (daemon/serve.cc). Start sets step_threads for the whole process, and the other options for this
// server alone.
class Server {
 public:
  // Restores the store's sessions, then listens. Errors: those of CheckOptions; UNAVAILABLE if an address cannot be
  // listened on or Redis cannot be reached; the store's errors if it cannot be read. Blocks until the server answers
  // calls, which takes as long as its sessions take to restore. /readyz is 200 from then on. A session that cannot be
  // restored is no error: see lost().
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options);
  // Calls Shutdown. Channels of InProcessChannel may outlive the server.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Returns a channel to the services without a socket. Calls fail once the server is destroyed. Its calls have the
  // role of an administrator and are not forwarded in a cluster. Messages have no limit of size on the client's side.
  std::shared_ptr<grpc::Channel> InProcessChannel();
  // Return the ports in use; 0 if the server does not listen there. Constant after Start.
  int port() const;
  int web_port() const;
  // Returns why sessions (by id), studies ("study ID") and exports could not be restored. They stay in the store.
  // Constant after Start.
  const std::map<std::string, absl::Status>& lost() const;
  // Ends streams, hands sessions over to the cluster's other servers, saves and ends sessions, and aborts exports and
  // calls. Takes about 2 s, or until a scene that is being compiled is done. Idempotent. The order: readiness and
  // health tell clients to go, the maintenance ends, the listener closes, sessions end and are saved, the gateway
  // closes, and calls have 0.5 s to end before gRPC cancels them.
  void Shutdown();

 private:
  // All members, in the order of their dependencies (server.cc).
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SERVER_H_
