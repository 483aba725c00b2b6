// The metadata and method of outgoing gRPC calls. gRPC aborts the process on metadata that its rules do not allow, so
// every call that carries what a client sent gets its metadata here.
#ifndef PHRENIC_SERVER_SERVICE_NET_METADATA_H_
#define PHRENIC_SERVER_SERVICE_NET_METADATA_H_

#include <grpcpp/client_context.h>
#include <grpcpp/server_context.h>

#include <map>
#include <string>

#include "absl/status/status.h"

namespace phrenic::service {

using Metadata = std::multimap<std::string, std::string>;

// The largest metadata of a call [bytes], counted as in RFC 9113 section 10.5.1: name, value and 32 for each. It is
// gRPC's own limit on what it receives.
inline constexpr std::size_t kMaxMetadataBytes = 8 << 10;

// Checks metadata by gRPC's rules (github.com/grpc/grpc/blob/master/doc/PROTOCOL-HTTP2.md): names of a-z, 0-9, "_", "-"
// and ".", that do not begin with "grpc-"; values of printable ASCII, any bytes if the name ends with "-bin".
// Errors: INVALID_ARGUMENT, with the name; RESOURCE_EXHAUSTED above kMaxMetadataBytes. Thread-safe.
absl::Status CheckMetadata(const Metadata& metadata);

// Returns INVALID_ARGUMENT unless `method` has the form "/package.Service/Method". Thread-safe.
absl::Status CheckMethod(const std::string& method);

// Adds the metadata to a call to `method` that is not started. Adds nothing after an error: those of CheckMethod and
// CheckMetadata.
absl::Status PrepareContext(const std::string& method, const Metadata& metadata, grpc::ClientContext& context);

// Returns the deadline of an incoming call; time_point::max() if it is more than a year away or if there is none.
// ServerContextBase::deadline() overflows for times beyond the year 2262, which a client may ask for.
std::chrono::system_clock::time_point DeadlineOf(const grpc::ServerContextBase& context);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_METADATA_H_
