// Any bytes on a connection of the web gateway, heads and bodies: it answers and ends, and the calls that it makes are
// legal for gRPC, which aborts the process on metadata that are not.
#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/strand.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "server/service/web/web_connection.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kMaxBytes = 100'000;  // fit into the socket's buffer

// Answers every call with UNIMPLEMENTED.
class NoService final : public grpc::CallbackGenericService {};

// What connections share, for the life of the program.
struct Gateway {
  Gateway() {
    grpc::ServerBuilder builder;
    builder.RegisterCallbackGenericService(&service);
    server = builder.BuildAndStart();
    stub = std::make_unique<grpc::GenericStub>(server->InProcessChannel({}));
    settings.max_message_bytes = kMaxBytes;
    settings.known = [](const WebSettings::Credentials& credentials) {
      return credentials.authorization.empty() ? std::nullopt : std::optional<std::string>("");
    };
  }

  NoService service;
  std::unique_ptr<grpc::Server> server;
  std::unique_ptr<grpc::GenericStub> stub;
  WebSettings settings;
  AllowedHosts hosts{{}, {}, "127.0.0.1:80"};
  BodyBudget bodies{kMaxBytes, kMaxBytes};
  WatchClaims watches;
};

void Serve(Gateway& gateway, const std::string& bytes) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
  if (write(ends[1], bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
  shutdown(ends[1], SHUT_WR);
  boost::asio::io_context context;
  boost::asio::ip::tcp::socket socket(boost::asio::make_strand(context));
  socket.assign(boost::asio::ip::tcp::v4(), ends[0]);
  const WebShared shared{gateway.settings, gateway.hosts, *gateway.stub, gateway.bodies, gateway.watches};
  std::make_shared<WebConnection>(std::move(socket), nullptr, shared)->Run();
  context.run();
  close(ends[1]);
  if (gateway.bodies.used() != 0) std::abort();
}

}  // namespace
}  // namespace phrenic::service

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace phrenic::service;  // NOLINT: as the other targets' names
  static Gateway& gateway = *new Gateway;
  Serve(gateway, std::string(reinterpret_cast<const char*>(data), std::min(size, kMaxBytes)));
  return 0;
}
