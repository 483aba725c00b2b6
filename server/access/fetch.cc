#include "server/access/fetch.h"

#include <curl/curl.h>

#include <array>
#include <memory>
#include <string_view>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMaxDocument = 1 << 20;  // [bytes]
constexpr long kTimeout = 10;                  // [s]

std::size_t Append(const char* bytes, std::size_t, std::size_t count, void* text) {
  auto& document = *static_cast<std::string*>(text);
  if (document.size() + count > kMaxDocument) return 0;
  document.append(bytes, count);
  return count;
}

// True if the host is loopback, where traffic cannot be intercepted on a network.
bool IsLoopbackUrl(const std::string& address) {
  std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> parts(curl_url(), &curl_url_cleanup);
  char* host = nullptr;
  if (curl_url_set(parts.get(), CURLUPART_URL, address.c_str(), 0) != CURLUE_OK) return false;
  if (curl_url_get(parts.get(), CURLUPART_HOST, &host, 0) != CURLUE_OK) return false;
  const std::string name = host;
  curl_free(host);
  return name == "127.0.0.1" || name == "[::1]" || name == "localhost";
}

}  // namespace

bool IsAddress(const std::string& text) {
  return absl::StartsWith(text, "https://") || absl::StartsWith(text, "http://");
}

absl::StatusOr<std::string> Fetch(const std::string& address) {
  const bool plain = absl::StartsWith(address, "http://");
  if (plain && !IsLoopbackUrl(address)) {
    return absl::InvalidArgumentError(absl::StrCat(address, ": http:// can be modified on the network; use https://"));
  }
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(curl_easy_init(), &curl_easy_cleanup);
  if (ready != CURLE_OK || curl == nullptr) return absl::UnavailableError("libcurl cannot be initialised");
  std::string text;
  std::array<char, CURL_ERROR_SIZE> why{};
  curl_easy_setopt(curl.get(), CURLOPT_URL, address.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_PROTOCOLS_STR, plain ? "http" : "https");
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, kTimeout);
  curl_easy_setopt(curl.get(), CURLOPT_ERRORBUFFER, why.data());
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, Append);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &text);
  const CURLcode code = curl_easy_perform(curl.get());
  if (code != CURLE_OK) {
    const std::string_view reason = why[0] == 0 ? curl_easy_strerror(code) : why.data();
    return absl::UnavailableError(
        absl::StrCat(address, ": cannot be read: ", absl::string_view(reason.data(), reason.size())));
  }
  long status = 0;
  curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  if (status == 200) return text;
  return absl::UnavailableError(absl::StrCat(address, ": returns HTTP status ", status, " instead of the document"));
}

}  // namespace phrenic::access
