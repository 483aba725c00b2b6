// Any bytes as a gRPC-web request body, binary or base64, give one message or an error. Any text as a timeout or an
// address gives a valid one or an error.
#include "server/service/web/grpc_web.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "absl/strings/escaping.h"
#include "server/service/net/address.h"

namespace phrenic::service {
namespace {

std::string Framed(const std::string& message) {
  const auto prefix = MessagePrefix(static_cast<std::uint32_t>(message.size()));
  return std::string(prefix.data(), prefix.size()) + message;
}

void TryBody(const std::string& body) {
  const auto message = ParseRequestBody(body, false);
  if (message.ok() && Framed(*message) != body) std::abort();
}

void TryText(const std::string& body) {
  const auto message = ParseRequestBody(body, true);
  std::string bytes;
  if (message.ok() && (!absl::Base64Unescape(body, &bytes) || Framed(*message) != bytes)) std::abort();
}

void TryHeaders(const std::string& text) {
  const auto timeout = ParseTimeout(text);
  if (timeout.has_value() && timeout->count() < 0) std::abort();
  const auto address = ParseAddress(text);
  if (address.ok() && (address->port < 0 || address->port > 65535)) std::abort();
}

}  // namespace
}  // namespace phrenic::service

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  phrenic::service::TryBody(bytes);
  phrenic::service::TryText(bytes);
  phrenic::service::TryHeaders(bytes);
  return 0;
}
