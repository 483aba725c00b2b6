// Converts absl::Status to grpc::Status. Services convert here and nowhere else.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_

#include <grpcpp/support/status.h>

#include <cstddef>
#include <string>
#include <utility>

#include "absl/status/status.h"

namespace phrenic::service {

// Keeps code and message; the codes of both have equal numbers. Cuts a message that quotes so much of a request that it
// would not fit into HTTP/2 trailers (8 KiB). Details of the status (payloads) are lost. The message is cut at 2 KiB,
// between two characters of UTF-8. Pure function, thread-safe.
inline grpc::Status ToGrpc(const absl::Status& status) {
  constexpr std::size_t kMostBytes = 2048;  // up to three times as many when they are escaped
  if (status.ok()) return grpc::Status::OK;
  std::string message(status.message());
  if (message.size() > kMostBytes) {
    std::size_t end = kMostBytes;
    while (end > 0 && (static_cast<unsigned char>(message[end]) & 0xC0U) == 0x80U) --end;  // between two characters
    message = message.substr(0, end) + " ...";
  }
  return {static_cast<grpc::StatusCode>(status.code()), message};
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
