// What a shell may complete: asked for by the scripts of `phrenic completion` with every press of the tab key.
#ifndef PHRENIC_CLIENT_CLI_COMPLETION_H_
#define PHRENIC_CLIENT_CLI_COMPLETION_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "client/cli/argument_kinds.h"

namespace phrenic::client {

// `phrenic __complete "phrenic run th"`; nobody types it.
inline constexpr char kCompleteCommand[] = "__complete";

struct Candidate {
  std::string word;
  std::string meaning;  // may be empty
};

// What the shell does beside: completes file names, folders, or leaves no space behind the word.
enum class Beside { kNothing, kFiles, kFolders, kNoSpace };

struct Candidates {
  std::vector<Candidate> words;
  Beside beside = Beside::kNothing;
};

// The words of a line as a shell has them, with quotes and backslashes taken away; the last is the one that is being
// typed, and may be empty.
std::vector<std::string> SplitLine(const std::string& line);

// The names there are of a kind; `command` are the words typed so far.
using Lookup = std::function<std::vector<Candidate>(Kind kind, const std::vector<std::string>& typed)>;

// What may stand in place of the last word.
Candidates Complete(const CLI::App& app, const std::vector<std::string>& words, const Lookup& lookup);

// Prints the candidates for the line typed so far, "word<TAB>meaning" each, and what is beside last, ":files"; names
// that the server knows are asked for there, for a moment.
void PrintCandidates(const CLI::App& app, const std::string& line);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_COMPLETION_H_
