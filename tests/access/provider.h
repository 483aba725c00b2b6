// An identity provider with its own RSA key, which signs tokens.
#ifndef PHRENIC_TESTS_ACCESS_PROVIDER_H_
#define PHRENIC_TESTS_ACCESS_PROVIDER_H_

#include <cjose/cjose.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace phrenic::access {

class Provider {
 public:
  Provider() : key_(cjose_jwk_create_RSA_random(2048, nullptr, 0, &error_)) {}
  ~Provider() { cjose_jwk_release(key_); }
  Provider(const Provider&) = delete;
  Provider& operator=(const Provider&) = delete;

  nlohmann::json PublicKey() {
    char* text = cjose_jwk_to_json(key_, false, &error_);
    nlohmann::json key = nlohmann::json::parse(text);
    free(text);
    return key;
  }
  // `more` are further texts of the header.
  std::string Sign(const nlohmann::json& claims, const std::map<std::string, std::string>& more = {}) {
    return SignWith(key_, "RS256", claims, more);
  }
  static std::string SignWith(cjose_jwk_t* key, const char* algorithm, const nlohmann::json& claims,
                              const std::map<std::string, std::string>& more = {}) {
    cjose_err error;
    cjose_header_t* header = cjose_header_new(&error);
    cjose_header_set(header, CJOSE_HDR_ALG, algorithm, &error);
    for (const auto& [name, value] : more) cjose_header_set(header, name.c_str(), value.c_str(), &error);
    const std::string text = claims.dump();
    cjose_jws_t* jws =
        cjose_jws_sign(key, header, reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), &error);
    const char* compact = nullptr;
    cjose_jws_export(jws, &compact, &error);
    std::string token = compact;
    cjose_jws_release(jws);
    cjose_header_release(header);
    return token;
  }

 private:
  cjose_err error_{};
  cjose_jwk_t* const key_;
};

}  // namespace phrenic::access

#endif  // PHRENIC_TESTS_ACCESS_PROVIDER_H_
