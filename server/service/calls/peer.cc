#include "server/service/calls/peer.h"

#include <string_view>

#include "absl/strings/match.h"
#include "absl/strings/str_replace.h"
#include "server/service/web/web_headers.h"

namespace phrenic::service {

// gRPC writes "ipv4:192.0.2.1:5000", "ipv6:%5B2001:db8::1%5D:5000", and "inproc" or "unknown" within the process.
std::string PeerOf(const grpc::ServerContextBase& context) {
  const std::string peer = context.peer();
  if (!absl::StartsWith(peer, "ipv4:") && !absl::StartsWith(peer, "ipv6:")) {
    const auto named = context.client_metadata().find(kPeerHeader);
    return named == context.client_metadata().end() ? "" : std::string(named->second.data(), named->second.size());
  }
  std::string host = peer.substr(5, peer.rfind(':') - 5);
  host = absl::StrReplaceAll(host, {{"%5B", ""}, {"%5D", ""}, {"[", ""}, {"]", ""}});
  return host;
}

bool IsThisMachine(const std::string& peer) {
  return peer.empty() || peer == "::1" || absl::StartsWith(peer, "127.") || absl::StartsWith(peer, "::ffff:127.");
}

}  // namespace phrenic::service
