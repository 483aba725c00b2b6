// The names that completion knows: parameters from the schema, scenes, sessions and the like from the server.
#ifndef PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_
#define PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_

#include "client/cli/completion.h"

namespace phrenic::client {

// Asks the server that the typed words, the environment or the settings file name, for 0.4 s at most. Scenes and their
// presets are the shipped ones where nobody answers; of all else there is nothing then.
Lookup KnownNames(const CLI::App& app);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_
