// The certificates of connections to Redis with TLS.
#ifndef PHRENIC_SERVER_CLUSTER_REDIS_TLS_FILES_H_
#define PHRENIC_SERVER_CLUSTER_REDIS_TLS_FILES_H_

#include <string>

namespace phrenic::cluster {

// Paths of PEM files (RFC 7468).
struct RedisTlsFiles {
  std::string ca;                // of Redis' certificate; empty: the authorities that the system trusts
  std::string certificate, key;  // of this server, which Redis may require; empty: none
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_REDIS_TLS_FILES_H_
