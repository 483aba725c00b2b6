// Accepts connections for gRPC, no more than are allowed: gRPC itself takes any number, and where the process runs out
// of files it stops listening for good.
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

// Not thread-safe; a thread of its own accepts.
class GrpcListener {
 public:
  // Before the server is built: connections are handed to it once it is. The errors of ListenOn.
  static absl::StatusOr<std::unique_ptr<GrpcListener>> Make(const std::string& address, std::size_t max_connections,
                                                            std::shared_ptr<grpc::ServerCredentials> credentials,
                                                            grpc::ServerBuilder& builder);
  ~GrpcListener();

  int port() const { return port_; }
  // Once the server is built.
  void Start();
  // Accepts no more; a second call does nothing.
  void Shutdown();

 private:
  // A connection that gRPC has: its file, and which socket that was.
  struct Handed {
    int file;
    unsigned long socket;
  };

  GrpcListener(std::size_t max_connections, std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> server);
  void Accept();
  void HandOver(boost::asio::ip::tcp::socket socket);
  bool HasRoom();

  const std::size_t max_connections_;
  const std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> server_;
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  int port_ = 0;
  std::list<Handed> handed_;
  std::thread thread_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_GRPC_LISTENER_H_
