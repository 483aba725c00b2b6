// The one place where errors become gRPC statuses.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"

namespace phrenic::service {

// The codes of both have the same numbers.
inline grpc::Status ToGrpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  return {static_cast<grpc::StatusCode>(status.code()), std::string(status.message())};
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_STATUS_H_
