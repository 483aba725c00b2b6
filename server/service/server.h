// The server as a whole: sessions, gRPC services over a socket and in process, and the web gateway.
#ifndef PHRENIC_SERVER_SERVICE_SERVER_H_
#define PHRENIC_SERVER_SERVICE_SERVER_H_

#include <grpcpp/channel.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/access/accounts.h"
#include "server/cluster/cluster.h"
#include "server/record/spool_file.h"
#include "server/schema/places.h"
#include "server/service/net/tls.h"
#include "server/session/limits.h"

namespace phrenic::service {

struct ServerOptions {
  std::string listen;    // "127.0.0.1:50051", port 0 chooses one; empty: in process only
  std::string web;       // "127.0.0.1:8080", port 0 chooses one; empty: no web gateway
  std::string data_dir;  // surface files of scenes, and DATA/scenes; empty: none
  std::string scenes_dir = Installed("scenes", PHRENIC_SCENES_DIR);
  std::string web_root = Installed("web", PHRENIC_WEB_DIR);
  std::string spool_dir = record::DefaultSpoolFolder();  // of exports and uploads; nothing in it has a name
  std::string store_dir;  // of sessions, which go on after the server ended; empty: they end with it
  std::function<void(const std::string& session)> restoring;  // is called before each session of the store
  std::vector<std::string> allowed_origins;  // "https://host:port", beside its own: may call, and frame the viewer
  session::Limits limits;
  int step_threads = 1;              // that a step may have, of the whole process (mechanics/share_out.h)
  int max_message_bytes = 16 << 20;  // of a request
  double max_requests = 200;         // a second, of one account or of another machine; 0: any number
  int max_connections = 512;         // to each of `web` and `listen`
  double head_seconds = 10;          // for a request's head to come
  double idle_seconds = 60;          // for its rest, and for a connection without a request
  TlsFiles tls;                      // none: nothing is encrypted
  bool insecure_listen = false;      // unencrypted on an address that other machines can reach
  access::AccountOptions accounts;   // none: every caller may do everything
  std::string audit_file;            // empty: none
  cluster::ClusterOptions cluster;   // none: a server by itself
};

// Any thread may call. Its own threads: gRPC's, the gateway's, two a session, and one an export at once.
class Server {
 public:
  // Listens once the store's sessions are restored. FAILED_PRECONDITION where other machines would be listened to
  // unencrypted, and nobody said that they may be; INVALID_ARGUMENT for settings that a cluster's server cannot have;
  // UNAVAILABLE names the address that could not be listened on, or Redis that cannot be reached;
  // NOT_FOUND the folder that is missing; else what is wrong with the store.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The same services without a socket; ends with the server.
  std::shared_ptr<grpc::Channel> InProcessChannel();
  // The ports that are listened on; 0 where there is none.
  int port() const;
  int web_port() const;
  // Why sessions of the store, by their ids, and studies and exports ("study NAME") could not be restored: they stay in
  // it.
  const std::map<std::string, absl::Status>& lost() const;
  // Tells viewers, hands sessions on where there is a cluster, saves and ends sessions, breaks exports off and ends
  // calls, within about two seconds but for a scene that is being built; a second call does nothing.
  void Shutdown();

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SERVER_H_
