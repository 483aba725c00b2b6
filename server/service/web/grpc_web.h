// The gRPC-web wire: messages and trailers as frames in an HTTP/1.1 body. Pure functions on bytes.
// Source: github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md
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

// "application/grpc-web+proto" and its kin.
bool IsGrpcWeb(std::string_view content_type);
// "application/grpc-web-text+proto": frames in base64.
bool IsGrpcWebText(std::string_view content_type);

// The only message in a request's body; INVALID_ARGUMENT when the body is not exactly one uncompressed frame.
absl::StatusOr<std::string> ParseRequestBody(std::string body, bool text);

// A frame's first five bytes: 0 for a message, then the length, big-endian.
std::array<char, 5> MessagePrefix(std::uint32_t length);

// The frame that ends a response: 0x80, length, "grpc-status: 5\r\ngrpc-message: there%20is%20no ...\r\n" and the
// server's own trailing metadata.
std::string TrailersFrame(const grpc::Status& status, const std::multimap<std::string, std::string>& metadata);

// "8000m" is eight seconds; nothing where it is no gRPC time-out.
std::optional<std::chrono::nanoseconds> ParseTimeout(std::string_view text);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_GRPC_WEB_H_
