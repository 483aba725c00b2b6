#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

using Folders = std::set<std::string>;

// What each folder of server/ may include besides itself; "main" is server/main.cc.
const std::map<std::string, Folders>& Allowed() {
  static const Folders below = {"schema", "mesh", "meshio", "anatomy", "mechanics", "stream", "record"};
  static const Folders all = {"schema",  "mesh",   "meshio",   "anatomy", "imaging",    "mechanics", "stream",
                              "record",  "store",  "study",    "compare", "physiology", "session",   "jobs",
                              "service", "access", "settings", "daemon",  "cluster"};
  static const std::map<std::string, Folders> allowed = {
      {"schema", {}},
      {"mesh", {"schema"}},
      {"meshio", {"schema", "mesh"}},
      {"anatomy", {"schema", "mesh"}},
      {"imaging", {"schema", "mesh", "meshio", "anatomy"}},
      {"mechanics", {"schema", "mesh"}},
      {"stream", {"schema", "mesh", "mechanics"}},
      {"record", {"schema", "mesh"}},
      {"store", {"schema", "mesh", "mechanics"}},
      {"cluster", {"schema", "mechanics", "store"}},
      {"compare", {"schema", "mesh", "meshio", "record"}},
      {"physiology", {"schema", "mesh", "mechanics"}},
      {"study", below},
      {"session", {"schema", "mesh", "meshio", "anatomy", "mechanics", "stream", "record", "store"}},
      {"settings", {"schema"}},
      {"access", {"schema"}},
      {"service", all},
      {"daemon", all},
      {"main", all},
      {"client", all},
  };
  return allowed;
}

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

std::string IncludeFault(const std::string& folder, const std::string& header) {
  static const Folders with_grpc = {"service", "daemon", "client", "main"};
  if (IsGrpc(header)) return with_grpc.contains(folder) ? "" : "gRPC belongs to service/, daemon/, client/ and main.cc";
  if (header.starts_with("tests/")) return "tests are included by tests alone";
  const std::string target = FolderOf(header);
  if (target.empty() || target == folder) return "";
  return Allowed().at(folder).contains(target) ? "" : folder + "/ may not include " + header;
}

}  // namespace

Faults IncludeFaults(std::string_view path, std::string_view text) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  const std::string folder = FolderOf(path);
  if (folder.empty()) return {};
  if (!Allowed().contains(folder)) return {At(path, 1, "tests/architecture knows no folder " + folder + "/")};
  Faults faults;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    std::string fault = IncludeFault(folder, match[2]);
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
  return {At(path, line, "three.js belongs to web/src/viewer")};
}

}  // namespace phrenic::architecture
