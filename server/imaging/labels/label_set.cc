#include "server/imaging/labels/label_set.h"

#include <algorithm>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/imaging/labels/label_fit.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/labels/label_words.h"
#include "server/imaging/mask.h"

namespace phrenic::imaging {
namespace {

constexpr std::size_t kMostNumbers = 65535;
constexpr double kSameStructure = 0.8;  // least Dice of a structure in two files
constexpr double kMostHidden = 0.5;     // share of a label

// Returns a file's name without folders and endings.
std::string StemOf(const std::string& file) {
  std::string stem = file.substr(file.find_last_of('/') + 1);
  for (const char* ending : {".gz", ".nii", ".dcm"}) {
    if (absl::EndsWithIgnoreCase(stem, ending)) stem.resize(stem.size() - std::string_view(ending).size());
  }
  return stem;
}

std::string GridWords(const LabelVolume& volume) {
  const Eigen::Vector3d spacing = volume.Spacing(), origin = volume.to_patient.translation();
  return absl::StrFormat("%d x %d x %d voxels of %.2f x %.2f x %.2f mm from (%.1f, %.1f, %.1f) mm", volume.size.x(),
                         volume.size.y(), volume.size.z(), spacing.x(), spacing.y(), spacing.z(), origin.x(),
                         origin.y(), origin.z());
}

// Returns the first files' names and how many more there are.
std::string Listed(const std::vector<std::string>& files) {
  constexpr std::size_t kMostNamed = 20;
  const std::size_t named = std::min(files.size(), kMostNamed);
  const std::string names = absl::StrJoin(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(named), ", ");
  return named == files.size() ? names : absl::StrCat(names, " and ", files.size() - named, " more");
}

// Names a file's only label by the file, if the file names a structure that is known.
bool NameByFile(const v1::LabelMap& known, const std::string& file, const std::map<Label, Extent>& extents,
                LabelVolume& volume) {
  if (extents.size() != 1) return false;
  const std::string structure = LabelOfFile(known, StemOf(file));
  if (structure.empty()) return false;
  volume.names[extents.begin()->first] = structure;
  return true;
}

}  // namespace

absl::Status LabelSet::CheckGrid(const std::string& name, const LabelVolume& volume) const {
  constexpr double kSame = 0.1;  // of the spacing, at every corner
  const double most = kSame * volume.Spacing().minCoeff();
  bool same = volume.size == united_.size;
  for (int corner = 0; same && corner < 8; ++corner) {
    const Eigen::Vector3d at =
        volume.size.cast<double>().cwiseProduct(Eigen::Vector3d(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1));
    same = (volume.to_patient * at - united_.to_patient * at).norm() <= most;
  }
  if (same) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      name, ": has ", GridWords(volume), ", and ", first_, " has ", GridWords(united_),
      ": the files of one patient need one grid; resample this file to the other's (nearest neighbour), or "
      "leave it out"));
}

absl::Status LabelSet::Name(const std::string& file, const std::string& choice, LabelVolume& volume) {
  if (!volume.names.empty()) return absl::OkStatus();
  const absl::StatusOr<v1::LabelMap> names = ReadLabelMap(kNamesMap);
  if (!names.ok()) return names.status();
  const std::map<Label, Extent> extents = Extents(volume);
  if (extents.empty()) {
    united_.remarks.push_back(absl::StrCat(file, ": has no labelled voxel"));
    return absl::OkStatus();
  }
  if (NameByFile(WithCommonNames(*names), file, extents, volume)) return absl::OkStatus();
  std::vector<std::string> remarks;
  const absl::StatusOr<MapFit> fit = ChooseMap(volume, StemOf(file), choice, remarks);
  if (!fit.ok()) return fit.status();
  const bool single = extents.size() == 1 && !fit->named && choice.empty();
  if (!single && fit->agree > 0) {
    for (const v1::LabelMeaning& label : fit->map.labels()) volume.names[label.number()] = label.name();
    for (const std::string& remark : remarks) united_.remarks.push_back(absl::StrCat(file, ": ", remark));
  } else {
    unknown_.push_back(file);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::map<Label, Label>> LabelSet::Number(const std::string& file, const LabelVolume& volume) {
  std::map<Label, Label> numbers;
  for (const auto& [label, extent] : Extents(volume)) {
    if (entries_.size() >= kMostNumbers) {
      return absl::ResourceExhaustedError(
          absl::StrCat(file, ": the files have more than ", kMostNumbers, " labels; leave files out"));
    }
    const auto name = volume.names.find(label);
    Entry entry = {file, "", extent.voxels};
    const auto number = static_cast<Label>(entries_.size() + 1);
    if (name != volume.names.end()) {
      entry.words = SortedWords(PlainWords(name->second));
      united_.names[number] = name->second;
    } else {
      united_.names[number] = absl::StrCat(StemOf(file), " ", label);
    }
    if (const auto meaning = volume.meanings.find(label); meaning != volume.meanings.end()) {
      united_.meanings[number] = meaning->second;
    }
    entries_.push_back(std::move(entry));
    numbers[label] = number;
  }
  return numbers;
}

LabelSet::Shared LabelSet::Paint(const std::map<Label, Label>& numbers, const LabelVolume& volume) {
  Shared shared;
  std::vector<Label> becomes(kMostNumbers + 1);
  for (const auto& [label, number] : numbers) becomes[label] = number;
  for (std::size_t at = 0; at < volume.labels.size(); ++at) {
    const Label added = becomes[volume.labels[at]];
    if (added == 0) continue;
    Label& here = united_.labels[at];
    if (here != 0) ++shared[{added, here}];
    if (here == 0 || entries_[added - 1].voxels < entries_[here - 1].voxels) here = added;
  }
  return shared;
}

absl::Status LabelSet::FindRepeated(const Shared& shared) {
  std::map<std::string, Label> seen;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    Entry& entry = entries_[e];
    if (entry.words.empty() || entry.same != 0) continue;
    const auto number = static_cast<Label>(e + 1);
    const auto [first, added] = seen.emplace(entry.words, number);
    const Entry& other = entries_[first->second - 1];
    if (added || other.file == entry.file) continue;
    const auto both = shared.find({number, first->second});
    const double common = both == shared.end() ? 0 : static_cast<double>(both->second);
    const std::string& name = united_.names[number];
    if (2 * common < kSameStructure * static_cast<double>(entry.voxels + other.voxels)) {
      return absl::InvalidArgumentError(
          absl::StrCat(entry.file, ": \"", name, "\" is in ", other.file,
                       " too, with other voxels; leave one of the files out, or rename it "
                       "by what it shows"));
    }
    entry.same = first->second;
    united_.remarks.push_back(absl::StrCat(name, ": in ", other.file, " and in ", entry.file, ", as the same voxels"));
  }
  return absl::OkStatus();
}

void LabelSet::CountHidden(const Shared& shared) {
  for (const auto& [labels, voxels] : shared) {
    Entry &added = entries_[labels.first - 1], &here = entries_[labels.second - 1];
    if (added.same != labels.second) (added.voxels < here.voxels ? here : added).hidden += voxels;
  }
}

absl::Status LabelSet::Add(const std::string& name, LabelVolume volume, const std::string& choice) {
  if (++files_ > kMostLabelFiles) {
    return absl::ResourceExhaustedError(
        absl::StrCat("there are more than ", kMostLabelFiles, " label files; give those of one patient"));
  }
  if (first_.empty()) {
    first_ = name;
    united_.size = volume.size;
    united_.to_patient = volume.to_patient;
    united_.labels.assign(volume.labels.size(), 0);
  } else if (absl::Status status = CheckGrid(name, volume); !status.ok()) {
    return status;
  }
  for (const std::string& remark : volume.remarks) united_.remarks.push_back(absl::StrCat(name, ": ", remark));
  if (absl::Status status = Name(name, choice, volume); !status.ok()) return status;
  const absl::StatusOr<std::map<Label, Label>> numbers = Number(name, volume);
  if (!numbers.ok()) return numbers.status();
  const Shared shared = Paint(*numbers, volume);
  if (absl::Status status = FindRepeated(shared); !status.ok()) return status;
  CountHidden(shared);
  return absl::OkStatus();
}

void LabelSet::DropHidden() {
  std::vector<Label> becomes(entries_.size() + 1);
  std::size_t overlapping = 0;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const Entry& entry = entries_[e];
    const auto number = static_cast<Label>(e + 1);
    const bool hidden = static_cast<double>(entry.hidden) > kMostHidden * static_cast<double>(entry.voxels);
    becomes[number] = entry.same != 0 ? entry.same : number;
    if (entry.same == 0 && !hidden) {
      overlapping += entry.hidden;
      continue;
    }
    if (entry.same == 0) {
      becomes[number] = 0;
      united_.remarks.push_back(absl::StrCat(united_.names[number], " of ", entry.file,
                                             ": left out, because smaller structures fill most of it"));
    }
    united_.names.erase(number);
    united_.meanings.erase(number);
  }
  if (overlapping > 0) {
    united_.remarks.push_back(
        absl::StrCat("labels of different files overlap in ", overlapping, " voxels; the smaller structure counts"));
  }
  for (Label& label : united_.labels) label = becomes[label];
}

void LabelSet::LeaveOut(const std::string& name, const std::string& problem) {
  constexpr std::size_t kMostProblems = 20;
  const bool apart = problem.empty() || left_out_.size() < kMostProblems || left_out_.contains(problem);
  left_out_[apart ? problem : "for other reasons; give one of them alone to see its own"].push_back(name);
}

std::string LabelSet::LeftOutWords() const {
  std::string words;
  for (const auto& [problem, files] : left_out_) {
    if (!problem.empty()) absl::StrAppend(&words, "; left out: ", Listed(files), ": ", problem);
  }
  return words;
}

absl::StatusOr<LabelVolume> LabelSet::Finish() {
  if (empty()) return absl::InvalidArgumentError("there is no label file");
  DropHidden();
  if (!unknown_.empty()) {
    united_.remarks.push_back(absl::StrCat("not known by their names or numbers: ", absl::StrJoin(unknown_, ", ")));
  }
  for (const auto& [problem, files] : left_out_) {
    united_.remarks.push_back(problem.empty()
                                  ? absl::StrCat("left out, because they are not label files: ", Listed(files))
                                  : absl::StrCat("left out: ", Listed(files), ": ", problem));
  }
  return std::move(united_);
}

}  // namespace phrenic::imaging
