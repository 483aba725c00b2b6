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

// Names in lower case; a name may have several values. Values of "-bin" names are bytes, not base64.
using Metadata = std::multimap<std::string, std::string>;

// The largest metadata of a call [bytes], counted as in RFC 9113 section 10.5.1: name, value and 32 for each. It is
// gRPC's own limit on what it receives.
inline constexpr std::size_t kMaxMetadataBytes = 8 << 10;

// Checks metadata by gRPC's rules (github.com/grpc/grpc/blob/master/doc/PROTOCOL-HTTP2.md): names of a-z, 0-9, "_", "-"
// and ".", that do not begin with "grpc-"; values of printable ASCII, any bytes if the name ends with "-bin". Stops at
// the first bad entry. INVALID_ARGUMENT shows 64 bytes of its name, escaped.
// Errors: INVALID_ARGUMENT, with the name; RESOURCE_EXHAUSTED above kMaxMetadataBytes. Thread-safe.
absl::Status CheckMetadata(const Metadata& metadata);

// Returns INVALID_ARGUMENT unless `method` has the form "/package.Service/Method". Thread-safe. Letters, digits, "_"
// and "." make up the parts. Does not ask whether there is such a method.
absl::Status CheckMethod(const std::string& method);

// Adds the metadata to a call to `method` that is not started. Adds nothing after an error: those of CheckMethod and
// CheckMetadata. UpstreamCall and WebCall call it before they start. The context copies the texts. Not thread-safe for
// one context.
absl::Status PrepareContext(const std::string& method, const Metadata& metadata, grpc::ClientContext& context);

// Returns the deadline of an incoming call; time_point::max() if the call has no deadline or one more than a year away.
// ServerContextBase::deadline() overflows for times beyond the year 2262, which a client may ask for. Forwarded calls
// carry it on. Requires: the call is not done.
std::chrono::system_clock::time_point DeadlineOf(const grpc::ServerContextBase& context);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_METADATA_H_
