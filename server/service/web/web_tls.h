// The TLS context of the web gateway, reloaded when its certificate files change.
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

// Not thread-safe. TLS 1.2 is the minimum version (RFC 8996).
class WebTls {
 public:
  explicit WebTls(TlsFiles files) : files_(std::move(files)) {}

  // Returns the context for a new connection, null if TLS is not used. Checks the files for changes at most every 10 s;
  // keeps the previous context if the new files are not valid.
  std::shared_ptr<boost::asio::ssl::context> Current();

 private:
  std::filesystem::file_time_type LastModified() const;

  const TlsFiles files_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::filesystem::file_time_type loaded_version_;  // modification time of the loaded files
  std::chrono::steady_clock::time_point last_checked_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_
