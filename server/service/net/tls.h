// TLS certificates of the server and of its clients.
#ifndef PHRENIC_SERVER_SERVICE_NET_TLS_H_
#define PHRENIC_SERVER_SERVICE_NET_TLS_H_

#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

#include "absl/status/status.h"

namespace phrenic::service {

// Paths of PEM files (RFC 7468).
//
// Plain data, from the flags --tls-cert, --tls-key and --tls-client-ca. gRPC and the gateway read the files themselves.
struct TlsFiles {
  std::string certificate;  // the chain, leaf certificate first; empty: no TLS
  std::string key;          // private key of the leaf certificate
  std::string client_ca;    // CAs that client certificates must chain to (mutual TLS); empty: no client certificate

  bool used() const { return !certificate.empty(); }
};

// Reads and checks the files. Errors name the flag and the file: NOT_FOUND if a file is missing, INVALID_ARGUMENT if it
// is not PEM, if the key does not match the certificate, or if the flags are incomplete. OK if TLS is not used. Checks
// neither the dates of the certificate nor its chain: clients do. Blocks on the disk. The server calls it when it
// starts, and WebTls when a file has changed. Thread-safe.
absl::Status CheckTls(const TlsFiles& files);

// Returns gRPC server credentials, insecure ones if TLS is not used. gRPC reloads changed files every 10 s. With
// client_ca, a client without a certificate of that CA cannot connect. Requires: CheckTls accepts the files.
std::shared_ptr<grpc::ServerCredentials> MakeCredentials(const TlsFiles& files);

// Returns credentials with which this server calls the cluster's other servers: its own certificate, and `ca` to check
// theirs (empty: the authorities that the system trusts). Insecure ones if TLS is not used. gRPC reloads changed files
// every 10 s. For the channels of SessionRouter. Requires: CheckTls accepts the files.
std::shared_ptr<grpc::ChannelCredentials> MakePeerCredentials(const TlsFiles& files, const std::string& ca);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_TLS_H_
