#include "server/cluster/redis_tls.h"

#include <hiredis/hiredis.h>
#include <openssl/err.h>
#include <openssl/x509v3.h>

#include "absl/strings/str_cat.h"

namespace phrenic::cluster {
namespace {

absl::Status BadTlsFile(const std::string& file) {
  ERR_clear_error();
  return absl::InvalidArgumentError(absl::StrCat(file, " cannot be used for TLS"));
}

absl::Status HandshakeError(const SSL& stream) {
  const long verified = SSL_get_verify_result(&stream);
  const char* why = verified == X509_V_OK ? "the TLS handshake failed" : X509_verify_cert_error_string(verified);
  ERR_clear_error();
  return absl::UnavailableError(why);
}

// Requires the certificate to have this name or address.
bool ExpectHost(SSL& stream, const std::string& host) {
  if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(&stream), host.c_str()) == 1) return true;
  ERR_clear_error();
  return SSL_set1_host(&stream, host.c_str()) == 1 && SSL_set_tlsext_host_name(&stream, host.c_str()) == 1;
}

}  // namespace

absl::StatusOr<RedisTls::Context> RedisTls::MakeContext(const RedisTlsFiles& files) {
  Context context(SSL_CTX_new(TLS_client_method()));
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  const int trusted = files.ca.empty() ? SSL_CTX_set_default_verify_paths(context.get())
                                       : SSL_CTX_load_verify_locations(context.get(), files.ca.c_str(), nullptr);
  if (trusted != 1) return BadTlsFile(files.ca);
  if (files.certificate.empty()) return context;
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1) {
    return BadTlsFile(files.certificate);
  }
  const bool usable = SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) == 1;
  return usable ? absl::StatusOr<Context>(std::move(context)) : BadTlsFile(files.key);
}

absl::StatusOr<std::unique_ptr<RedisTls>> RedisTls::Connect(int socket, const std::string& host,
                                                            const RedisTlsFiles& files) {
  auto context = MakeContext(files);
  if (!context.ok()) return context.status();
  Stream stream(SSL_new(context->get()));
  if (!ExpectHost(*stream, host) || SSL_set_fd(stream.get(), socket) != 1 || SSL_connect(stream.get()) != 1) {
    return HandshakeError(*stream);
  }
  return std::unique_ptr<RedisTls>(new RedisTls(std::move(stream)));
}

bool RedisTls::Write(const char* bytes, std::size_t size) {
  std::size_t written = 0;
  const bool ok = SSL_write_ex(stream_.get(), bytes, size, &written) == 1;
  ERR_clear_error();
  return ok;  // all of it, since partial writes are not enabled
}

redisReply* RedisTls::Exchange(redisReader& reader, int words, const char** texts, const std::size_t* sizes) {
  constexpr std::size_t kPiece = 16 << 10;
  char* command = nullptr;
  const int length = redisFormatCommandArgv(&command, words, texts, sizes);
  if (length < 0) return nullptr;
  const bool sent = Write(command, static_cast<std::size_t>(length));
  redisFreeCommand(command);
  void* reply = nullptr;
  char piece[kPiece];
  while (sent && redisReaderGetReply(&reader, &reply) == REDIS_OK && reply == nullptr) {
    std::size_t got = 0;
    const bool received = SSL_read_ex(stream_.get(), piece, sizeof piece, &got) == 1;
    ERR_clear_error();
    if (!received || redisReaderFeed(&reader, piece, got) != REDIS_OK) break;
  }
  return static_cast<redisReply*>(reply);
}

}  // namespace phrenic::cluster
