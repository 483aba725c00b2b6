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
//
// The server owns it if it has a --web address. A chain of accepts runs on one of the threads at a time. An exception
// that a handler throws ends its connection and no other. mutex_ guards the list of connections, and the acceptor
// against Shutdown.
class WebGateway {
 public:
  // Plain data; they do not change. max_connections counts all open connections.
  struct Options {
    std::string address;  // "127.0.0.1:8080", "[::1]:8080"; the system chooses the port if it is 0
    WebSettings settings;
    std::size_t max_connections = 0;
    TlsFiles tls;
  };

  // Listens and serves; gRPC-web calls go to `channel`. Errors: those of ListenOn. The channel is to the gRPC server of
  // the same process; a message may be as large as that allows. The messages of WatchFrames are taken by `watches`,
  // which outlives the gateway. Requires: CheckTls accepts the files.
  static absl::StatusOr<std::unique_ptr<WebGateway>> Start(const Options& options,
                                                           std::shared_ptr<grpc::Channel> channel,
                                                           WatchClaims& watches);
  // Calls Shutdown.
  ~WebGateway();

  // Returns the port in use. Constant, thread-safe.
  int port() const { return port_; }
  // Closes all connections, cancels their calls and joins the threads. Idempotent. Waits until gRPC has ended the
  // cancelled calls. One thread at a time; not a thread of the gateway.
  void Shutdown() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  WebGateway(const Options& options, std::shared_ptr<grpc::Channel> channel, WatchClaims& watches);
  // The errors of ListenOn.
  absl::Status Listen();
  // Waits for the next connection, without blocking.
  void Accept() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // The same, unless the gateway is shut down.
  void AcceptNext() ABSL_LOCKS_EXCLUDED(mutex_);
  // Runs handlers until Shutdown and the last connection's end.
  void RunThread();
  // Serves the connection, or refuses it if there is no room. After an error it tries again after kAcceptRetry.
  void OnAccept(boost::system::error_code error, boost::asio::ip::tcp::socket socket);
  // Adds a connection. False if the limit is reached and CloseLongestIdle finds none to close.
  bool Admit(const std::shared_ptr<WebConnection>& connection) ABSL_LOCKS_EXCLUDED(mutex_);
  // Closes the connection that has waited longest for a request. False if all are being answered.
  bool CloseLongestIdle() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Options options_;
  const AllowedHosts hosts_;
  grpc::GenericStub stub_;
  BodyBudget bodies_;
  const WebShared shared_;  // refers to those above
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_;  // used by one thread at a time, or with mutex_ held
  boost::asio::steady_timer retry_timer_;    // after an error of accept
  int port_ = 0;
  WebTls tls_;  // used by one thread at a time, as acceptor_
  absl::Mutex mutex_;
  std::list<std::weak_ptr<WebConnection>> connections_ ABSL_GUARDED_BY(mutex_);  // with some that have ended
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;                                  // Shutdown has begun
  std::vector<std::thread> threads_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_GATEWAY_H_
