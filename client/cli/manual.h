// phrenic(1), made from the same tree as the help.
#ifndef PHRENIC_CLIENT_CLI_MANUAL_H_
#define PHRENIC_CLIENT_CLI_MANUAL_H_

#include <CLI/CLI.hpp>
#include <string>

namespace phrenic::client {

// In the macros of man(7), for `man -l` and mandoc.
std::string ManualOf(const CLI::App& app);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_MANUAL_H_
