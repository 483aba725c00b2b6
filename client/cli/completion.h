// Completion: which words may follow on a command line. The scripts of `phrenic completion` ask for them at each press
// of the tab key.
#ifndef PHRENIC_CLIENT_CLI_COMPLETION_H_
#define PHRENIC_CLIENT_CLI_COMPLETION_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "client/cli/candidate.h"

namespace phrenic::client {

// The hidden command of the completion scripts: `phrenic __complete "phrenic run th"`.
inline constexpr char kCompleteCommand[] = "__complete";

// What the shell does besides offering the words: nothing, complete file names, complete folder names, or add no space
// after the word.
enum class Directive { kNothing, kFiles, kFolders, kNoSpace };

struct Candidates {
  std::vector<Candidate> words;
  Directive directive = Directive::kNothing;
};

// Splits a line into words as a shell does and removes quotes and backslashes. The last word is the one being typed; it
// may be empty.
std::vector<std::string> SplitLine(const std::string& line);

// Returns the words that may replace the last one.
Candidates Complete(const CLI::App& app, const std::vector<std::string>& words, const Lookup& lookup);

// Prints one candidate per line, "word<TAB>meaning", and the directive last, such as ":files". May ask the server for
// names, for 0.4 s per call.
void PrintCandidates(const CLI::App& app, const std::string& line);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_COMPLETION_H_
