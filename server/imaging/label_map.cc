#include "server/imaging/label_map.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/schema/file_bytes.h"
#include "server/schema/places.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {
namespace {

// Returns a word in lower case and singular, and an ordinal as a number: "rib" of "Ribs", "2" of "second".
std::string PlainWord(std::string word) {
  static constexpr const char* kOrdinals[] = {"first",   "second", "third", "fourth", "fifth",    "sixth",
                                              "seventh", "eighth", "ninth", "tenth",  "eleventh", "twelfth"};
  absl::AsciiStrToLower(&word);
  const auto* ordinal = std::find(std::begin(kOrdinals), std::end(kOrdinals), word);
  if (ordinal != std::end(kOrdinals)) return absl::StrCat(ordinal - std::begin(kOrdinals) + 1);
  if (word == "vertebrae") return "vertebra";
  return word.size() > 3 && word.back() == 's' ? word.substr(0, word.size() - 1) : word;
}

// Returns the name's words, sorted, without "of" and "the"; other bytes than ASCII letters and digits part words.
std::string SortedWords(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : name + " ") {
    if (absl::ascii_isalnum(static_cast<unsigned char>(c))) {
      word.push_back(c);
      continue;
    }
    if (!word.empty()) words.push_back(PlainWord(std::exchange(word, "")));
  }
  std::erase_if(words, [](const std::string& each) { return each == "of" || each == "the"; });
  std::sort(words.begin(), words.end());
  return absl::StrJoin(words, " ");
}

// The names of a label map, and their words.
class KnownNames {
 public:
  explicit KnownNames(const v1::LabelMap& map) {
    for (const v1::LabelMeaning& label : map.labels()) {
      names_.insert(label.name());
      by_words_.emplace(SortedWords(label.name()), label.name());
    }
    by_words_.erase("");
  }
  // Returns the map's name of a label; empty if the map has none.
  std::string Find(const std::string& name, const std::string& meaning) const {
    if (names_.contains(name)) return name;
    for (const std::string& text : {name, meaning}) {
      const auto found = by_words_.find(SortedWords(text));
      if (found != by_words_.end()) return found->second;
    }
    return "";
  }

 private:
  std::set<std::string> names_;
  std::map<std::string, std::string> by_words_;
};

}  // namespace

absl::StatusOr<v1::LabelMap> ReadLabelMap(const std::string& name_or_file) {
  const bool is_file = absl::StrContains(name_or_file, "/") || absl::EndsWith(name_or_file, ".textproto");
  const std::string path =
      is_file ? name_or_file
              : absl::StrCat(Installed("labels", PHRENIC_LABEL_MAPS_DIR), "/", name_or_file, ".textproto");
  const std::optional<std::string> text = ReadBytes(path);
  if (!text.has_value()) {
    return absl::NotFoundError(absl::StrCat("cannot read the label map ", path,
                                            "; --labels takes totalsegmentator, or a file NAME.textproto"));
  }
  v1::LabelMap map;
  if (absl::Status status = schema::ParseText(path, *text, &map); !status.ok()) return status;
  return map;
}

v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume, std::vector<std::string>& remarks) {
  if (volume.names.empty()) return map;
  const KnownNames known(map);
  std::map<std::string, int> numbers;
  for (const auto& [number, name] : volume.names) {
    const auto meaning = volume.meanings.find(number);
    const std::string found = known.Find(name, meaning == volume.meanings.end() ? "" : meaning->second);
    if (!found.empty()) numbers.emplace(found, number);
  }
  v1::LabelMap resolved;
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto found = numbers.find(label.name());
    if (found == numbers.end()) continue;
    *resolved.add_labels() = label;
    resolved.mutable_labels(resolved.labels_size() - 1)->set_number(found->second);
  }
  if (resolved.labels_size() > 0) return resolved;
  remarks.emplace_back("the label map has none of the file's label names, so the numbers of the labels count");
  return map;
}

}  // namespace phrenic::imaging
