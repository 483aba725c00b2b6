#include "server/lti/platform.h"

#include <curl/curl.h>

#include <algorithm>
#include <map>
#include <memory>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/access/fetch.h"
#include "server/schema/file_bytes.h"

namespace phrenic::lti {
namespace {

constexpr std::size_t kMostAddressBytes = 2048;

absl::Status BadSetting(std::string_view field, std::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat(std::string(field), ": ", std::string(why)));
}

// Returns a part of an address; empty if it has none.
std::string PartOf(CURLU* address, CURLUPart part) {
  char* text = nullptr;
  if (curl_url_get(address, part, &text, 0) != CURLUE_OK || text == nullptr) return "";
  std::string copy = text;
  curl_free(text);
  return copy;
}

absl::Status CheckUrl(std::string_view field, const std::string& url) {
  if (url.empty()) return BadSetting(field, "missing; copy it from the platform's page about this tool");
  if (OriginOf(url).empty() || !access::IsSafeAddress(url)) {
    return BadSetting(field, absl::StrCat("\"", url, "\" must be an https:// address (http:// on loopback alone)"));
  }
  return absl::OkStatus();
}

absl::Status AddField(const std::string& name, const std::string& value, Platform& platform) {
  const std::map<std::string, std::string*> texts = {{"issuer", &platform.issuer},   {"client", &platform.client_id},
                                                     {"login", &platform.login_url}, {"token", &platform.token_url},
                                                     {"keys", &platform.keys_url},   {"audience", &platform.audience}};
  if (name == "deployment") {
    platform.deployments.insert(value);
    return absl::OkStatus();
  }
  if (name == "origin") {
    if (absl::Status status = CheckUrl(name, value); !status.ok()) return status;
    platform.origins.insert(OriginOf(value));
    return absl::OkStatus();
  }
  const auto found = texts.find(name);
  if (found == texts.end()) {
    return BadSetting(name, "unknown; the fields are issuer, client, deployment, login, token, keys, audience, origin");
  }
  if (!found->second->empty()) return BadSetting(name, "given twice");
  *found->second = value;
  return absl::OkStatus();
}

absl::Status CheckPlatform(const Platform& platform) {
  if (platform.issuer.empty())
    return BadSetting("issuer", "missing; it is the value of \"iss\" in the platform's tokens");
  if (platform.client_id.empty()) return BadSetting("client", "missing; the platform shows it once this tool is added");
  if (platform.deployments.empty()) return BadSetting("deployment", "missing; the platform shows it as deployment ID");
  for (const auto& [field, url] :
       {std::pair("login", &platform.login_url), {"token", &platform.token_url}, {"keys", &platform.keys_url}}) {
    if (absl::Status status = CheckUrl(field, *url); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status ReadLrs(const Options& options, Lrs& lrs) {
  if (options.lrs_url.empty()) return absl::OkStatus();
  if (absl::Status status = CheckUrl("--xapi-url", options.lrs_url); !status.ok()) return status;
  if (options.lrs_user.empty()) return BadSetting("--xapi-user", "required with --xapi-url");
  const auto password = ReadBytes(options.lrs_password_file);
  if (!password.has_value()) {
    return absl::NotFoundError(absl::StrCat("--xapi-password: cannot read the file \"", options.lrs_password_file,
                                            "\"; write the password into it"));
  }
  lrs = {options.lrs_url, options.lrs_user, std::string(absl::StripAsciiWhitespace(*password))};
  if (absl::EndsWith(lrs.url, "/")) lrs.url.pop_back();
  return absl::OkStatus();
}

}  // namespace

std::string OriginOf(std::string_view address) {
  const auto bad = [](unsigned char c) { return c <= ' ' || c == 0x7F || c == '\\'; };
  if (address.size() > kMostAddressBytes || std::any_of(address.begin(), address.end(), bad)) return "";
  const std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> parts(curl_url(), &curl_url_cleanup);
  if (curl_url_set(parts.get(), CURLUPART_URL, std::string(address).c_str(), 0) != CURLUE_OK) return "";
  const std::string scheme = PartOf(parts.get(), CURLUPART_SCHEME), port = PartOf(parts.get(), CURLUPART_PORT);
  const std::string host = absl::AsciiStrToLower(PartOf(parts.get(), CURLUPART_HOST));
  if ((scheme != "https" && scheme != "http") || host.empty() || !PartOf(parts.get(), CURLUPART_USER).empty())
    return "";
  // The host goes into a Content Security Policy.
  const auto in_host = [](char c) {
    return absl::ascii_isalnum(c) || absl::StrContains("-._:[]", absl::string_view(&c, 1));
  };
  if (!std::all_of(host.begin(), host.end(), in_host)) return "";
  const bool usual = port.empty() || port == (scheme == "https" ? "443" : "80");
  return usual ? absl::StrCat(scheme, "://", host) : absl::StrCat(scheme, "://", host, ":", port);
}

absl::StatusOr<Platform> ReadPlatform(std::string_view text) {
  Platform platform;
  const std::vector<std::string> words = absl::StrSplit(std::string(text), absl::ByAnyChar(" \t"), absl::SkipEmpty());
  for (const std::string& word : words) {
    const std::pair<std::string, std::string> field = absl::StrSplit(word, absl::MaxSplits('=', 1));
    if (field.second.empty()) return BadSetting(field.first, "write NAME=VALUE");
    if (absl::Status status = AddField(field.first, field.second, platform); !status.ok()) return status;
  }
  if (absl::Status status = CheckPlatform(platform); !status.ok()) return status;
  if (platform.audience.empty()) platform.audience = platform.token_url;
  for (const std::string& url : {platform.issuer, platform.login_url, platform.token_url, platform.keys_url}) {
    if (access::IsSafeAddress(url)) platform.origins.insert(OriginOf(url));
  }
  platform.origins.erase("");
  return platform;
}

absl::StatusOr<Settings> ReadSettings(const Options& options) {
  Settings settings;
  settings.url = OriginOf(options.url);
  if (settings.url.empty() || !access::IsSafeAddress(options.url)) {
    return BadSetting("--lti-url",
                      "required with --lti-platform: the address by which browsers reach this server, such "
                      "as https://phrenic.example.org");
  }
  for (std::size_t i = 0; i < options.platforms.size(); ++i) {
    auto platform = ReadPlatform(options.platforms[i]);
    if (!platform.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat("--lti-platform, number ", i + 1, ": ", platform.status().message()));
    }
    settings.platforms.push_back(*std::move(platform));
  }
  if (options.key_file.empty()) return BadSetting("--lti-key", "required with --lti-platform if nothing is saved");
  settings.key_file = options.key_file;
  if (absl::Status status = ReadLrs(options, settings.lrs); !status.ok()) return status;
  return settings;
}

absl::Status CheckAddress(const Platform& platform, std::string_view claim, std::string_view address) {
  const std::string origin = OriginOf(address);
  if (!origin.empty() && platform.origins.contains(origin) && access::IsSafeAddress(std::string(address))) {
    return absl::OkStatus();
  }
  return absl::PermissionDeniedError(
      absl::StrCat(std::string(claim), ": the platform names an address at \"", origin,
                   "\", which the settings do not allow; add origin=", origin.empty() ? "ORIGIN" : origin,
                   " to its --lti-platform if it belongs to the platform"));
}

}  // namespace phrenic::lti
