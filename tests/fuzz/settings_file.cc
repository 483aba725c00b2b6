// Any bytes as a settings file give values that the options accept, or an error with file and line.
#include "server/settings/settings_file.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/scratch_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const phrenic::fuzz::ScratchFile file(data, size);
  CLI::App app;
  int number = 1;
  std::string text;
  std::vector<std::string> list;
  bool flag = false;
  app.add_option("--number", number)->check(CLI::Range(1, 10));
  app.add_option("--list", list)->delimiter(',');
  app.add_flag("--flag", flag);
  app.add_subcommand("run")->add_option("--text", text);
  const auto names = phrenic::settings::ReadFile(file.path(), app);
  if (!names.ok() && names.status().message().substr(0, file.path().size()) != file.path()) std::abort();
  app.parse(std::vector<std::string>());
  if (number < 1 || number > 10) std::abort();
  return 0;
}
