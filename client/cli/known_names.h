// The names that completion offers: parameters from the schema; scenes, sessions, exports and studies from the server.
#ifndef PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_
#define PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_

#include <CLI/CLI.hpp>

#include "client/cli/candidate.h"

namespace phrenic::client {

// Returns a lookup that asks the server named by the typed words, the environment or the settings file, with a deadline
// of 0.4 s per call. If the server does not answer, scenes and presets are those of the installation and other names
// are empty. Requires: `app` outlives the lookup.
Lookup KnownNames(const CLI::App& app);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_KNOWN_NAMES_H_
