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
class GrpcListener {
 public:
  // Listens and registers with `builder`. Call before the server is built; connections reach gRPC after Start.
  // Errors: those of ListenOn.
  static absl::StatusOr<std::unique_ptr<GrpcListener>> Make(const std::string& address, std::size_t max_connections,
                                                            std::shared_ptr<grpc::ServerCredentials> credentials,
                                                            grpc::ServerBuilder& builder);
  ~GrpcListener();

  int port() const { return port_; }
  // Starts accepting. Requires: the server is built.
  void Start();
  // Stops accepting and joins the thread; open connections stay with gRPC. Idempotent.
  void Shutdown();

 private:
  // A connection that gRPC owns. File descriptors are reused, so the socket's inode tells whether it is still open.
  struct OpenConnection {
    int file_descriptor;
    unsigned long inode;
  };

  GrpcListener(std::size_t max_connections, std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc);
  void Accept();
  void PassToGrpc(boost::asio::ip::tcp::socket socket);
  // Forgets closed connections if the limit is reached. True if one more connection is allowed.
  bool HasRoom();

  const std::size_t max_connections_;
  const std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc_;
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_timer_;
  int port_ = 0;
  std::list<OpenConnection> open_;
  std::thread thread_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_GRPC_LISTENER_H_
