// A word that completion offers, and the source of such words.
#ifndef PHRENIC_CLIENT_CLI_CANDIDATE_H_
#define PHRENIC_CLIENT_CLI_CANDIDATE_H_

#include <functional>
#include <string>
#include <vector>

#include "client/cli/argument_kinds.h"

namespace phrenic::client {

struct Candidate {
  std::string word;
  std::string meaning;  // may be empty
};

// Returns the known names of a kind, such as the server's sessions. `typed` holds the words of the command line so far.
using Lookup = std::function<std::vector<Candidate>(Kind kind, const std::vector<std::string>& typed)>;

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_CANDIDATE_H_
