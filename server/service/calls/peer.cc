#include "server/service/calls/peer.h"

#include <string_view>

#include "absl/strings/match.h"
#include "absl/strings/str_replace.h"
#include "server/service/net/metadata_keys.h"

namespace phrenic::service {

// gRPC's peer is "ipv4:192.0.2.1:5000" or "ipv6:%5B2001:db8::1%5D:5000"; "inproc" or "unknown" in process.
std::string PeerOf(const grpc::ServerContextBase& context) {
  const std::string peer = context.peer();
  if (!absl::StartsWith(peer, "ipv4:") && !absl::StartsWith(peer, "ipv6:")) {
    const auto named = context.client_metadata().find(kPeerKey);
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
