// Converts absl::Status to grpc::Status. Services convert here and nowhere else.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"

namespace phrenic::service {

// Keeps code and message; the codes of both have equal numbers.
inline grpc::Status ToGrpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  return {static_cast<grpc::StatusCode>(status.code()), std::string(status.message())};
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
