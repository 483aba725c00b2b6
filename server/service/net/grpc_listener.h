// Accepts TCP connections for gRPC up to a limit. gRPC's own listener has no limit on connections and stops accepting
// for good when the process runs out of file descriptors.
#ifndef PHRENIC_SERVER_SERVICE_NET_GRPC_LISTENER_H_
#define PHRENIC_SERVER_SERVICE_NET_GRPC_LISTENER_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/server_builder.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <list>
#include <memory>
#include <string>
#include <thread>

#include "absl/status/statusor.h"

namespace phrenic::service {

// Not thread-safe. Accepts on its own thread.
//
// The server owns it if it has a --listen address; in a cluster it belongs to the forwarding gRPC server. One thread
// calls its methods; between Start and Shutdown its own thread uses the members. A connection above the limit is closed
// at once, without an answer. An error of accept, such as too many open files, is tried again after kAcceptRetry.
class GrpcListener {
 public:
  // Listens and registers with `builder`. Call before the server is built; connections reach gRPC after Start.
  // `max_connections` counts open connections, whether they have calls or not. Clients can connect from here on, and
  // wait until Start.
  // Errors: those of ListenOn.
  static absl::StatusOr<std::unique_ptr<GrpcListener>> Make(const std::string& address, std::size_t max_connections,
                                                            std::shared_ptr<grpc::ServerCredentials> credentials,
                                                            grpc::ServerBuilder& builder);
  // Calls Shutdown.
  ~GrpcListener();

  // Returns the port in use; that of the system's choice for port 0. Constant, thread-safe.
  int port() const { return port_; }
  // Starts accepting. Requires: the server is built. Call it once.
  void Start();
  // Stops accepting and joins the thread; open connections stay with gRPC. Idempotent. Call it before the gRPC server
  // shuts down, which would refuse new connections.
  void Shutdown();

 private:
  // A connection that gRPC owns. File descriptors are reused, so the socket's inode tells whether it is still open.
  struct OpenConnection {
    int file_descriptor;
    unsigned long inode;
  };

  GrpcListener(std::size_t max_connections, std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc);
  // Waits for the next connection, without blocking; calls itself after each.
  void Accept();
  // Sets keepalive and TCP_NODELAY, and gives the socket to gRPC. Closes it if there is no room.
  void PassToGrpc(boost::asio::ip::tcp::socket socket);
  // Forgets closed connections if the limit is reached. True if one more connection is allowed. Costs one system call
  // for each connection, but only at the limit.
  bool HasRoom();

  const std::size_t max_connections_;
  const std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc_;
  boost::asio::io_context context_;  // run by thread_ alone
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_timer_;  // after an error of accept
  int port_ = 0;
  std::list<OpenConnection> open_;  // with some that have been closed since
  std::thread thread_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_GRPC_LISTENER_H_
