// TLS on the socket of a hiredis connection, because hiredis 0.14 has none.
#ifndef PHRENIC_SERVER_CLUSTER_REDIS_TLS_H_
#define PHRENIC_SERVER_CLUSTER_REDIS_TLS_H_

#include <openssl/ssl.h>

#include <cstddef>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/cluster/redis_tls_files.h"

struct redisReader;
struct redisReply;

namespace phrenic::cluster {

// Not thread-safe. TLS 1.2 is the minimum version (RFC 8996). The socket's timeouts apply to every read and write.
class RedisTls {
 public:
  // Performs the handshake. UNAVAILABLE if it fails, if `host` is not a name of Redis' certificate, or if no CA in
  // `files` signed that; INVALID_ARGUMENT, with the file, if a file cannot be used.
  static absl::StatusOr<std::unique_ptr<RedisTls>> Connect(int socket, const std::string& host,
                                                           const RedisTlsFiles& files);

  // Sends a command and returns the reply, which the caller frees; null if the connection fails or times out.
  redisReply* Exchange(redisReader& reader, int words, const char** texts, const std::size_t* sizes);

 private:
  template <class T, void (*kFree)(T*)>
  struct Free {
    void operator()(T* object) const { kFree(object); }
  };
  using Context = std::unique_ptr<SSL_CTX, Free<SSL_CTX, &SSL_CTX_free>>;
  using Stream = std::unique_ptr<SSL, Free<SSL, &SSL_free>>;

  explicit RedisTls(Stream stream) : stream_(std::move(stream)) {}
  // Returns a context that verifies the peer by the authorities in `files`. INVALID_ARGUMENT names a bad file.
  static absl::StatusOr<Context> MakeContext(const RedisTlsFiles& files);
  // Writes all bytes. False if the connection fails or times out.
  bool Write(const char* bytes, std::size_t size);

  Stream stream_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_REDIS_TLS_H_
