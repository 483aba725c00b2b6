// Sockets that accept connections, and the options of each accepted connection.
#ifndef PHRENIC_SERVER_SERVICE_NET_LISTEN_H_
#define PHRENIC_SERVER_SERVICE_NET_LISTEN_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <string>

#include "absl/status/statusor.h"

namespace phrenic::service {

// Opens, binds and listens on "HOST:PORT". Returns the port in use, which the system chooses if PORT is 0. Blocks while
// the system resolves the host, and uses the first address that it gives. Port numbers of a server that has just ended
// can be used at once. The backlog is the system's maximum. Not thread-safe for one acceptor.
// Errors: INVALID_ARGUMENT if the address cannot be parsed; UNAVAILABLE if the host does not resolve or the port is
// taken.
absl::StatusOr<int> ListenOn(const std::string& address, boost::asio::ip::tcp::acceptor& acceptor);

// The pause before accepting again after an error, such as running out of file descriptors. Connections that have ended
// meanwhile have given their descriptors back.
inline constexpr std::chrono::milliseconds kAcceptRetry(100);

// Enables TCP keepalive (RFC 1122 section 4.2.3.6) and TCP_USER_TIMEOUT (RFC 5482), so that a peer that does not answer
// is detected within 15 s, whether the connection is idle or has unacknowledged data. The first probe comes after 9 s
// without data, two more at 3 s each. Ignores errors: the connection works without. The gateway and GrpcListener call
// it for each connection that they accept.
void EnableKeepalive(boost::asio::ip::tcp::socket& socket);

// Raises the soft limit on open file descriptors to the hard limit, because each connection needs one. It is for the
// whole process: call it once, before the server starts. Ignores errors.
void RaiseFileLimit();

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_LISTEN_H_
