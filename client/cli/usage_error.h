// What to say of a command line that is wrong, and what to type instead.
#ifndef PHRENIC_CLIENT_CLI_USAGE_ERROR_H_
#define PHRENIC_CLIENT_CLI_USAGE_ERROR_H_

#include <CLI/CLI.hpp>
#include <string>

namespace phrenic::client {

// Sentences for standard error, the last lines being what to type. `app` is the root that threw the error.
std::string Explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_USAGE_ERROR_H_
