// Serves the viewer's files and gRPC-web over HTTP/1.1 inside the server process, without a proxy.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_GATEWAY_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_GATEWAY_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/channel.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/service/web/web_connection.h"
#include "server/service/web/web_tls.h"

namespace phrenic::service {

// Thread-safe. Two threads of its own serve all connections, each connection on its own strand.
class WebGateway {
 public:
  struct Options {
    std::string address;  // "127.0.0.1:8080", "[::1]:8080"; the system chooses the port if it is 0
    WebSettings settings;
    std::size_t max_connections = 0;
    TlsFiles tls;
  };

  // Listens and serves; gRPC-web calls go to `channel`. Errors: those of ListenOn.
  static absl::StatusOr<std::unique_ptr<WebGateway>> Start(const Options& options,
                                                           std::shared_ptr<grpc::Channel> channel);
  ~WebGateway();

  int port() const { return port_; }
  // Closes all connections, cancels their calls and joins the threads. Idempotent.
  void Shutdown() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  WebGateway(const Options& options, std::shared_ptr<grpc::Channel> channel);
  absl::Status Listen();
  void Accept() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void AcceptNext() ABSL_LOCKS_EXCLUDED(mutex_);
  void RunThread();
  void OnAccept(boost::system::error_code error, boost::asio::ip::tcp::socket socket);
  // Adds a connection. False if the limit is reached and CloseLongestIdle finds none to close.
  bool Admit(const std::shared_ptr<WebConnection>& connection) ABSL_LOCKS_EXCLUDED(mutex_);
  // Closes the connection that has waited longest for a request. False if all are being answered.
  bool CloseLongestIdle() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Options options_;
  const AllowedHosts hosts_;
  grpc::GenericStub stub_;
  BodyBudget bodies_;
  const WebShared shared_;
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_;  // used by one thread at a time, or with mutex_ held
  boost::asio::steady_timer retry_timer_;
  int port_ = 0;
  WebTls tls_;  // used by one thread at a time, as acceptor_
  absl::Mutex mutex_;
  std::list<std::weak_ptr<WebConnection>> connections_ ABSL_GUARDED_BY(mutex_);
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_GATEWAY_H_
