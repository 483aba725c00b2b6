// A phrenicd process with a folder of its own, for tests that measure or attack it from outside.
#ifndef PHRENIC_TESTS_SERVICE_PROCESS_FIXTURE_H_
#define PHRENIC_TESTS_SERVICE_PROCESS_FIXTURE_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/server_process.h"

namespace phrenic::service {

class ProcessFixture : public testing::Test {
 protected:
  ProcessFixture() : folder_(testing::TempDir() + "/phrenic-process-" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~ProcessFixture() override {
    server_.reset();
    std::filesystem::remove_all(folder_);
  }
  // Starts the server with these flags and without a store.
  void Start(std::vector<std::string> flags = {}) {
    flags.insert(flags.end(), {"--store", "none", "--web-root", folder_});
    // A small quarantine, so that AddressSanitizer's freed memory does not count as the server's.
    server_ = std::make_unique<ServerProcess>(folder_ + "/said", flags,
                                              std::vector<std::string>{"ASAN_OPTIONS=quarantine_size_mb=1"});
    const absl::Status status = server_->Start();
    ASSERT_TRUE(status.ok()) << status;
  }

  const std::string folder_;
  std::unique_ptr<ServerProcess> server_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_PROCESS_FIXTURE_H_
