#include "server/imaging/labels/label_map.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/imaging/labels/label_words.h"
#include "server/schema/file_bytes.h"
#include "server/schema/places.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

constexpr char kEnding[] = ".textproto";

std::string MapsFolder() { return Installed("labels", PHRENIC_LABEL_MAPS_DIR); }

// The names of a label map, and their words.
class KnownNames {
 public:
  explicit KnownNames(const v1::LabelMap& map) {
    for (const v1::LabelMeaning& label : map.labels()) {
      names_.insert(label.name());
      by_words_.emplace(SortedWords(PlainWords(label.name())), label.name());
    }
    for (const v1::LabelMeaning& label : map.labels()) {
      for (const std::string& other : label.also()) by_words_.emplace(SortedWords(PlainWords(other)), label.name());
    }
    by_words_.erase("");
  }
  // Returns the map's name of a label; empty if the map has none.
  std::string Find(const std::string& name, const std::string& meaning) const {
    if (names_.contains(name)) return name;
    for (const std::string& text : {name, meaning}) {
      if (std::string found = Of(PlainWords(text)); !found.empty()) return found;
    }
    return "";
  }
  // Returns the map's name of these words; empty if it has none.
  std::string Of(std::vector<std::string> words) const {
    const auto found = by_words_.find(SortedWords(std::move(words)));
    return found == by_words_.end() ? "" : found->second;
  }

 private:
  std::set<std::string> names_;
  std::map<std::string, std::string> by_words_;
};

void AddCommonName(const char* name, v1::Structure structure, v1::Side side, v1::LabelMap& map) {
  v1::LabelMeaning& label = *map.add_labels();
  label.set_name(name);
  label.mutable_anatomy()->set_structure(structure);
  label.mutable_anatomy()->set_side(side);
}

}  // namespace

std::vector<std::string> InstalledLabelMaps() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(MapsFolder(), error)) {
    if (entry.path().extension() == kEnding) names.push_back(entry.path().stem().string());
  }
  const auto rank = [](const std::string& name) { return name == kNamesMap ? 0 : name == "vista3d" ? 1 : 2; };
  std::sort(names.begin(), names.end(),
            [&](const std::string& a, const std::string& b) { return std::pair(rank(a), a) < std::pair(rank(b), b); });
  return names;
}

absl::StatusOr<v1::LabelMap> ReadLabelMap(const std::string& name_or_file) {
  const bool is_file = absl::StrContains(name_or_file, "/") || absl::EndsWith(name_or_file, kEnding);
  const std::string path = is_file ? name_or_file : absl::StrCat(MapsFolder(), "/", name_or_file, kEnding);
  const std::optional<std::string> text = ReadBytes(path);
  if (!text.has_value()) {
    return absl::NotFoundError(absl::StrCat("cannot read the label map ", path,
                                            "; give a file NAME.textproto, or one of ",
                                            absl::StrJoin(InstalledLabelMaps(), ", ")));
  }
  v1::LabelMap map;
  if (absl::Status status = schema::ParseText(path, *text, &map); !status.ok()) return status;
  return map;
}

v1::LabelMap WithCommonNames(const v1::LabelMap& map) {
  v1::LabelMap all = map;
  AddCommonName("lung_left", v1::STRUCTURE_LUNG, v1::SIDE_LEFT, all);
  AddCommonName("lung_right", v1::STRUCTURE_LUNG, v1::SIDE_RIGHT, all);
  AddCommonName("ribs", v1::STRUCTURE_RIB, v1::SIDE_UNSPECIFIED, all);
  AddCommonName("diaphragm", v1::STRUCTURE_DIAPHRAGM, v1::SIDE_UNSPECIFIED, all);
  return all;
}

v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume, std::vector<std::string>& remarks) {
  if (volume.names.empty()) return map;
  const KnownNames known(map);
  std::multimap<std::string, int> numbers;
  for (const auto& [number, name] : volume.names) {
    const auto meaning = volume.meanings.find(number);
    const std::string found = known.Find(name, meaning == volume.meanings.end() ? "" : meaning->second);
    if (!found.empty()) numbers.emplace(found, number);
  }
  v1::LabelMap resolved;
  std::set<std::string> done;
  for (const v1::LabelMeaning& label : map.labels()) {
    if (!done.insert(label.name()).second) continue;
    const auto [first, last] = numbers.equal_range(label.name());
    for (auto found = first; found != last; ++found) {
      v1::LabelMeaning& meaning = *resolved.add_labels();
      meaning = label;
      meaning.set_number(found->second);
      meaning.clear_also();
    }
  }
  if (resolved.labels_size() > 0) return resolved;
  remarks.emplace_back("the label map has none of the file's label names, so the numbers of the labels count");
  return map;
}

std::string LabelOfFile(const v1::LabelMap& map, std::string_view file_name) {
  constexpr std::size_t kMostWords = 40;  // of a name that are compared
  const KnownNames known(map);
  std::vector<std::string> words = PlainWords(file_name);
  words.resize(std::min(words.size(), kMostWords));
  for (std::size_t length = words.size(); length > 0; --length) {
    std::set<std::string> found;
    for (std::size_t first = 0; first + length <= words.size(); ++first) {
      const auto begin = words.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<std::string> some(begin, begin + static_cast<std::ptrdiff_t>(length));
      if (!known.Of(some).empty()) found.insert(absl::StrJoin(some, "_"));
    }
    if (!found.empty()) return found.size() == 1 ? *found.begin() : "";
  }
  return "";
}

v1::LabelMap WithNamesOf(const v1::LabelMap& names, const v1::LabelMap& map) {
  const KnownNames known(names);
  v1::LabelMap renamed = map;
  for (v1::LabelMeaning& label : *renamed.mutable_labels()) {
    if (const std::string name = known.Find(label.name(), ""); !name.empty()) label.set_name(name);
  }
  return renamed;
}

v1::LabelMap UniteLabels(const v1::LabelMap& map, LabelVolume& volume) {
  v1::LabelMap united;
  std::map<std::string, Label> first;  // by name
  std::vector<Label> becomes(std::size_t{1} << 16);
  std::iota(becomes.begin(), becomes.end(), Label{0});
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto number = static_cast<Label>(label.number());
    const auto [same, added] = first.emplace(label.name(), number);
    becomes[number] = same->second;
    if (added) *united.add_labels() = label;
  }
  if (united.labels_size() == map.labels_size()) return united;
  for (Label& label : volume.labels) label = becomes[label];
  return united;
}

bool HasRepeatedNames(const v1::LabelMap& map) {
  std::set<std::string> names;
  return std::any_of(map.labels().begin(), map.labels().end(),
                     [&names](const v1::LabelMeaning& label) { return !names.insert(label.name()).second; });
}

}  // namespace phrenic::imaging
