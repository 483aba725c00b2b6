#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

using Folders = std::set<std::string>;

// "mesh" of "server/mesh/mesh.h", "main" of "server/main.cc", "client" of "client/main.cc"; else empty.
std::string FolderOf(std::string_view path) {
  const std::string text(path);
  if (text.starts_with("client/")) return "client";
  if (!text.starts_with("server/")) return "";
  const size_t slash = text.find('/', 7);
  return slash == std::string::npos ? "main" : text.substr(7, slash - 7);
}

std::string At(std::string_view path, int line, const std::string& what) {
  return std::string(path) + ":" + std::to_string(line) + ": " + what;
}

bool IsGrpc(const std::string& header) {
  return header.starts_with("grpc") || header.find(".grpc.pb.h") != std::string::npos;
}

// True if the header is of the standard library, POSIX, Abseil, Eigen, Highway, protobuf or Phrenic: what
// -DPHRENIC_PARTS=core needs.
bool IsOfTheCore(const std::string& header) {
  static const std::regex core(R"re([a-z_]+|(absl|Eigen|google/protobuf|hwy|phrenic|server|sys)/.*)re");
  return std::regex_match(header, core);
}

std::string IncludeFault(const Folders& allowed, const std::string& folder, const std::string& header) {
  static const Folders with_grpc = {"service", "daemon", "client", "main"};
  if (IsGrpc(header))
    return with_grpc.contains(folder) ? "" : "only service/, daemon/, client/ and main.cc include gRPC";
  if (header.starts_with("tests/")) return "only tests include tests";
  static const Folders core = {"schema", "mesh", "mechanics"};
  if (core.contains(folder) && !IsOfTheCore(header)) {
    return "the core needs no libraries but Abseil, Eigen, Highway and protobuf";
  }
  const std::string target = FolderOf(header);
  if (target.empty() || target == folder) return "";
  return allowed.contains(target) ? "" : folder + "/ may not include " + header;
}

}  // namespace

Faults IncludeFaults(const Directions& directions, std::string_view path, std::string_view text) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  const std::string folder = FolderOf(path);
  if (folder.empty()) return {};
  const auto row = directions.find(folder);
  if (row == directions.end()) return {At(path, 1, "the table in server/README.md has no row for " + folder + "/")};
  Faults faults;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    std::string fault = IncludeFault(row->second, folder, match[2]);
    if (match[1] == "\"" && match[2].str().find('/') == std::string::npos) {
      fault = "name " + match[2].str() + " by its path from the repository's root";
    }
    if (!fault.empty()) faults.push_back(At(path, number, fault));
  }
  return faults;
}

Faults ImportFaults(std::string_view path, std::string_view text) {
  static const std::regex three(R"re((from|import)\s*\(?\s*["']three(/[^"']*)?["'])re");
  if (!path.starts_with("web/src/") || path.starts_with("web/src/viewer")) return {};
  const std::string whole(text);
  std::smatch match;
  if (!std::regex_search(whole, match, three)) return {};
  const auto line = static_cast<int>(std::count(whole.begin(), whole.begin() + match.position(), '\n')) + 1;
  return {At(path, line, "only web/src/viewer imports three.js")};
}

}  // namespace phrenic::architecture
