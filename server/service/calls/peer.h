// Which machine a call comes from.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
#define PHRENIC_SERVER_SERVICE_CALLS_PEER_H_

#include <grpcpp/server_context.h>

#include <string>

namespace phrenic::service {

// "192.0.2.1", "2001:db8::1"; of a browser's call, which the gateway makes within the process, the browser's. Empty:
// the process itself.
std::string PeerOf(const grpc::ServerContextBase& context);

bool IsThisMachine(const std::string& peer);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
