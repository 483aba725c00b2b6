#include "server/service/web/static_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"

namespace phrenic::service {
namespace {

namespace fs = std::filesystem;

struct MediaType {
  std::string_view extension;
  const char* content_type;
};

constexpr MediaType kMediaTypes[] = {
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".webp", "image/webp"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".wasm", "application/wasm"},
    {".woff2", "font/woff2"},
    {".txt", "text/plain; charset=utf-8"},
};

// Decodes percent-encoding (RFC 3986 section 2.1). INVALID_ARGUMENT for an incomplete escape or a NUL character.
absl::StatusOr<std::string> PercentDecode(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size() || !absl::ascii_isxdigit(text[i + 1]) || !absl::ascii_isxdigit(text[i + 2])) {
        return absl::InvalidArgumentError("the address has an incomplete % escape");
      }
      c = absl::HexStringToBytes(absl::string_view(text.data() + i + 1, 2))[0];
      i += 2;
    }
    if (c == '\0') return absl::InvalidArgumentError("the address contains a NUL character");
    decoded += c;
  }
  return decoded;
}

bool IsBelow(const fs::path& root, const fs::path& path) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

// True if a header "gzip, br;q=0.5" allows the coding.
bool Accepts(std::string_view header, std::string_view coding) {
  for (const absl::string_view each : absl::StrSplit(absl::string_view(header.data(), header.size()), ',')) {
    const std::pair<absl::string_view, absl::string_view> parts = absl::StrSplit(each, absl::MaxSplits(';', 1));
    if (absl::StripAsciiWhitespace(parts.first) != absl::string_view(coding.data(), coding.size())) continue;
    double quality = 1;
    absl::string_view weight = absl::StripAsciiWhitespace(parts.second);
    return !absl::ConsumePrefix(&weight, "q=") || !absl::SimpleAtod(weight, &quality) || quality > 0;
  }
  return false;
}

// Makes `file` its compressed form, if the build wrote one and the header allows it.
void Compress(std::string_view accept_encoding, StaticFile& file) {
  const fs::path plain = file.path;
  for (const auto& [coding, ending] : {std::pair("br", ".br"), {"gzip", ".gz"}}) {
    std::error_code error;
    const fs::path path = absl::StrCat(plain.string(), ending);
    // Skips a compressed file older than its source.
    if (!fs::is_regular_file(path, error) || fs::last_write_time(path, error) < fs::last_write_time(plain, error))
      continue;
    file.varies = true;
    if (!file.encoding.empty() || !Accepts(accept_encoding, coding)) continue;
    file.path = path.string();
    file.encoding = coding;
  }
}

std::string ETagOf(const fs::path& path) {
  std::error_code ignored;
  return absl::StrFormat("\"%x-%x\"", fs::file_size(path, ignored),
                         fs::last_write_time(path, ignored).time_since_epoch().count());
}

}  // namespace

std::string ContentTypeOf(std::string_view path) {
  for (const MediaType& type : kMediaTypes) {
    if (path.ends_with(type.extension)) return type.content_type;
  }
  return "application/octet-stream";
}

absl::StatusOr<StaticFile> FindStaticFile(const std::string& root, std::string_view target,
                                          std::string_view accept_encoding) {
  target = target.substr(0, target.find_first_of("?#"));
  if (target.empty() || target[0] != '/') return absl::InvalidArgumentError("the address does not begin with /");
  const absl::StatusOr<std::string> decoded = PercentDecode(target.substr(1));
  if (!decoded.ok()) return decoded.status();
  const absl::Status missing = absl::NotFoundError("there is no such page");
  std::error_code error;
  const fs::path folder = fs::canonical(root, error);
  if (error) return absl::NotFoundError("the viewer is not built: run deploy/run, or pass its folder with --web-root");
  const fs::path relative(decoded->empty() ? "index.html" : *decoded);
  if (relative.is_absolute() || std::find(relative.begin(), relative.end(), "..") != relative.end()) return missing;
  const fs::path path = fs::canonical(folder / relative, error);
  if (error || !IsBelow(folder, path) || !fs::is_regular_file(path, error)) return missing;
  const bool hashed = absl::StartsWith(*decoded, "assets/");
  StaticFile file;
  file.path = path.string();
  file.content_type = ContentTypeOf(file.path);
  file.cache_control = hashed ? "public, max-age=31536000, immutable" : "no-cache";
  Compress(accept_encoding, file);
  file.etag = ETagOf(file.path);
  return file;
}

}  // namespace phrenic::service
