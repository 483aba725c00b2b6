// What the settings say of learning platforms (LTI 1.3) and of a store of learning records (xAPI).
#ifndef PHRENIC_SERVER_LTI_PLATFORM_H_
#define PHRENIC_SERVER_LTI_PLATFORM_H_

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::lti {

// The flags of phrenicd. Without platforms there is no LTI.
struct Options {
  std::string url;                     // origin by which browsers reach this server, "https://phrenic.example.org"
  std::vector<std::string> platforms;  // each as ReadPlatform reads it
  std::string key_file;                // private keys of this server; made if it is missing
  std::string lrs_url = "", lrs_user = "", lrs_password_file = "";  // empty: no xAPI statements

  bool used() const { return !platforms.empty(); }
};

// A learning platform, such as one school's Moodle, with which this server is registered.
struct Platform {
  std::string issuer;                 // required value of "iss"
  std::string client_id;              // that the platform gave to this server
  std::set<std::string> deployments;  // accepted values of "deployment_id"
  std::string login_url;              // OpenID Connect authentication request
  std::string token_url;              // OAuth 2 access tokens
  std::string keys_url;               // JSON Web Key Set
  std::string audience;               // of this server's assertions; token_url unless the settings name another
  // Where this server sends requests and forms, and which pages may frame the viewer: the origins of the addresses
  // above, and those that the settings add.
  std::set<std::string> origins;
};

// A store of learning records.
struct Lrs {
  std::string url, user, password;
  bool used() const { return !url.empty(); }
};

// What Options say, checked.
struct Settings {
  std::string url;
  std::vector<Platform> platforms;
  std::string key_file;
  Lrs lrs;
};

// Returns the origin of an address, "https://host:port" in lower case and without a default port; empty unless the
// address begins with https:// or http:// and has no user, control characters or spaces. Thread-safe.
std::string OriginOf(std::string_view address);

// Reads "issuer=... client=... deployment=... login=... token=... keys=...", with optional "audience=..." and any
// number of further "deployment=" and "origin=". INVALID_ARGUMENT names the field.
absl::StatusOr<Platform> ReadPlatform(std::string_view text);

// INVALID_ARGUMENT names the flag; NOT_FOUND if the password file cannot be read.
absl::StatusOr<Settings> ReadSettings(const Options& options);

// Returns OK if this server may send requests to an address that a platform's token names: one of the platform's
// origins. PERMISSION_DENIED names the claim, the origin and the remedy.
absl::Status CheckAddress(const Platform& platform, std::string_view claim, std::string_view address);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_PLATFORM_H_
