// The rules of server/README.md that a compiler does not check: which folder may include which, include cycles, the
// sizes of files, functions and folders, and what is at the top of the repository. Every rule works on text, so that
// its tests can pass text that breaks it.
#ifndef PHRENIC_TESTS_ARCHITECTURE_RULES_H_
#define PHRENIC_TESTS_ARCHITECTURE_RULES_H_

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace phrenic::architecture {

inline constexpr int kLongestFile = 500;      // [lines]
inline constexpr int kLongestFunction = 60;   // [lines]
inline constexpr size_t kLargestFolder = 30;  // [units]

// One line a fault, "server/mesh/x.cc:3: ...": what is wrong and what to do.
using Faults = std::vector<std::string>;

// Path relative to the repository's root -> content.
using Texts = std::map<std::string, std::string>;

// The folders of server/ (and `main`, `client`), and for each the folders that it may include besides itself.
using Directions = std::map<std::string, std::set<std::string>>;

// Reads the table "| folder | what is in it | may include |" of server/README.md.
Directions DirectionsOf(std::string_view readme);

// Checks the includes of a C++ file in server/ or client/ against `directions`, and that gRPC is included only in
// service/, daemon/, client/ and main.cc, and in the core (schema/, mesh/, mechanics/) only the libraries that it may
// need. `path` is relative to the repository's root.
Faults IncludeFaults(const Directions& directions, std::string_view path, std::string_view text);

// The path without its ending: a source and its header are one unit.
std::string UnitOf(std::string_view path);

// Include cycles between units, and between folders, of the C++ files `texts`.
Faults CycleFaults(const Texts& texts);

// Folders with more units than kLargestFolder. `paths` are source files relative to the repository's root.
Faults FolderSizeFaults(const std::vector<std::string>& paths);

// three.js is imported only in web/src/viewer.
Faults ImportFaults(std::string_view path, std::string_view text);

Faults LengthFaults(std::string_view path, std::string_view text);

// A function of C++ text, from the first line of its head to its closing brace.
struct Function {
  int line = 0;  // of the head, from 1
  int lines = 0;
};
std::vector<Function> FunctionsOf(std::string_view text);
Faults FunctionFaults(std::string_view path, std::string_view text);

// Files that do not belong at the top of the tree, and folders whose names do not say what is in them.
Faults TreeFaults(const std::filesystem::path& root);

// Every rule on every hand-written file of the tree.
Faults AllFaults(const std::filesystem::path& root);

}  // namespace phrenic::architecture

#endif  // PHRENIC_TESTS_ARCHITECTURE_RULES_H_
