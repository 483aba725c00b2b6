// The TLS context of the web gateway, reloaded when its certificate files change.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "absl/status/statusor.h"
#include "server/service/net/tls.h"

namespace phrenic::service {

// Not thread-safe. TLS 1.2 is the minimum version (RFC 8996).
//
// The gateway owns it and asks it for each new connection, so a new certificate needs no restart. Clients must have a
// certificate of client_ca if that is given. Connections that are open keep the context with which they began.
class WebTls {
 public:
  // Reads nothing yet. Requires: CheckTls accepts the files.
  explicit WebTls(TlsFiles files) : files_(std::move(files)) {}

  // Returns the context for a new connection, null if TLS is not used. Checks the files for changes at most every 10 s;
  // keeps the previous context if the new files are not valid. Blocks on the disk when it checks. UNAVAILABLE if no
  // valid files were read yet: the connection must then not be served.
  absl::StatusOr<std::shared_ptr<boost::asio::ssl::context>> Current();

 private:
  // Returns the newest modification time of the files; a missing file does not count.
  std::filesystem::file_time_type LastModified() const;

  const TlsFiles files_;
  std::shared_ptr<boost::asio::ssl::context> context_;  // null: none was loaded
  std::filesystem::file_time_type loaded_version_;      // modification time of the loaded files
  std::chrono::steady_clock::time_point last_checked_;  // by Current
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_TLS_H_
