// Certificates for one test, made by the openssl command.
#ifndef PHRENIC_TESTS_SERVICE_CERTIFICATES_H_
#define PHRENIC_TESTS_SERVICE_CERTIFICATES_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace phrenic::service {

// A temporary folder with two CAs, "good" and "evil". Not thread-safe.
class Certificates {
 public:
  Certificates() : folder_(testing::TempDir() + "/phrenic-certificates-" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
    for (const char* name : {"good", "evil"}) {
      Run(std::string("req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=") + name +
          " -keyout " + Key(name) + " -out " + File(name));
    }
  }
  ~Certificates() { std::filesystem::remove_all(folder_); }
  Certificates(const Certificates&) = delete;
  Certificates& operator=(const Certificates&) = delete;

  std::string File(const std::string& name) const { return folder_ + "/" + name + ".pem"; }
  std::string Key(const std::string& name) const { return folder_ + "/" + name + ".key"; }
  // Creates NAME.pem and NAME.key for localhost and 127.0.0.1, signed by a CA.
  void Sign(const std::string& name, const std::string& authority = "good") const {
    std::ofstream(folder_ + "/names") << "subjectAltName=DNS:localhost,IP:127.0.0.1\n";
    Run("req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=" + name + " -keyout " + Key(name) +
        " -out " + folder_ + "/request");
    Run("x509 -req -days 2 -in " + folder_ + "/request -CA " + File(authority) + " -CAkey " + Key(authority) +
        " -CAcreateserial -extfile " + folder_ + "/names -out " + File(name));
  }
  static std::string Read(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  static void Run(const std::string& words) {
    EXPECT_EQ(std::system(("openssl " + words + " >/dev/null 2>&1").c_str()), 0) << words;
  }

  const std::string folder_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_CERTIFICATES_H_
