#include "server/service/web/web_tls.h"

#include <algorithm>

namespace phrenic::service {
namespace {

namespace ssl = boost::asio::ssl;

constexpr std::chrono::seconds kReloadInterval(10);

// Returns null if a file is not valid.
std::shared_ptr<ssl::context> MakeContext(const TlsFiles& files) {
  if (!CheckTls(files).ok()) return nullptr;
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  boost::system::error_code error;
  context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1, error);
  context->use_certificate_chain_file(files.certificate, error);
  if (!error) context->use_private_key_file(files.key, ssl::context::pem, error);
  if (!error && !files.client_ca.empty()) {
    context->load_verify_file(files.client_ca, error);
    context->set_verify_mode(ssl::verify_peer | ssl::verify_fail_if_no_peer_cert);
  }
  return error ? nullptr : context;
}

}  // namespace

std::filesystem::file_time_type WebTls::LastModified() const {
  std::filesystem::file_time_type newest = std::filesystem::file_time_type::min();
  std::error_code ignored;
  for (const std::string& file : {files_.certificate, files_.key, files_.client_ca}) {
    if (!file.empty()) newest = std::max(newest, std::filesystem::last_write_time(file, ignored));
  }
  return newest;
}

absl::StatusOr<std::shared_ptr<ssl::context>> WebTls::Current() {
  if (!files_.used()) return nullptr;
  const auto now = std::chrono::steady_clock::now();
  if (context_ != nullptr && now - last_checked_ < kReloadInterval) return context_;
  last_checked_ = now;
  const auto modified = LastModified();
  if (context_ != nullptr && modified == loaded_version_) return context_;
  if (auto reloaded = MakeContext(files_); reloaded != nullptr) {
    context_ = std::move(reloaded);
    loaded_version_ = modified;
  }
  if (context_ == nullptr) return absl::UnavailableError("the certificate files cannot be used");
  return context_;
}

}  // namespace phrenic::service
