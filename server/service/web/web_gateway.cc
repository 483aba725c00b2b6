#include "server/service/web/web_gateway.h"

#include <spdlog/spdlog.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/strand.hpp>
#include <exception>

#include "server/service/net/listen.h"

namespace phrenic::service {
namespace {

namespace net = boost::asio;
using net::ip::tcp;

constexpr int kGatewayThreads = 2;
constexpr std::size_t kBodies = 4;  // longest messages that are received at a time; half of them from one caller

}  // namespace

WebGateway::WebGateway(const Options& options, std::shared_ptr<grpc::Channel> channel, WatchClaims& watches)
    : options_(options),
      hosts_(options.settings.allowed_hosts, options.settings.allowed_origins, options.address),
      stub_(std::move(channel)),
      bodies_(kBodies * options.settings.max_message_bytes, kBodies / 2 * options.settings.max_message_bytes),
      shared_{options_.settings, hosts_, stub_, bodies_, watches},
      context_(kGatewayThreads),
      acceptor_(context_),
      retry_timer_(context_),
      tls_(options.tls) {}

absl::StatusOr<std::unique_ptr<WebGateway>> WebGateway::Start(const Options& options,
                                                              std::shared_ptr<grpc::Channel> channel,
                                                              WatchClaims& watches) {
  std::unique_ptr<WebGateway> gateway(new WebGateway(options, std::move(channel), watches));
  if (absl::Status status = gateway->Listen(); !status.ok()) return status;
  gateway->AcceptNext();
  for (int i = 0; i < kGatewayThreads; ++i) {
    gateway->threads_.emplace_back([gateway = gateway.get()] { gateway->RunThread(); });
  }
  return gateway;
}

// An exception, such as std::bad_alloc, ends the connection whose handler throws it and no other.
void WebGateway::RunThread() {
  while (true) {
    try {
      context_.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("a web connection was closed: {}", error.what());
    }
  }
}

WebGateway::~WebGateway() { Shutdown(); }

absl::Status WebGateway::Listen() {
  const auto port = ListenOn(options_.address, acceptor_);
  if (port.ok()) port_ = *port;
  return port.status();
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
    EnableKeepalive(socket);
    const auto tls = tls_.Current();
    if (!tls.ok()) return AcceptNext();  // closes the connection: nothing is served without the TLS that was asked for
    const auto connection = std::make_shared<WebConnection>(std::move(socket), *tls, shared_);
    if (Admit(connection)) {
      connection->Run();
    } else {
      connection->Refuse();
    }
    return AcceptNext();
  }
  retry_timer_.expires_after(kAcceptRetry);
  retry_timer_.async_wait([this](boost::system::error_code) { AcceptNext(); });
}

void WebGateway::AcceptNext() {
  absl::MutexLock lock(&mutex_);
  if (!closed_) Accept();
}

bool WebGateway::Admit(const std::shared_ptr<WebConnection>& connection) {
  absl::MutexLock lock(&mutex_);
  connections_.remove_if([](const std::weak_ptr<WebConnection>& other) { return other.expired(); });
  if (closed_ || (connections_.size() >= options_.max_connections && !CloseLongestIdle())) return false;
  connections_.push_back(connection);
  return true;
}

bool WebGateway::CloseLongestIdle() {
  auto longest = connections_.end();
  auto since = std::chrono::steady_clock::time_point::max();
  for (auto each = connections_.begin(); each != connections_.end(); ++each) {
    const auto connection = each->lock();
    if (connection == nullptr || connection->waiting_since() >= since) continue;
    since = connection->waiting_since();
    longest = each;
  }
  if (longest == connections_.end()) return false;
  if (const auto connection = longest->lock()) connection->Close();
  connections_.erase(longest);
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
