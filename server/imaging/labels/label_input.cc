#include "server/imaging/labels/label_input.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_archive.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/labels/label_set.h"
#include "server/schema/file_bytes.h"

namespace phrenic::imaging {
namespace {

namespace fs = std::filesystem;

// Returns the map whose names count: the common one, or the user's own.
absl::StatusOr<v1::LabelMap> NamesFor(const std::string& choice) {
  const absl::StatusOr<v1::LabelMap> names = ReadLabelMap(kNamesMap);
  if (!names.ok() || choice.empty()) return names.ok() ? WithCommonNames(*names) : names;
  const absl::StatusOr<std::vector<MapFit>> chosen = ReadMaps(choice);
  if (!chosen.ok()) return chosen.status();
  return chosen->front().map.tool().empty() ? chosen->front().map : WithCommonNames(*names);
}

// Adds the meanings of the volume's labels: by their names, else by a map of numbers.
absl::StatusOr<LabelInput> WithMeanings(std::string_view name, LabelVolume volume, const std::string& choice) {
  LabelInput input;
  input.volume = std::move(volume);
  const absl::StatusOr<v1::LabelMap> names = NamesFor(choice);
  if (!names.ok()) return names.status();
  std::vector<std::string> problems, remarks;
  if (!input.volume.names.empty()) {
    input.meanings = Resolve(*names, input.volume, problems);
    if (problems.empty()) return input;
    input.meanings.clear_labels();
    input.volume.remarks.emplace_back("none of the file's label names is known; name the labels");
    if (choice.empty()) return input;
  }
  absl::StatusOr<MapFit> fit = ChooseMap(input.volume, name, choice, remarks);
  if (!fit.ok()) return fit.status();
  absl::StatusOr<std::vector<MapFit>> all = ReadMaps("");
  if (!all.ok()) return all.status();
  input.tools = RankMaps(input.volume, name, *std::move(all));
  const bool own = fit->map.tool().empty();
  input.tool = fit->name;
  input.meanings = own ? fit->map : WithNamesOf(*names, fit->map);
  if (!remarks.empty()) input.remark = remarks.front();
  input.volume.names.clear();
  return input;
}

// Appends the files of a folder and of the folders in it, sorted.
absl::Status ListFolder(const std::string& folder, std::vector<std::string>& files) {
  constexpr std::size_t kMostFiles = 5000;
  std::error_code error;
  const std::size_t before = files.size();
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) files.push_back(entry.path().string());
    if (files.size() - before <= kMostFiles) continue;
    return absl::ResourceExhaustedError(
        absl::StrCat(folder, ": has more than ", kMostFiles, " files; give the folder of one patient's labels"));
  }
  std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  return absl::OkStatus();
}

// Reads the files of a set.
class SetReader {
 public:
  explicit SetReader(const MapChoices& choices) : choices_(choices) {}

  // Adds a file; leaves it out if it has another format, unless it was `named`.
  absl::Status Add(const std::string& path, bool named) {
    const std::optional<std::string> bytes = ReadBytes(path);
    if (!bytes.has_value()) {
      return absl::NotFoundError(absl::StrCat("cannot read the label file ", path, "; check the path"));
    }
    if (const LabelStart start = StartOfLabels(path, *bytes); !named && !start.readable) {
      labels_.LeaveOut(path, start.problem);
      return absl::OkStatus();
    }
    if (IsArchive(*bytes)) {
      return absl::InvalidArgumentError(
          absl::StrCat(path, ": an archive among other files is not read; unpack it, or give it alone"));
    }
    absl::StatusOr<LabelVolume> volume = ParseLabels(path, *bytes);
    if (!volume.ok()) return volume.status();
    return labels_.Add(path, *std::move(volume), ChoiceOf(path));
  }

  absl::StatusOr<LabelVolume> Finish(const std::string& first) {
    if (labels_.empty()) {
      return absl::NotFoundError(
          absl::StrCat(first, ": has no label file: NIfTI, DICOM Segmentation or RT Structure Set; check the path",
                       labels_.LeftOutWords()));
    }
    for (const auto& [file, map] : choices_.by_file) {
      if (used_.contains(file)) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(file, "=", map, ": no label file of this name was given; check the name"));
    }
    return labels_.Finish();
  }

 private:
  std::string ChoiceOf(const std::string& path) {
    for (const std::string& name : {path, fs::path(path).filename().string()}) {
      const auto own = choices_.by_file.find(name);
      if (own == choices_.by_file.end()) continue;
      used_.insert(name);
      return own->second;
    }
    return choices_.all;
  }

  const MapChoices& choices_;
  LabelSet labels_;
  std::set<std::string> used_;  // of choices_.by_file
};

}  // namespace

absl::StatusOr<LabelInput> ParseLabelInput(std::string_view name, std::string_view bytes, const std::string& choice,
                                           std::size_t max_voxels, const std::function<bool()>& stopped) {
  absl::StatusOr<LabelVolume> volume = IsArchive(bytes)
                                           ? ParseLabelArchive(std::string(name), bytes, choice, max_voxels, stopped)
                                           : ParseLabels(name, bytes, max_voxels);
  if (!volume.ok()) return volume.status();
  return WithMeanings(name, *std::move(volume), choice);
}

absl::StatusOr<LabelInput> ReadLabelInput(const std::vector<std::string>& paths, const MapChoices& choices) {
  std::error_code error;
  if (paths.size() == 1 && !fs::is_directory(paths.front(), error) && choices.by_file.empty()) {
    const std::optional<std::string> bytes = ReadBytes(paths.front());
    if (bytes.has_value()) return ParseLabelInput(paths.front(), *bytes, choices.all);
    return absl::NotFoundError(absl::StrCat("cannot read the label volume ", paths.front(), "; check the path"));
  }
  SetReader reader(choices);
  for (const std::string& path : paths) {
    const bool folder = fs::is_directory(path, error);
    std::vector<std::string> files;
    if (!folder) files.push_back(path);
    if (absl::Status status = folder ? ListFolder(path, files) : absl::OkStatus(); !status.ok()) return status;
    for (const std::string& file : files) {
      if (absl::Status status = reader.Add(file, !folder); !status.ok()) return status;
    }
  }
  absl::StatusOr<LabelVolume> volume = reader.Finish(paths.front());
  if (!volume.ok()) return volume.status();
  return WithMeanings("", *std::move(volume), "");
}

}  // namespace phrenic::imaging
