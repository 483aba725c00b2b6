// Text as one word of a shell's command line.
#ifndef PHRENIC_CLIENT_CLI_SHELL_WORD_H_
#define PHRENIC_CLIENT_CLI_SHELL_WORD_H_

#include <string>

namespace phrenic::client {

// Returns the text, in single quotes if a POSIX shell would split or change it.
std::string ShellWord(const std::string& text);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SHELL_WORD_H_
