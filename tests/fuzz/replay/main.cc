// fuzz_replay TARGET FILE...: runs a fuzz target on the named files, and on all files of the named folders, for builds
// without libFuzzer.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/replay/targets.h"

namespace phrenic::fuzz {
namespace {

void Replay(Target target, const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);  // the last name printed is the input that failed
  target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

// Returns the number of files.
int ReplayAll(Target target, const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) {
    Replay(target, path);
    return 1;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    Replay(target, entry.path());
    ++files;
  }
  return files;
}

int Main(int argc, char** argv) {
  const auto found = Targets().find(argc > 1 ? argv[1] : "");
  if (found == Targets().end()) {
    std::fprintf(stderr, "usage: fuzz_replay TARGET FILE...; the targets are:\n");
    for (const auto& row : Targets()) std::fprintf(stderr, "  %s\n", row.first.c_str());
    return 1;
  }
  int files = 0;
  for (int i = 2; i < argc; ++i) files += ReplayAll(found->second, argv[i]);
  if (files == 0) std::fprintf(stderr, "there is nothing to replay: name files or folders\n");
  return files == 0 ? 1 : 0;
}

}  // namespace
}  // namespace phrenic::fuzz

int main(int argc, char** argv) { return phrenic::fuzz::Main(argc, argv); }
