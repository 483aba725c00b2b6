#include "server/session/mesh_cache/mesh_cache.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"
#include "server/schema/file_bytes.h"
#include "server/session/mesh_cache/mesh_code.h"

namespace phrenic::session {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 64;
constexpr char kEnding[] = ".mesh";
constexpr char kLayout[] = "2";  // of PackMesh: another one, another name

// Returns the lines of /proc/cpuinfo about the first processor that decide which functions the libraries choose.
const std::string& Processor() {
  static const std::string& processor = *new std::string([] {
    std::ifstream file("/proc/cpuinfo");
    std::string line, found;
    while (std::getline(file, line) && !line.empty()) {
      for (const char* field : {"model name", "flags", "CPU implementer", "CPU part", "Features"}) {
        if (line.starts_with(field)) absl::StrAppend(&found, line, "\n");
      }
    }
    return found;
  }());
  return processor;
}

template <typename Number>
void Pack(const Number* numbers, std::int64_t count, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(numbers), static_cast<std::size_t>(count) * sizeof(Number));
}

// Reads what Pack wrote. `good` becomes false at the first array that is cut short.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
  bool good() const { return good_; }
  bool whole() const { return good_ && bytes_.empty(); }

  template <typename Number>
  std::vector<Number> Array() {
    std::int64_t count = 0;
    Take(&count, sizeof count);
    good_ = good_ && count >= 0 && static_cast<std::uint64_t>(count) <= bytes_.size() / sizeof(Number);
    std::vector<Number> numbers(good_ ? static_cast<std::size_t>(count) : 0);
    Take(numbers.data(), numbers.size() * sizeof(Number));
    return numbers;
  }
  template <typename Matrix>
  Matrix Columns() {
    const std::vector<typename Matrix::Scalar> numbers = Array<typename Matrix::Scalar>();
    constexpr int kRows = Matrix::RowsAtCompileTime;
    good_ = good_ && numbers.size() % kRows == 0;
    return Eigen::Map<const Matrix>(numbers.data(), kRows, good_ ? std::ssize(numbers) / kRows : 0);
  }

 private:
  void Take(void* to, std::size_t size) {
    good_ = good_ && size <= bytes_.size();
    if (!good_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
  bool good_ = true;
};

// Deletes the files that were used first, until the others have at most `most` bytes.
void DropOldest(const std::string& folder, std::int64_t most) {
  struct File {
    fs::file_time_type used;
    std::int64_t size;
    fs::path path;
  };
  std::vector<File> files;
  std::error_code error;
  for (fs::directory_iterator each(folder, error), end; !error && each != end; each.increment(error)) {
    std::error_code gone;  // by another program
    const File file = {each->last_write_time(gone), static_cast<std::int64_t>(each->file_size(gone)), each->path()};
    if (!gone) files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used > b.used; });
  std::int64_t sum = 0;
  for (const File& file : files) {
    sum += file.size;
    if (sum > most) fs::remove(file.path, error);
  }
}

}  // namespace

std::string DefaultCacheFolder() {
  for (const auto& [variable, below] : {std::pair("PHRENIC_CACHE", ""),
                                        {"CACHE_DIRECTORY", ""},
                                        {"XDG_CACHE_HOME", "/phrenic"},
                                        {"HOME", "/.cache/phrenic"}}) {
    const char* folder = std::getenv(variable);
    if (folder != nullptr && *folder != '\0') return absl::StrCat(folder, below);
  }
  return "none";
}

std::string PackMesh(const Mesh& mesh) {
  std::string bytes;
  Pack(mesh.vertices.data(), mesh.vertices.size(), bytes);
  Pack(mesh.triangles.data(), mesh.triangles.size(), bytes);
  Pack(mesh.tetrahedra.data(), mesh.tetrahedra.size(), bytes);
  Pack(mesh.edges.data(), mesh.edges.size(), bytes);
  for (const auto& [name, vertices] : mesh.regions) {
    Pack(name.data(), std::ssize(name), bytes);
    Pack(vertices.data(), std::ssize(vertices), bytes);
  }
  return absl::StrCat(Sha256Hex(bytes), bytes);
}

std::optional<Mesh> UnpackMesh(std::string_view bytes) {
  if (bytes.size() < kHashDigits) return std::nullopt;
  const std::string_view content = bytes.substr(kHashDigits);
  if (Sha256Hex(content) != bytes.substr(0, kHashDigits)) return std::nullopt;
  Unpacker in(content);
  Mesh mesh;
  mesh.vertices = in.Columns<Points>();
  mesh.triangles = in.Columns<Triangles>();
  mesh.tetrahedra = in.Columns<Tetrahedra>();
  mesh.edges = in.Columns<Edges>();
  while (in.good() && !in.whole()) {
    const std::vector<char> characters = in.Array<char>();
    const std::string name(characters.begin(), characters.end());
    if (!mesh.regions.empty() && name <= mesh.regions.rbegin()->first) return std::nullopt;  // not as PackMesh writes
    mesh.regions[name] = in.Array<int>();
  }
  if (!in.whole() || !Validate(mesh).ok()) return std::nullopt;
  return mesh;
}

MeshCache::MeshCache(std::string folder, std::int64_t most_bytes)
    : folder_(folder == "none" ? "" : std::move(folder)), most_bytes_(most_bytes) {}

absl::StatusOr<Mesh> MeshCache::Get(const v1::Anatomy& part, const v1::Generated& shape,
                                    absl::FunctionRef<absl::StatusOr<Mesh>()> generate) const {
  if (folder_.empty()) return generate();
  const std::string key =
      absl::StrCat(kLayout, "|", kMeshCode, Processor(), part.SerializeAsString(), "|", shape.SerializeAsString());
  const std::string file = absl::StrCat(folder_, "/", Sha256Hex(key), kEnding);
  if (const auto bytes = ReadBytes(file)) {
    if (auto mesh = UnpackMesh(*bytes)) {
      std::error_code ignored;  // of a folder that may only be read
      fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
      return *std::move(mesh);
    }
  }
  absl::StatusOr<Mesh> mesh = generate();
  if (mesh.ok()) Keep(file, PackMesh(*mesh));
  return mesh;
}

void MeshCache::Keep(const std::string& file, std::string_view bytes) const {
  static std::atomic<int> number = 0;
  std::error_code error;
  if (fs::create_directories(folder_, error)) fs::permissions(folder_, fs::perms::owner_all, error);
  const std::string part = absl::StrCat(file, ".", getpid(), ".", ++number);
  std::ofstream out(part, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) fs::rename(part, file, error);
  if (!out || error) fs::remove(part, error);
  DropOldest(folder_, most_bytes_);
}

}  // namespace phrenic::session
