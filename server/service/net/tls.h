// Certificates: of the server, and of those who may call it.
#ifndef PHRENIC_SERVER_SERVICE_NET_TLS_H_
#define PHRENIC_SERVER_SERVICE_NET_TLS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

#include "absl/status/status.h"

namespace phrenic::service {

// Files in PEM.
struct TlsFiles {
  std::string certificate;  // the chain, the server's own first; empty: nothing is encrypted
  std::string key;
  std::string client_ca;  // every client must have a certificate of one of these; empty: none needs one

  bool used() const { return !certificate.empty(); }
};

// Reads the files and says what is wrong with them: NOT_FOUND or INVALID_ARGUMENT with the flag that names the file,
// and that the key does not belong to the certificate.
absl::Status CheckTls(const TlsFiles& files);

// For gRPC; those of files that change are read again within ten seconds.
std::shared_ptr<grpc::ServerCredentials> MakeCredentials(const TlsFiles& files);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_NET_TLS_H_
