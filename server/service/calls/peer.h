// The IP address that a call comes from.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
#define PHRENIC_SERVER_SERVICE_CALLS_PEER_H_

#include <grpcpp/server_context.h>

#include <string>

namespace phrenic::service {

// Returns the IP address of the caller, "192.0.2.1" or "2001:db8::1". For an in-process call from the gateway or the
// session router it is the address in kPeerKey, for any other in-process call it is empty. Thread-safe.
std::string PeerOf(const grpc::ServerContextBase& context);

// True for the process itself and for loopback addresses, with IPv4-mapped ones (RFC 4291 section 2.5.5.2).
bool IsThisMachine(const std::string& peer);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
