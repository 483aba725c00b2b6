#include "server/service/net/grpc_listener.h"

#include <sys/stat.h>
#include <unistd.h>

#include "server/service/net/listen.h"

namespace phrenic::service {
namespace {

using boost::asio::ip::tcp;
using ConnectionType = grpc::ServerBuilder::experimental_type::ExternalConnectionType;

// Which socket is behind a file; 0 where there is none. Numbers of files are used again, those of sockets are not.
unsigned long SocketOf(int file) {
  struct stat found {};
  return fstat(file, &found) == 0 && S_ISSOCK(found.st_mode) ? found.st_ino : 0;
}

}  // namespace

GrpcListener::GrpcListener(std::size_t max_connections,
                           std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> server)
    : max_connections_(max_connections), server_(std::move(server)), acceptor_(context_), pause_(context_) {}

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
      HandOver(std::move(socket));
      return Accept();
    }
    // Out of files, say: it will not be better at once.
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](boost::system::error_code) { Accept(); });
  });
}

bool GrpcListener::HasRoom() {
  if (handed_.size() < max_connections_) return true;
  handed_.remove_if([](const Handed& each) { return SocketOf(each.file) != each.socket; });
  return handed_.size() < max_connections_;
}

void GrpcListener::HandOver(tcp::socket socket) {
  if (!HasRoom()) return;  // closes it
  boost::system::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.non_blocking(true, ignored);
  EnableKeepalive(socket);
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
  connection.listener_fd = acceptor_.native_handle();
  connection.fd = socket.release(ignored);
  handed_.push_back({connection.fd, SocketOf(connection.fd)});
  server_->HandleNewConnection(&connection);
}

}  // namespace phrenic::service
