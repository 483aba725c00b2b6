// The faults: each is tried many times on a server that is at work. To add one, a function here and its line in
// kFaults.
#ifndef PHRENIC_TESTS_FAULTS_FAULTS_H_
#define PHRENIC_TESTS_FAULTS_FAULTS_H_

#include <span>
#include <string>

#include "tests/faults/rig.h"

namespace phrenic::faults {

struct Fault {
  const char* name;
  const char* what;  // for people
  int times;
  Tally (*run)(Oracle& oracle, const std::string& folder, int times);
};

// Of processes (process_faults.cc).
Tally Killed(Oracle& oracle, const std::string& folder, int times);
Tally Ended(Oracle& oracle, const std::string& folder, int times);
Tally Frozen(Oracle& oracle, const std::string& folder, int times);
Tally ClockJumps(Oracle& oracle, const std::string& folder, int times);
Tally OutOfMemory(Oracle& oracle, const std::string& folder, int times);
// Of the store (store_faults.cc).
Tally DiskFull(Oracle& oracle, const std::string& folder, int times);
Tally Flipped(Oracle& oracle, const std::string& folder, int times);
Tally TwoServers(Oracle& oracle, const std::string& folder, int times);
// Of clients and the network (wire_faults.cc).
Tally LineCut(Oracle& oracle, const std::string& folder, int times);
Tally Delayed(Oracle& oracle, const std::string& folder, int times);
Tally RandomRequests(Oracle& oracle, const std::string& folder, int times);
Tally RandomBytes(Oracle& oracle, const std::string& folder, int times);
// Of time (crowd.cc).
Tally ComingAndGoing(Oracle& oracle, const std::string& folder, int times);

inline constexpr Fault kFaults[] = {
    {"killed", "SIGKILL at a random moment", 100, &Killed},
    {"ended", "SIGTERM at a random moment", 30, &Ended},
    {"frozen", "stopped for up to half a second", 20, &Frozen},
    {"clock", "the clock jumps by up to a year, both ways", 20, &ClockJumps},
    {"memory", "no memory for the next big scene", 5, &OutOfMemory},
    {"disk", "the store's disk is full, and has room again", 10, &DiskFull},
    {"flipped", "a byte of the store is flipped", 30, &Flipped},
    {"twice", "a second server on the same store", 10, &TwoServers},
    {"cut", "the line is cut in a call", 50, &LineCut},
    {"delayed", "bytes that come up to 0.4 s late", 10, &Delayed},
    {"requests", "every method with random requests", 2000, &RandomRequests},
    {"bytes", "random bytes on both ports", 200, &RandomBytes},
    {"crowd", "six sessions, eighteen viewers come and go", 60, &ComingAndGoing},
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_FAULTS_H_
