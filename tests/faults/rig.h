// The test rig of all faults: a server with a store, a client that steps a session, and the counts.
#ifndef PHRENIC_TESTS_FAULTS_RIG_H_
#define PHRENIC_TESTS_FAULTS_RIG_H_

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "tests/faults/driver.h"
#include "tests/support/server_process.h"

namespace phrenic::faults {

// The counts of one fault.
struct Tally {
  int tried = 0, lost = 0, wrong = 0;
  std::vector<double> recovered;  // time from the fault to the next response [s]
  std::string skipped;            // reason why it was not injected; empty if it was
  std::string note;               // more results, for the report
};

// Not thread-safe.
class Rig {
 public:
  // Starts the server and creates the session. Empties `folder` first.
  Rig(Oracle& oracle, const std::string& folder, std::vector<std::string> environment = {});

  // Injects `fault` at a random moment within 60 ms while the client steps; stops the client afterwards.
  void Disturb(const std::function<void()>& fault);
  // Restarts the server if it has ended. Adds to `tally` whether the session responds, after how long, and whether its
  // steps are right.
  void Recover(Tally& tally);
  void StepSome(int steps);

  ServerProcess& server() { return *server_; }
  const std::string& store() const { return store_; }  // folder
  Driver& driver() { return driver_; }
  std::mt19937& random() { return random_; }
  // Returns a random time from 0 to `max` [s].
  double Wait(double max) { return std::uniform_real_distribution<double>(0, max)(random_); }

 private:
  // Restarts the server, once, if it has ended or ends now. Returns whether the session responds in time; the error of
  // a server that does not restart.
  absl::StatusOr<bool> FindSession();
  bool StepsAgain();

  std::mt19937 random_{3};
  const std::string store_;
  std::unique_ptr<ServerProcess> server_;
  Driver driver_;
  double disturbed_ = 0;  // [s]
  int wrong_before_ = 0;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_RIG_H_
