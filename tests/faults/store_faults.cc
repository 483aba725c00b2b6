#include <sys/mount.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "tests/faults/faults.h"

namespace phrenic::faults {
namespace {

namespace fs = std::filesystem;

// A tmpfs of 8 MiB, mounted for the lifetime of the object.
class SmallDisk {
 public:
  explicit SmallDisk(std::string folder) : folder_(std::move(folder)) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    mounted_ = mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=8m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  void Fill() const {
    std::ofstream file(folder_ + "/full", std::ios::binary);
    const std::string block(4096, 'x');
    while (file.write(block.data(), 4096).flush()) continue;
  }
  void Clear() const { fs::remove(folder_ + "/full"); }

 private:
  const std::string folder_;
  bool mounted_ = false;
};

std::string ReadFile(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void WriteFile(const fs::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

fs::path LargestFile(const fs::path& folder) {
  fs::path largest;
  for (const auto& file : fs::directory_iterator(folder)) {
    if (file.is_regular_file() && (largest.empty() || file.file_size() > fs::file_size(largest))) largest = file.path();
  }
  return largest;
}

}  // namespace

// The session continues while the disk is full. Once there is room it is saved and survives SIGKILL.
Tally DiskFull(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  const SmallDisk disk(folder + ".disk");
  if (!disk.mounted()) {
    tally.skipped = "a tmpfs cannot be mounted: run as root";
    return tally;
  }
  Rig rig(oracle, folder + ".disk/run");
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] {
      disk.Fill();
      absl::SleepFor(absl::Milliseconds(100));
      disk.Clear();
      absl::SleepFor(absl::Milliseconds(100));
      rig.server().Kill();
    });
    rig.Recover(tally);
  }
  return tally;
}

// Either the server refuses the store and does not write to it, so that restoring the byte restores the sessions, or
// the bit has no effect.
Tally Flipped(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] { rig.server().Stop(15); });
    const fs::path file = LargestFile(rig.store());
    const fs::path marker = fs::path(rig.store()) / "phrenic.marker";  // belongs to the database
    const std::string right = ReadFile(file), right_marker = ReadFile(marker);
    const auto restore = [&] {
      WriteFile(file, right);
      WriteFile(marker, right_marker);
    };
    std::string wrong = right;
    wrong[rig.random()() % wrong.size()] ^= static_cast<char>(1 << rig.random()() % 8);
    WriteFile(file, wrong);
    if (!rig.server().Start().ok()) {
      if (ReadFile(file) != wrong) {
        std::fprintf(stderr, "the server wrote to a store that it refused\n");
        ++tally.lost;
      }
      restore();
    } else if (rig.driver().Connect(rig.server().address()) && !rig.driver().FindTick(5).has_value()) {
      // The server runs without the session and keeps its record.
      rig.server().Stop(15);
      restore();
    }
    rig.Recover(tally);
  }
  return tally;
}

Tally TwoServers(Oracle& oracle, const std::string& folder, int times) {
  Tally tally;
  Rig rig(oracle, folder);
  ServerProcess second(folder + "/second", {"--store", rig.store()});
  for (int i = 0; i < times; ++i) {
    rig.Disturb([&] {
      if (!second.Start().ok()) return;
      std::fprintf(stderr, "a second server opened the store\n");
      ++tally.lost;
      second.Signal(SIGKILL);
      second.Await(60);
    });
    rig.Recover(tally);
  }
  return tally;
}

}  // namespace phrenic::faults
