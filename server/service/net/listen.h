// Listening on an address, and what every connection is given.
#ifndef PHRENIC_SERVER_SERVICE_NET_LISTEN_H_
#define PHRENIC_SERVER_SERVICE_NET_LISTEN_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

#include "absl/status/statusor.h"

namespace phrenic::service {

// Opens the acceptor at "HOST:PORT" and gives the port that it has, where 0 chose one. UNAVAILABLE names the address
// that could not be listened on, INVALID_ARGUMENT one that is none.
absl::StatusOr<int> ListenOn(const std::string& address, boost::asio::ip::tcp::acceptor& acceptor);

// A peer that no longer answers is given up within 15 s, whether bytes are on their way to it or not.
void EnableKeepalive(boost::asio::ip::tcp::socket& socket);

// As many open files as the system lets this process have: each connection is one.
void AllowManyFiles();

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_LISTEN_H_
