#include "server/imaging/label_map.h"

#include <map>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/schema/file_bytes.h"
#include "server/schema/places.h"
#include "server/schema/schema.h"

namespace phrenic::imaging {

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

v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume) {
  if (volume.names.empty()) return map;
  std::map<std::string, int> numbers;
  for (const auto& [number, name] : volume.names) numbers.emplace(name, number);
  v1::LabelMap resolved;
  for (const v1::LabelMeaning& label : map.labels()) {
    const auto found = numbers.find(label.name());
    if (found == numbers.end()) continue;
    *resolved.add_labels() = label;
    resolved.mutable_labels(resolved.labels_size() - 1)->set_number(found->second);
  }
  return resolved.labels_size() > 0 ? resolved : map;
}

}  // namespace phrenic::imaging
