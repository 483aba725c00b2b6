// v1.ServerService: version and features of the server.
#ifndef PHRENIC_SERVER_SERVICE_SERVER_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SERVER_SERVICE_H_

#include <atomic>

#include "phrenic/v1/server.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method. Clients ask it first,
// before they have an account; /readyz rests on the same call (Server).
class ServerService final {
 public:
  // `viewer_is_built`: the web root has an index.html when the server starts. `encrypted`: the server uses TLS. The
  // guard outlives the service.
  ServerService(bool viewer_is_built, bool has_data_folder, bool encrypted, AccessGuard& guard)
      : viewer_is_built_(viewer_is_built), has_data_folder_(has_data_folder), encrypted_(encrypted), guard_(guard) {}

  // Sets the gateway's port, which is known only after the first calls may arrive. 0 until then, and without a gateway.
  // Thread-safe.
  void set_web_port(int port) { web_port_ = port; }

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kQuick. Needs no account.
  grpc::Status GetServer(grpc::CallbackServerContext* context, const v1::GetServerRequest* request,
                         v1::GetServerResponse* response);

 private:
  const bool viewer_is_built_, has_data_folder_, encrypted_;
  AccessGuard& guard_;
  std::atomic<int> web_port_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SERVER_SERVICE_H_
