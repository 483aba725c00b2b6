// The rules of server/README.md that a compiler does not hold: who may include whom, how long a file and a function may
// be, what stands at the top. Every rule works on text, so that its tests can hand it text that breaks it.
#ifndef PHRENIC_TESTS_ARCHITECTURE_RULES_H_
#define PHRENIC_TESTS_ARCHITECTURE_RULES_H_

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace phrenic::architecture {

inline constexpr int kLongestFile = 500;     // [lines]
inline constexpr int kLongestFunction = 60;  // [lines]

// One line a fault, "server/mesh/x.cc:3: ...": what is wrong and what to do.
using Faults = std::vector<std::string>;

// `path` is relative to the repository's root. Includes of C++ files in server/ and client/ keep to the directions
//   schema <- mesh <- { meshio, anatomy, mechanics, stream, record } <- study, session <- service <- main, client
// in which the five do not know each other, but for stream, which makes its frames of mechanics' Model and State.
// gRPC stands in service/, client/ and main.cc alone.
Faults IncludeFaults(std::string_view path, std::string_view text);

// three.js is imported in web/src/viewer alone.
Faults ImportFaults(std::string_view path, std::string_view text);

Faults LengthFaults(std::string_view path, std::string_view text);

// Functions of C++ text, from the first line of the head to the closing brace.
struct Function {
  int line = 0;  // of the head, from 1
  int lines = 0;
};
std::vector<Function> FunctionsOf(std::string_view text);
Faults FunctionFaults(std::string_view path, std::string_view text);

// What stands at the top of the tree, and how its folders are called.
Faults TreeFaults(const std::filesystem::path& root);

// Every rule over every file of the tree that people write.
Faults AllFaults(const std::filesystem::path& root);

}  // namespace phrenic::architecture

#endif  // PHRENIC_TESTS_ARCHITECTURE_RULES_H_
