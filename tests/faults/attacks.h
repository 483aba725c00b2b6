// The attacks: what strangers and one account do against a server while others use it. To add one, declare its function
// and add a row to kAttacks.
#ifndef PHRENIC_TESTS_FAULTS_ATTACKS_H_
#define PHRENIC_TESTS_FAULTS_ATTACKS_H_

#include <string>
#include <vector>

#include "tests/faults/victim.h"

namespace phrenic::faults {

struct Outcome {
  int tried = 0, refused = 0, served = 0;  // a flood has tries alone
  std::vector<std::string> broken;         // what the server must not do, and did
  std::string note;                        // more results, for the report
};

struct Attack {
  const char* name;
  const char* description;
  int times;
  const char* flags;  // of the server, separated by spaces
  bool open;          // against the port that is open to others: the guard's, if it can be started
  Outcome (*run)(const Victim& victim, int times);
};

// Requests to the web port (web_attacks.cc).
Outcome IllegalHeaders(const Victim& victim, int times);
Outcome LargeBodies(const Victim& victim, int times);
Outcome SlowHeads(const Victim& victim, int times);
Outcome ForeignHosts(const Victim& victim, int times);
Outcome Upgrades(const Victim& victim, int times);
// Frames of HTTP/2 to the gRPC port (http2_attacks.cc).
Outcome IllegalMetadata(const Victim& victim, int times);
Outcome RapidResets(const Victim& victim, int times);
Outcome UnfinishedMessages(const Victim& victim, int times);
Outcome HeaderBomb(const Victim& victim, int times);
Outcome EndlessHeaders(const Victim& victim, int times);
Outcome ControlFrames(const Victim& victim, int times);
Outcome OddDeadlines(const Victim& victim, int times);
Outcome IdleConnections(const Victim& victim, int times);
// Many calls, by strangers or one account (call_attacks.cc).
Outcome Reflection(const Victim& victim, int times);
Outcome Physiology(const Victim& victim, int times);
Outcome Batches(const Victim& victim, int times);
Outcome FoldedRequests(const Victim& victim, int times);
Outcome CompileBombs(const Victim& victim, int times);
Outcome SlowReaders(const Victim& victim, int times);
Outcome GreedyAccount(const Victim& victim, int times);
// Calls that compute (work_attacks.cc).
Outcome Fits(const Victim& victim, int times);
Outcome Tissue(const Victim& victim, int times);
// What belongs to another account (theft_attacks.cc).
Outcome UploadTheft(const Victim& victim, int times);
Outcome StudyFlood(const Victim& victim, int times);
Outcome ForgedTokens(const Victim& victim, int times);

// A call that every server answers.
inline constexpr char kGetServer[] = "/phrenic.v1.ServerService/GetServer";

inline constexpr char kNoRateLimit[] = "--max-requests 0";

inline constexpr Attack kAttacks[] = {
    {"headers", "illegal bytes in headers, web port", 600, "", false, &IllegalHeaders},
    {"metadata", "the same, gRPC port", 600, "", false, &IllegalMetadata},
    {"reflection", "streams of reflection, left open", 130, "", false, &Reflection},
    {"physiology", "`CheckPhysiology` on one connection", 135, kNoRateLimit, false, &Physiology},
    {"batches", "`RunBatch` of 1,000 hours on one connection", 135, kNoRateLimit, false, &Batches},
    {"fits", "`FitMotion` with 20,000 landmarks, 8 at a time", 80, kNoRateLimit, false, &Fits},
    {"tissue", "`GetTissue` and `ReadTissue`, also of another account", 800, kNoRateLimit, false, &Tissue},
    {"folded", "requests of 16 MB that unfold to gigabytes", 60, kNoRateLimit, false, &FoldedRequests},
    {"resets", "streams opened and reset (HTTP/2 rapid reset)", 300'000, "", true, &RapidResets},
    {"unfinished", "messages of 16 MB without their end", 200, "", true, &UnfinishedMessages},
    {"bodies", "web bodies of 31 MB without an account", 120, "", false, &LargeBodies},
    {"bomb", "headers that decompress to 64 MB (HPACK)", 50, "", true, &HeaderBomb},
    {"endless", "headers without an end, 32 MB (CONTINUATION)", 20, "", true, &EndlessHeaders},
    {"frames", "PING, SETTINGS and empty DATA, unread", 200'000, "", true, &ControlFrames},
    {"deadlines", "deadlines of 0, of 300 years and of none", 400, "", false, &OddDeadlines},
    {"connections", "connections that send nothing", 3'000, "", true, &IdleConnections},
    {"slow", "requests of one byte every 50 ms", 600, "", false, &SlowHeads},
    {"readers", "viewers that read nothing", 60, kNoRateLimit, false, &SlowReaders},
    {"compile", "scenes that take minutes and gigabytes", 16, kNoRateLimit, false, &CompileBombs},
    {"greedy", "studies, sessions, exports and seats of one account", 300, kNoRateLimit, false, &GreedyAccount},
    {"uploads", "another account's uploads", 200, "--max-requests 0 --max-upload-mb 4 --max-uploads-mb 8", false,
     &UploadTheft},
    {"studies", "studies made and deleted", 4'201, kNoRateLimit, false, &StudyFlood},
    {"tokens", "invented links and page tokens", 300, kNoRateLimit, false, &ForgedTokens},
    {"hosts", "foreign hosts and origins (DNS rebinding)", 60, "", false, &ForeignHosts},
    {"upgrades", "upgrades, other protocols and methods", 200, "", false, &Upgrades},
};

// Injects the attack into a server in `folder` and prints a row of the table. Returns how many promises were broken.
// The healthy viewer's gap may be at most `largest_gap` [s].
int RunAttack(const Attack& attack, const std::string& folder, double share, double largest_gap);
void PrintAttackHeader();

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_ATTACKS_H_
