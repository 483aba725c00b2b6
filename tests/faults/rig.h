// What every fault is tried on: a server on a store, a client that works with it all the while, and what is counted.
#ifndef PHRENIC_TESTS_FAULTS_RIG_H_
#define PHRENIC_TESTS_FAULTS_RIG_H_

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/faults/driver.h"
#include "tests/support/server_process.h"

namespace phrenic::faults {

// Of all tries of one fault.
struct Tally {
  int tried = 0, lost = 0, wrong = 0;
  std::vector<double> recovered;  // from the fault to the next answer [s]
  std::string skipped;            // why it could not be tried
  std::string told;               // what else there is to say
};

class Rig {
 public:
  // Starts the server and makes the session. `folder` is emptied first.
  Rig(Oracle& oracle, const std::string& folder, std::vector<std::string> environment = {});

  // The client steps until a random moment within 60 ms, `fault` happens while it goes on, and it stops.
  void Disturb(const std::function<void()>& fault);
  // Starts the server where it has ended, and counts whether the session answers, how soon, and whether a step is
  // right. `tally` counts a try.
  void Recover(Tally& tally);
  void StepSome(int steps);

  ServerProcess& server() { return *server_; }
  const std::string& store() const { return store_; }  // its folder
  Driver& driver() { return driver_; }
  std::mt19937& random() { return random_; }
  // Between 0 and `most` seconds.
  double Wait(double most) { return std::uniform_real_distribution<double>(0, most)(random_); }

 private:
  std::mt19937 random_{3};
  const std::string store_;
  std::unique_ptr<ServerProcess> server_;
  Driver driver_;
  double disturbed_ = 0;  // [s]
  int wrong_before_ = 0;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_RIG_H_
