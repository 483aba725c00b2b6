#include "server/service/web_gateway.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/strand.hpp>

#include "absl/strings/str_cat.h"
#include "server/service/address.h"

namespace phrenic::service {
namespace {

namespace net = boost::asio;
using net::ip::tcp;

constexpr int kThreads = 2;

absl::StatusOr<tcp::endpoint> Resolve(net::io_context& context, const std::string& address) {
  const absl::StatusOr<Address> parts = ParseAddress(address);
  if (!parts.ok()) return parts.status();
  tcp::resolver resolver(context);
  boost::system::error_code error;
  const auto found = resolver.resolve(parts->host, absl::StrCat(parts->port), tcp::resolver::passive, error);
  if (error || found.empty()) {
    return absl::UnavailableError(absl::StrCat(address, ": there is no such address on this machine"));
  }
  return found.begin()->endpoint();
}

// A peer that no longer answers is given up within 15 s, whether bytes are on their way to it or not.
void NoticeDeath(tcp::socket& socket) {
  constexpr int kOn = 1, kQuiet = 9, kBetween = 3, kProbes = 2;  // [s], [s]
  constexpr unsigned kUnanswered = 15'000;                       // [ms]
  const int handle = socket.native_handle();
  setsockopt(handle, SOL_SOCKET, SO_KEEPALIVE, &kOn, sizeof kOn);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPIDLE, &kQuiet, sizeof kQuiet);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPINTVL, &kBetween, sizeof kBetween);
  setsockopt(handle, IPPROTO_TCP, TCP_KEEPCNT, &kProbes, sizeof kProbes);
  setsockopt(handle, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUnanswered, sizeof kUnanswered);
}

}  // namespace

WebGateway::WebGateway(const Options& options, std::shared_ptr<grpc::Channel> channel)
    : options_(options), stub_(std::move(channel)), context_(kThreads), acceptor_(context_), pause_(context_) {}

absl::StatusOr<std::unique_ptr<WebGateway>> WebGateway::Start(const Options& options,
                                                              std::shared_ptr<grpc::Channel> channel) {
  std::unique_ptr<WebGateway> gateway(new WebGateway(options, std::move(channel)));
  if (absl::Status status = gateway->Listen(); !status.ok()) return status;
  gateway->AcceptNext();
  for (int i = 0; i < kThreads; ++i) {
    gateway->threads_.emplace_back([context = &gateway->context_] { context->run(); });
  }
  return gateway;
}

WebGateway::~WebGateway() { Shutdown(); }

absl::Status WebGateway::Listen() {
  const auto endpoint = Resolve(context_, options_.address);
  if (!endpoint.ok()) return endpoint.status();
  boost::system::error_code error;
  acceptor_.open(endpoint->protocol(), error);
  if (!error) acceptor_.set_option(net::socket_base::reuse_address(true), error);  // not while another one listens
  if (!error) acceptor_.bind(*endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (error) return CannotListen(options_.address, error.message());
  port_ = acceptor_.local_endpoint(error).port();
  return absl::OkStatus();
}

void WebGateway::Accept() {
  acceptor_.async_accept(net::make_strand(context_), [this](boost::system::error_code error, tcp::socket socket) {
    OnAccept(error, std::move(socket));
  });
}

void WebGateway::OnAccept(boost::system::error_code error, tcp::socket socket) {
  if (error == net::error::operation_aborted) return;
  if (!error) {
    boost::system::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    NoticeDeath(socket);
    const auto connection = std::make_shared<WebConnection>(std::move(socket), options_.settings, stub_);
    if (Admit(connection)) {
      connection->Run();
    } else {
      connection->Refuse();
    }
    return AcceptNext();
  }
  // Out of file descriptors, say: it will not be better at once.
  pause_.expires_after(std::chrono::milliseconds(100));
  pause_.async_wait([this](boost::system::error_code) { AcceptNext(); });
}

void WebGateway::AcceptNext() {
  absl::MutexLock lock(&mutex_);
  if (!closed_) Accept();
}

bool WebGateway::Admit(const std::shared_ptr<WebConnection>& connection) {
  absl::MutexLock lock(&mutex_);
  connections_.remove_if([](const std::weak_ptr<WebConnection>& other) { return other.expired(); });
  if (closed_ || connections_.size() >= options_.max_connections) return false;
  connections_.push_back(connection);
  return true;
}

void WebGateway::Shutdown() {
  std::list<std::weak_ptr<WebConnection>> connections;
  {
    absl::MutexLock lock(&mutex_);
    closed_ = true;
    connections.swap(connections_);
    boost::system::error_code ignored;
    acceptor_.close(ignored);
  }
  for (const auto& weak : connections) {
    if (const auto connection = weak.lock()) connection->Close();
  }
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace phrenic::service
