// The IP address that a call comes from.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
#define PHRENIC_SERVER_SERVICE_CALLS_PEER_H_

#include <grpcpp/server_context.h>

#include <string>

namespace phrenic::service {

// Returns the IP address of the caller, "192.0.2.1" or "2001:db8::1". For an in-process call from the gateway or the
// session router it is the address in kPeerKey, for any other in-process call it is empty. Thread-safe. kPeerKey has no
// effect on a call over TCP, and the gateway and the router replace what a client sends, so a client cannot choose its
// address. A client behind a proxy has the address of the proxy. Requires: the call is not done.
std::string PeerOf(const grpc::ServerContextBase& context);

// True for the process itself and for loopback addresses, with IPv4-mapped ones (RFC 4291 section 2.5.5.2). `peer` is
// what PeerOf returns; empty is the process. Clients behind a proxy on this machine are of this machine too. Pure
// function, thread-safe.
bool IsThisMachine(const std::string& peer);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_PEER_H_
