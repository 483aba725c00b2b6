// The faults, each injected many times into a server under load. To add one, declare its function and add a row to
// kFaults.
#ifndef PHRENIC_TESTS_FAULTS_FAULTS_H_
#define PHRENIC_TESTS_FAULTS_FAULTS_H_

#include <span>
#include <string>

#include "tests/faults/rig.h"

namespace phrenic::faults {

struct Fault {
  const char* name;
  const char* description;
  int times;
  Tally (*run)(Oracle& oracle, const std::string& folder, int times);
};

// Process faults (process_faults.cc).
Tally Killed(Oracle& oracle, const std::string& folder, int times);
Tally Ended(Oracle& oracle, const std::string& folder, int times);
Tally Frozen(Oracle& oracle, const std::string& folder, int times);
Tally ClockJumps(Oracle& oracle, const std::string& folder, int times);
Tally OutOfMemory(Oracle& oracle, const std::string& folder, int times);
// Store faults (store_faults.cc).
Tally DiskFull(Oracle& oracle, const std::string& folder, int times);
Tally Flipped(Oracle& oracle, const std::string& folder, int times);
Tally TwoServers(Oracle& oracle, const std::string& folder, int times);
// Client and network faults (wire_faults.cc).
Tally LineCut(Oracle& oracle, const std::string& folder, int times);
Tally Delayed(Oracle& oracle, const std::string& folder, int times);
Tally RandomRequests(Oracle& oracle, const std::string& folder, int times);
Tally RandomBytes(Oracle& oracle, const std::string& folder, int times);
// Resource leaks (crowd.cc).
Tally ComingAndGoing(Oracle& oracle, const std::string& folder, int times);

inline constexpr Fault kFaults[] = {
    {"killed", "SIGKILL at a random moment", 100, &Killed},
    {"ended", "SIGTERM at a random moment", 30, &Ended},
    {"frozen", "suspended for up to 0.5 s", 20, &Frozen},
    {"clock", "the wall clock jumps by up to a year", 20, &ClockJumps},
    {"memory", "no memory for the next large scene", 5, &OutOfMemory},
    {"disk", "the store's disk is full for a while", 10, &DiskFull},
    {"flipped", "a bit of the store is flipped", 30, &Flipped},
    {"twice", "a second server on the same store", 10, &TwoServers},
    {"cut", "the connection is cut during a call", 50, &LineCut},
    {"delayed", "bytes are delayed by up to 0.4 s", 10, &Delayed},
    {"requests", "every method with random requests", 2000, &RandomRequests},
    {"bytes", "random bytes on both ports", 200, &RandomBytes},
    {"crowd", "6 sessions and 18 viewers connect and leave", 60, &ComingAndGoing},
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_FAULTS_H_
