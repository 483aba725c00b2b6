// Encodes and decodes gRPC-web: messages and trailers as length-prefixed frames in an HTTP/1.1 body.
// Pure functions; any thread may call them. Protocol: github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md
#ifndef PHRENIC_SERVER_SERVICE_WEB_GRPC_WEB_H_
#define PHRENIC_SERVER_SERVICE_WEB_GRPC_WEB_H_

#include <grpcpp/support/status.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::service {

// True for "application/grpc-web", "application/grpc-web+proto" and the -text variants. Compares the beginning only,
// without regard to case.
bool IsGrpcWeb(std::string_view content_type);
// True for "application/grpc-web-text" and "-text+proto", whose frames are base64 (RFC 4648 section 4).
bool IsGrpcWebText(std::string_view content_type);

// Returns the message in a request body; `text` means base64. INVALID_ARGUMENT if the body is not exactly one
// uncompressed frame. The frame has 5 bytes before the message, which may be empty.
absl::StatusOr<std::string> ParseRequestBody(std::string body, bool text);

// Returns a message frame's header: flags 0, then the length [bytes], big-endian. The message follows it. Frames are
// binary here; WebConnection encodes them in base64 for the -text types.
std::array<char, 5> MessagePrefix(std::uint32_t length);

// Returns the frame that ends a response: flags 0x80, length, then "grpc-status: 5\r\ngrpc-message: ...\r\n" with the
// message percent-encoded, and the trailing metadata. Values of "-bin" metadata are base64. Without a message there is
// no grpc-message. A response ends with exactly one such frame, also after an error.
std::string TrailersFrame(const grpc::Status& status, const std::multimap<std::string, std::string>& metadata);

// Parses a grpc-timeout header such as "8000m" (8 s): 1 to 8 digits and a unit H, M, S, m, u or n. Returns nullopt if
// it is not valid. Hours above 1,000,000 count as 1,000,000, so that the number of nanoseconds fits. Without a header,
// the text is empty and the call has no deadline.
std::optional<std::chrono::nanoseconds> ParseTimeout(std::string_view text);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_GRPC_WEB_H_
