#include "server/service/net/grpc_listener.h"

#include <sys/stat.h>
#include <unistd.h>

#include "server/service/net/listen.h"

namespace phrenic::service {
namespace {

using boost::asio::ip::tcp;
using ConnectionType = grpc::ServerBuilder::experimental_type::ExternalConnectionType;

// Returns the inode of the socket behind a file descriptor; 0 if it is not a socket.
unsigned long SocketInode(int file_descriptor) {
  struct stat found {};
  return fstat(file_descriptor, &found) == 0 && S_ISSOCK(found.st_mode) ? found.st_ino : 0;
}

}  // namespace

GrpcListener::GrpcListener(std::size_t max_connections,
                           std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc)
    : max_connections_(max_connections), grpc_(std::move(grpc)), acceptor_(context_), retry_timer_(context_) {}

absl::StatusOr<std::unique_ptr<GrpcListener>> GrpcListener::Make(const std::string& address,
                                                                 std::size_t max_connections,
                                                                 std::shared_ptr<grpc::ServerCredentials> credentials,
                                                                 grpc::ServerBuilder& builder) {
  std::unique_ptr<GrpcListener> listener(new GrpcListener(
      max_connections,
      builder.experimental().AddExternalConnectionAcceptor(ConnectionType::FROM_FD, std::move(credentials))));
  const auto port = ListenOn(address, listener->acceptor_);
  if (!port.ok()) return port.status();
  listener->port_ = *port;
  return listener;
}

GrpcListener::~GrpcListener() { Shutdown(); }

void GrpcListener::Start() {
  Accept();
  thread_ = std::thread([this] { context_.run(); });
}

void GrpcListener::Shutdown() {
  context_.stop();
  if (thread_.joinable()) thread_.join();
  boost::system::error_code ignored;
  acceptor_.close(ignored);
}

void GrpcListener::Accept() {
  acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == boost::asio::error::operation_aborted) return;
    if (!error) {
      PassToGrpc(std::move(socket));
      return Accept();
    }
    retry_timer_.expires_after(kAcceptRetry);
    retry_timer_.async_wait([this](boost::system::error_code) { Accept(); });
  });
}

bool GrpcListener::HasRoom() {
  if (open_.size() < max_connections_) return true;
  open_.remove_if([](const OpenConnection& each) { return SocketInode(each.file_descriptor) != each.inode; });
  return open_.size() < max_connections_;
}

void GrpcListener::PassToGrpc(tcp::socket socket) {
  if (!HasRoom()) return;  // the destructor closes the socket
  boost::system::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.non_blocking(true, ignored);
  EnableKeepalive(socket);
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
  connection.listener_fd = acceptor_.native_handle();
  connection.fd = socket.release(ignored);
  open_.push_back({connection.fd, SocketInode(connection.fd)});
  grpc_->HandleNewConnection(&connection);
}

}  // namespace phrenic::service
