#include "server/service/web/hosts.h"

#include <openssl/x509v3.h>

#include <algorithm>

#include "absl/strings/ascii.h"

namespace phrenic::service {
namespace {

namespace ip = boost::asio::ip;

bool IsPort(std::string_view text) {
  constexpr std::size_t kMaxDigits = 5;
  return text.size() <= kMaxDigits && std::all_of(text.begin(), text.end(), absl::ascii_isdigit);
}

bool IsName(std::string_view text) {
  constexpr std::size_t kMaxName = 255;
  const auto legal = [](char c) { return absl::ascii_isalnum(c) || c == '.' || c == '-' || c == '_'; };
  return !text.empty() && text.size() <= kMaxName && std::all_of(text.begin(), text.end(), legal);
}

// Returns the address, an IPv4-mapped one as IPv4; nullopt if `text` is a name.
std::optional<ip::address> AddressOf(const std::string& text) {
  boost::system::error_code error;
  const ip::address address = ip::make_address(text, error);
  if (error) return std::nullopt;
  if (address.is_v6() && address.to_v6().is_v4_mapped()) return ip::make_address_v4(ip::v4_mapped, address.to_v6());
  return address;
}

bool IsOnCertificate(const std::string& host, X509* certificate) {
  if (certificate == nullptr) return false;
  if (AddressOf(host).has_value()) return X509_check_ip_asc(certificate, host.c_str(), 0) == 1;
  return X509_check_host(certificate, host.data(), host.size(), 0, nullptr) == 1;
}

}  // namespace

std::optional<std::string> HostOf(std::string_view text) {
  const bool bracketed = !text.empty() && text[0] == '[';
  const std::size_t end = bracketed ? text.find(']') : text.find(':');
  if (bracketed && end == std::string_view::npos) return std::nullopt;
  const std::string host(bracketed ? text.substr(1, end - 1) : text.substr(0, end));
  const std::string_view rest = end == std::string_view::npos ? "" : text.substr(bracketed ? end + 1 : end);
  if (!rest.empty() && (rest[0] != ':' || !IsPort(rest.substr(1)))) return std::nullopt;
  const auto address = AddressOf(host);
  if (bracketed && (!address.has_value() || host.find('%') != std::string::npos)) return std::nullopt;
  if (!bracketed && !IsName(host)) return std::nullopt;
  return address.has_value() ? address->to_string() : absl::AsciiStrToLower(host);
}

AllowedHosts::AllowedHosts(const std::vector<std::string>& names, const std::vector<std::string>& origins,
                           const std::string& listen)
    : names_{"localhost", "127.0.0.1", "::1"} {
  for (const std::string& name : names) Add(name);
  for (const std::string& origin : origins) {
    const std::size_t scheme_end = origin.find("://");
    if (scheme_end != std::string::npos) Add(std::string_view(origin).substr(scheme_end + 3));
  }
  Add(listen);
}

// A wildcard address is no host that a client asks for.
void AllowedHosts::Add(std::string_view text) {
  const auto host = HostOf(text);
  if (host.has_value() && *host != "0.0.0.0" && *host != "::") names_.insert(*host);
}

bool AllowedHosts::Allow(std::string_view host, const ip::address& local, X509* certificate) const {
  const auto name = HostOf(host);
  if (!name.has_value()) return false;
  if (names_.contains(*name) || IsOnCertificate(*name, certificate)) return true;
  const auto address = AddressOf(*name);
  return address.has_value() && address == AddressOf(local.to_string());
}

}  // namespace phrenic::service
