#include "client/connection/context.h"

#include <string_view>

namespace phrenic::client {
namespace {

constexpr std::string_view kEncryptedScheme = "https://", kPlainScheme = "http://";

}  // namespace

std::string HostOf(const Context& context) {
  const std::string_view server = context.server;
  for (const std::string_view scheme : {kEncryptedScheme, kPlainScheme}) {
    if (server.starts_with(scheme)) return std::string(server.substr(scheme.size()));
  }
  return context.server;
}

bool IsEncrypted(const Context& context) {
  return context.server.starts_with(kEncryptedScheme) || !context.tls_ca.empty() || !context.tls_cert.empty();
}

}  // namespace phrenic::client
