#include "server/service/net/tls.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <filesystem>

#include "absl/strings/str_cat.h"

namespace phrenic::service {
namespace {

constexpr unsigned kReloadSeconds = 10;

absl::Status CheckFile(const char* flag, const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return absl::OkStatus();
  return absl::NotFoundError(absl::StrCat(flag, ": no such file: ", file));
}

absl::Status OpenSslError(const char* flag, const std::string& file, const char* problem) {
  char text[256];
  ERR_error_string_n(ERR_get_error(), text, sizeof text);
  ERR_clear_error();
  return absl::InvalidArgumentError(absl::StrCat(flag, ": ", file, " ", problem, " (", text, ")"));
}

}  // namespace

absl::Status CheckTls(const TlsFiles& files) {
  if (!files.used()) {
    if (files.key.empty() && files.client_ca.empty()) return absl::OkStatus();
    return absl::InvalidArgumentError("--tls-cert: required with --tls-key or --tls-client-ca");
  }
  if (files.key.empty()) return absl::InvalidArgumentError("--tls-key: required with --tls-cert");
  if (absl::Status status = CheckFile("--tls-cert", files.certificate); !status.ok()) return status;
  if (absl::Status status = CheckFile("--tls-key", files.key); !status.ok()) return status;
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_server_method()), &SSL_CTX_free);
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1) {
    return OpenSslError("--tls-cert", files.certificate, "contains no certificate in PEM");
  }
  if (SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(context.get()) != 1) {
    return OpenSslError("--tls-key", files.key, "is not the private key of the certificate in PEM");
  }
  if (files.client_ca.empty()) return absl::OkStatus();
  if (absl::Status status = CheckFile("--tls-client-ca", files.client_ca); !status.ok()) return status;
  if (SSL_CTX_load_verify_locations(context.get(), files.client_ca.c_str(), nullptr) == 1) return absl::OkStatus();
  return OpenSslError("--tls-client-ca", files.client_ca, "contains no certificate in PEM");
}

std::shared_ptr<grpc::ServerCredentials> MakeCredentials(const TlsFiles& files) {
  if (!files.used()) return grpc::InsecureServerCredentials();
  namespace tls = grpc::experimental;
  const auto provider = std::make_shared<tls::FileWatcherCertificateProvider>(files.key, files.certificate,
                                                                              files.client_ca, kReloadSeconds);
  tls::TlsServerCredentialsOptions options(provider);
  options.watch_identity_key_cert_pairs();
  if (files.client_ca.empty()) {
    options.set_cert_request_type(GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
  } else {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return tls::TlsServerCredentials(options);
}

std::shared_ptr<grpc::ChannelCredentials> MakePeerCredentials(const TlsFiles& files, const std::string& ca) {
  if (!files.used()) return grpc::InsecureChannelCredentials();
  namespace tls = grpc::experimental;
  tls::TlsChannelCredentialsOptions options;
  options.set_certificate_provider(
      std::make_shared<tls::FileWatcherCertificateProvider>(files.key, files.certificate, ca, kReloadSeconds));
  options.watch_identity_key_cert_pairs();
  if (!ca.empty()) options.watch_root_certs();
  return tls::TlsCredentials(options);
}

}  // namespace phrenic::service
