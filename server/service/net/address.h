// Parses listen addresses of the form "HOST:PORT" (IPv6 hosts in brackets, RFC 3986 section 3.2.2).
#ifndef PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_
#define PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace phrenic::service {

// The parts of a listen address. The host may be a name, which nothing here resolves.
struct Address {
  std::string host;  // without the brackets of "[::1]:8080"
  int port = 0;      // 0 lets the system choose a free port
};

// Returns INVALID_ARGUMENT, with the expected form, if `text` is not "HOST:PORT" with a port from 0 to 65535. An IPv6
// host without brackets is refused, and so is an empty host. Pure function, thread-safe.
absl::StatusOr<Address> ParseAddress(const std::string& text);

// True if only processes on this machine can connect: "localhost", "::1" and 127.0.0.0/8 (RFC 1122 section 3.2.1.3).
// Names other than "localhost" count as other machines, whatever they resolve to: CheckOptions then asks for TLS.
// Thread-safe.
bool IsLoopback(const Address& address);

// Returns UNAVAILABLE with the address, the system's reason and a remedy. ListenOn returns it if the system refuses to
// open, bind or listen. Pure function, thread-safe.
absl::Status CannotListen(const std::string& address, const std::string& why);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_ADDRESS_H_
