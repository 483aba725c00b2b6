#include "server/access/fetch.h"

#include <curl/curl.h>

#include <array>
#include <memory>
#include <string_view>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMaxDocument = 1 << 20;  // [bytes]
constexpr std::size_t kMaxLinks = 1 << 16;     // [bytes]
constexpr long kTimeout = 10;                  // [s]

std::size_t Append(const char* bytes, std::size_t, std::size_t count, void* text) {
  auto& document = *static_cast<std::string*>(text);
  if (document.size() + count > kMaxDocument) return 0;
  document.append(bytes, count);
  return count;
}

// Keeps the headers Link, with ", " between them.
std::size_t ReadLink(const char* bytes, std::size_t, std::size_t count, void* text) {
  absl::string_view line(bytes, count);
  if (absl::StartsWithIgnoreCase(line, "link:")) {
    line.remove_prefix(5);
    auto& links = *static_cast<std::string*>(text);
    if (links.size() + count <= kMaxLinks) {
      absl::StrAppend(&links, links.empty() ? "" : ", ", absl::StripAsciiWhitespace(line));
    }
  }
  return count;
}

// Ends a transfer by another value than 0.
int IsCancelled(void* cancelled, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return *static_cast<const std::atomic<bool>*>(cancelled) ? 1 : 0;
}

// A list of headers for libcurl.
class Headers {
 public:
  explicit Headers(const std::vector<std::string>& headers) {
    for (const std::string& header : headers) list_ = curl_slist_append(list_, header.c_str());
  }
  ~Headers() { curl_slist_free_all(list_); }
  Headers(const Headers&) = delete;
  Headers& operator=(const Headers&) = delete;
  curl_slist* list() const { return list_; }

 private:
  curl_slist* list_ = nullptr;
};

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

bool IsSafeAddress(const std::string& text) {
  return absl::StartsWith(text, "https://") || (absl::StartsWith(text, "http://") && IsLoopbackUrl(text));
}

absl::StatusOr<HttpAnswer> Exchange(const HttpRequest& request) {
  const std::string& address = request.address;
  if (!IsSafeAddress(address)) {
    return absl::InvalidArgumentError(absl::StrCat(address, ": http:// can be modified on the network; use https://"));
  }
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(curl_easy_init(), &curl_easy_cleanup);
  if (ready != CURLE_OK || curl == nullptr) return absl::UnavailableError("libcurl cannot be initialised");
  HttpAnswer answer;
  std::array<char, CURL_ERROR_SIZE> why{};
  const Headers headers(request.headers);
  curl_easy_setopt(curl.get(), CURLOPT_URL, address.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_PROTOCOLS_STR, absl::StartsWith(address, "http://") ? "http" : "https");
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, kTimeout);
  curl_easy_setopt(curl.get(), CURLOPT_ERRORBUFFER, why.data());
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, Append);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &answer.body);
  curl_easy_setopt(curl.get(), CURLOPT_HEADERFUNCTION, ReadLink);
  curl_easy_setopt(curl.get(), CURLOPT_HEADERDATA, &answer.link);
  curl_easy_setopt(curl.get(), CURLOPT_HTTPHEADER, headers.list());
  if (request.post) {
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body.size()));
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDS, request.body.c_str());
  }
  if (request.cancelled != nullptr) {
    curl_easy_setopt(curl.get(), CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(curl.get(), CURLOPT_XFERINFOFUNCTION, IsCancelled);
    curl_easy_setopt(curl.get(), CURLOPT_XFERINFODATA, const_cast<std::atomic<bool>*>(request.cancelled));
  }
  const CURLcode code = curl_easy_perform(curl.get());
  if (code != CURLE_OK) {
    const std::string_view reason = why[0] == 0 ? curl_easy_strerror(code) : why.data();
    return absl::UnavailableError(absl::StrCat(address.substr(0, address.find('?')),
                                               ": cannot be read: ", absl::string_view(reason.data(), reason.size())));
  }
  curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &answer.status);
  return answer;
}

absl::StatusOr<std::string> Fetch(const std::string& address) {
  auto answer = Exchange({address});
  if (!answer.ok()) return answer.status();
  if (answer->status == 200) return std::move(answer->body);
  return absl::UnavailableError(
      absl::StrCat(address, ": returns HTTP status ", answer->status, " instead of the document"));
}

}  // namespace phrenic::access
