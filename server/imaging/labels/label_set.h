// Several label files of one patient, as TotalSegmentator, MOOSE and CADS write them, as one volume.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_SET_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_SET_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

inline constexpr std::size_t kMostLabelFiles = 300;

// Collects label files of one grid, in any order; one owner, one thread. Labels get new numbers from 1: those of the
// first file, then those of the next. Each has a name: that in its file, else for a file of one label the words of the
// file's name, else by a map (label_fit.h). Where labels overlap, the one with fewer voxels counts.
class LabelSet {
 public:
  // Adds a file. `choice` selects its map, as ReadMaps. INVALID_ARGUMENT "b.nii.gz: ..." if its grid differs from the
  // first file's, or a structure is in another file too with other voxels (Dice below 0.8); RESOURCE_EXHAUSTED for
  // more than kMostLabelFiles, or 65,535 labels; the errors of ReadMaps.
  absl::Status Add(const std::string& name, LabelVolume volume, const std::string& choice);
  // Notes a file that is not read: `problem` is what is wrong with it, and the remedy; empty for a file of another
  // format. Tells the first 20 problems apart.
  void LeaveOut(const std::string& name, const std::string& problem);
  // Returns which files with a problem were left out, and why: "; left out: a.nii: ...". Empty without such files.
  std::string LeftOutWords() const;
  // True if no file was added.
  bool empty() const { return files_ == 0; }
  // Returns the volume; its remarks name the files' maps, files that were left out, and labels that others hide or that
  // are in two files. INVALID_ARGUMENT if no file was added. Call it once, last.
  absl::StatusOr<LabelVolume> Finish();

 private:
  struct Entry {
    std::string file;
    std::string words;       // of its name, sorted
    std::size_t voxels = 0;  // in its file
    std::size_t hidden = 0;  // under other labels
    Label same = 0;          // number of the structure in an earlier file; 0 if it is in none
  };
  absl::Status CheckGrid(const std::string& name, const LabelVolume& volume) const;
  // Names the labels of a volume.
  absl::Status Name(const std::string& file, const std::string& choice, LabelVolume& volume);
  // Returns the new number of each label of a volume.
  absl::StatusOr<std::map<Label, Label>> Number(const std::string& file, const LabelVolume& volume);
  // Voxels that two labels share, by numbers: the later, the earlier.
  using Shared = std::map<std::pair<Label, Label>, std::size_t>;
  Shared Paint(const std::map<Label, Label>& numbers, const LabelVolume& volume);
  // Finds structures of the last file that an earlier file has.
  absl::Status FindRepeated(const Shared& shared);
  void CountHidden(const Shared& shared);
  void DropHidden();

  LabelVolume united_;
  std::string first_;           // file
  std::vector<Entry> entries_;  // by number - 1
  std::size_t files_ = 0;
  std::vector<std::string> unknown_;                          // files that name no known structure
  std::map<std::string, std::vector<std::string>> left_out_;  // by problem
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_SET_H_
