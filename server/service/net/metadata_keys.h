// Names of HTTP headers and gRPC metadata that Phrenic defines, in lower case as HTTP/2 requires (RFC 9113
// section 8.2).
#ifndef PHRENIC_SERVER_SERVICE_NET_METADATA_KEYS_H_
#define PHRENIC_SERVER_SERVICE_NET_METADATA_KEYS_H_

namespace phrenic::service {

// The caller's IP address. The web gateway and the session router set it for calls that they make within the process;
// both remove it from what clients send. PeerOf reads it, for calls within the process only. Access rules, limits and
// the audit log rely on it.
inline constexpr char kPeerKey[] = "x-phrenic-peer";
// The session that a call is about; set by clients, read by the session router and by proxies. The router uses it only
// if the request has no session_id. List methods ignore it.
inline constexpr char kSessionKey[] = "x-session-id";
// The address of the server that forwarded the call. A forwarded call is never forwarded again. A client that sends it
// reaches this server alone: a session of another server is then UNAVAILABLE to it.
inline constexpr char kForwardedByKey[] = "x-phrenic-via";

// Names the claim by which the web gateway takes the messages of a WatchFrames call itself (watch/watch_claims.h). The
// gateway removes it from what clients send; a key that this server has not made has no effect.
inline constexpr char kWatchClaimKey[] = "x-phrenic-watch";

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_METADATA_KEYS_H_
