// TLS of the web gateway, with certificates that may change while it runs.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "server/service/net/tls.h"

namespace phrenic::service {

// Not thread-safe.
class WebTls {
 public:
  explicit WebTls(TlsFiles files) : files_(std::move(files)) {}

  // What a new connection uses; null: it is not encrypted. Files that changed are read again, at most every ten
  // seconds; where they are not good, the ones before stay.
  std::shared_ptr<boost::asio::ssl::context> Current();

 private:
  std::filesystem::file_time_type Changed() const;

  const TlsFiles files_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::filesystem::file_time_type changed_;
  std::chrono::steady_clock::time_point looked_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_
