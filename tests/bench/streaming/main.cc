// Measures what viewers receive over real sockets and what they cost the server, beside the aims of its design:
//   streaming_bench [fanout] [stalled] [lines] [stepping] [--seconds S] [--viewers N]... [--web] [--phrenicd
//   PROGRAM]...
// The server is a process of its own, whose CPU time is read from outside; times of arrival depend on the machine's
// load.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "tests/bench/streaming/parts.h"

namespace phrenic::bench {
namespace {

// Runs the wanted parts, or all, on one server.
bool RunParts(const Settings& settings, const std::vector<std::string>& wanted) {
  auto bench = Bench::Start(settings);
  if (!bench.ok()) return std::fprintf(stderr, "%s\n", std::string(bench.status().message()).c_str()) < 0;
  bool complete = true;
  const std::pair<const char*, bool (*)(Bench&)> parts[] = {
      {"fanout", FanOut}, {"stalled", Stalled}, {"lines", Lines}, {"stepping", Stepping}};
  for (const auto& [name, run] : parts) {
    const bool named = std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    if (wanted.empty() || named) complete = run(**bench) && complete;
  }
  return complete;
}

int Main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Frames to many viewers: rate, age, CPU, memory and bytes, beside what is aimed at.");
  std::vector<std::string> wanted;
  app.add_option("parts", wanted, "Parts of the table; all where none is named")
      ->check(CLI::IsMember({"fanout", "stalled", "lines", "stepping"}));
  app.add_option("--scene", settings.scene, "Scene that is watched")->capture_default_str();
  app.add_option("--seconds", settings.seconds, "Seconds that each row is watched")->check(CLI::Range(0.2, 60.0));
  app.add_option("--viewers", settings.viewers, "Viewers of the fan-out's rows")->check(CLI::Range(1, 900));
  app.add_flag("--web", settings.web_alone, "Of the fan-out, the rows of gRPC-web alone");
  std::vector<std::string> programs;
  app.add_option("--phrenicd", programs, "Servers to run each part on, one after the other; this build's if not given")
      ->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  if (programs.empty()) programs.emplace_back();
  bool complete = true;
  for (const std::string& program : programs) {
    settings.program = program;
    if (!program.empty()) std::printf("%s\n", program.c_str());
    complete = RunParts(settings, wanted) && complete;
  }
  return complete ? 0 : 1;
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) { return phrenic::bench::Main(argc, argv); }
