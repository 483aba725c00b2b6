#include "server/imaging/rt_structures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/contours/contour_fill.h"
#include "server/imaging/dicom_text.h"
#include "server/imaging/slice_stack.h"

namespace phrenic::imaging {
namespace {

constexpr double kContourPixel = 1.5;       // [mm]
constexpr double kMostContourVoxels = 3e7;  // voxels
constexpr double kWidestContours = 3000;    // extent of all contours [mm]
constexpr double kOffContourPlane = 0.05;   // largest deviation of a contour from its slice [mm]
constexpr double kMostRowsCrossed = 5e7;    // by all edges
constexpr double kMostBoxPixels = 2e9;      // of all contours: 300 slices with 100 regions as large as a trunk
constexpr int kPixelsAround = 2;            // free pixels around contours

// A region of interest.
struct ContouredRegion {
  int number = 0;
  std::string name, meaning;
  std::vector<Eigen::Matrix2Xd> contours;  // x and y [mm]
  std::vector<double> heights;             // z of each [mm]
};

// Where an error is: "contour 3 of the region 7".
struct ContourOrigin {
  int region = 0, contour = 0;
  absl::Status Error(const std::string& what) const {
    return absl::InvalidArgumentError(absl::StrCat("contour ", contour, " of the region ", region, ": ", what));
  }
};

// Calls then(item) for each item of a sequence until an error.
template <typename Then>
absl::Status ForEachContourItem(DcmItem& parent, const DcmTagKey& attribute, const Then& then) {
  DcmSequenceOfItems* sequence = nullptr;
  if (parent.findAndGetSequence(attribute, sequence).bad() || sequence == nullptr) return absl::OkStatus();
  DcmObject* next = nullptr;
  while ((next = sequence->nextInContainer(next)) != nullptr) {
    if (absl::Status status = then(static_cast<DcmItem&>(*next)); !status.ok()) return status;
  }
  return absl::OkStatus();
}

int IntegerAt(DcmItem& item, const DcmTagKey& attribute) {
  Sint32 number = 0;
  return item.findAndGetSint32(attribute, number).good() ? static_cast<int>(number) : 0;
}

// Parses numbers between backslashes. Returns false if one is not finite.
bool ParseDecimals(std::string_view text, std::vector<double>& numbers) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\\'), text.size());
    std::string_view word = text.substr(0, end);
    while (!word.empty() && (word.front() == ' ' || word.front() == '+')) word.remove_prefix(1);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\0')) word.remove_suffix(1);
    double number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(number)) return false;
    numbers.push_back(number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

absl::Status AddContour(DcmItem& item, const ContourOrigin& origin, ContouredRegion& region) {
  OFString data;
  std::vector<double> numbers;
  if (item.findAndGetOFStringArray(DCM_ContourData, data).bad() ||
      !ParseDecimals({data.c_str(), data.length()}, numbers)) {
    return origin.Error("ContourData (3006,0050) is missing or not a list of numbers; export the structures again");
  }
  const std::size_t stated = static_cast<std::size_t>(std::max(0, IntegerAt(item, DCM_NumberOfContourPoints)));
  if (numbers.size() % 3 != 0 || (stated != 0 && numbers.size() != 3 * stated)) {
    return origin.Error(absl::StrCat("ContourData (3006,0050) has ", numbers.size(),
                                     " numbers, NumberOfContourPoints (3006,0046) is ", stated,
                                     "; export the structures again"));
  }
  const Eigen::Map<const Eigen::Matrix3Xd> points(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3));
  if (points.cols() < 3) return absl::OkStatus();  // encloses nothing
  if (points.row(2).maxCoeff() - points.row(2).minCoeff() > kOffContourPlane) {
    return origin.Error(absl::StrCat("it is not in an axial slice: z is ", points.row(2).minCoeff(), " to ",
                                     points.row(2).maxCoeff(),
                                     " mm in ContourData (3006,0050); export contours of "
                                     "axial slices, or a DICOM Segmentation"));
  }
  if (points.topRows<2>().cwiseAbs().maxCoeff() > 1e6 || std::abs(points(2, 0)) > 1e6) {
    return origin.Error("it is more than a kilometre away (ContourData, 3006,0050); export the structures again");
  }
  region.contours.emplace_back(points.topRows<2>());
  region.heights.push_back(points(2, 0));
  return absl::OkStatus();
}

// The regions of a structure set that have contours.
struct StructureSet {
  std::vector<ContouredRegion> regions;
  std::size_t skipped = 0;  // contours that are not closed
};

absl::Status ReadRegion(DcmItem& item, std::map<int, ContouredRegion>& named, StructureSet& set) {
  ContouredRegion region = named[IntegerAt(item, DCM_ReferencedROINumber)];
  region.number = IntegerAt(item, DCM_ReferencedROINumber);
  ContourOrigin origin{region.number, 0};
  absl::Status status = ForEachContourItem(item, DCM_ContourSequence, [&](DcmItem& contour) {
    ++origin.contour;
    const std::string type = TextOf(&contour, DCM_ContourGeometricType);
    if (type == "CLOSED_PLANAR" || type == "CLOSEDPLANAR_XOR") return AddContour(contour, origin, region);
    ++set.skipped;
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  if (!region.contours.empty()) set.regions.push_back(std::move(region));
  return absl::OkStatus();
}

absl::StatusOr<StructureSet> ReadSet(DcmDataset& dataset) {
  Utf8 in_utf8(dataset);
  std::map<int, ContouredRegion> named;
  (void)ForEachContourItem(dataset, DCM_StructureSetROISequence, [&](DcmItem& item) {
    named[IntegerAt(item, DCM_ROINumber)].name = in_utf8(TextOf(&item, DCM_ROIName));
    return absl::OkStatus();
  });
  (void)ForEachContourItem(dataset, DCM_RTROIObservationsSequence, [&](DcmItem& item) {
    DcmItem* code = FirstItem(&item, DCM_RTROIIdentificationCodeSequence);
    named[IntegerAt(item, DCM_ReferencedROINumber)].meaning = in_utf8(TextOf(code, DCM_CodeMeaning));
    return absl::OkStatus();
  });
  StructureSet set;
  absl::Status status =
      ForEachContourItem(dataset, DCM_ROIContourSequence, [&](DcmItem& item) { return ReadRegion(item, named, set); });
  if (!status.ok()) return status;
  if (!set.regions.empty()) return set;
  return absl::InvalidArgumentError(
      "it is an RT Structure Set without closed contours (ROIContourSequence, 3006,0039); export the structures with "
      "their contours, or a DICOM Segmentation");
}

// Returns the slices of all contours, and for each contour in the order of the regions its slice.
absl::StatusOr<SliceStack> StackContours(const StructureSet& set) {
  std::vector<Eigen::Vector3d> positions;
  Eigen::AlignedBox2d box;
  double crossed = 0, pixels = 0;
  for (const ContouredRegion& region : set.regions) {
    for (std::size_t c = 0; c < region.contours.size(); ++c) {
      const Eigen::Matrix2Xd& contour = region.contours[c];
      box.extend(Eigen::Vector2d(contour.rowwise().minCoeff())).extend(Eigen::Vector2d(contour.rowwise().maxCoeff()));
      crossed += RowsCrossed(contour / kContourPixel);
      pixels += BoxPixels(contour / kContourPixel);
      positions.emplace_back(0, 0, region.heights[c]);
    }
  }
  if (!(box.sizes().maxCoeff() <= kWidestContours)) {
    return absl::InvalidArgumentError(absl::StrCat("its contours extend over ", box.sizes().maxCoeff(),
                                                   " mm, and a thorax is smaller than ", kWidestContours,
                                                   " mm (ContourData, 3006,0050); export the structures again"));
  }
  if (crossed > kMostRowsCrossed) {
    return absl::InvalidArgumentError(
        "its contours have too many long edges (ContourData, 3006,0050); simplify them, or export a DICOM "
        "Segmentation");
  }
  if (pixels > kMostBoxPixels) {
    return absl::InvalidArgumentError(
        "its contours enclose too many pixels together (ContourData, 3006,0050); export the regions of the thorax "
        "alone, or a DICOM Segmentation");
  }
  const auto stack_with = [&](double pixel) {
    for (Eigen::Vector3d& position : positions) {
      position.head<2>() = box.min().array() - kPixelsAround * pixel;
    }
    return StackSlices({pixel * Eigen::Vector3d::UnitX(), pixel * Eigen::Vector3d::UnitY()}, positions, 0);
  };
  return stack_with(kContourPixel);
}

// Returns the number of pixels in the plane, and makes them larger if the volume has too many voxels.
Eigen::Vector2i SizePlane(const StructureSet& set, SliceStack& stack) {
  Eigen::AlignedBox2d box;
  for (const ContouredRegion& region : set.regions) {
    for (const Eigen::Matrix2Xd& contour : region.contours) {
      box.extend(Eigen::Vector2d(contour.rowwise().minCoeff())).extend(Eigen::Vector2d(contour.rowwise().maxCoeff()));
    }
  }
  double pixel = kContourPixel;
  const auto size_with = [&](double edge) -> Eigen::Vector2d {
    return (box.sizes() / edge).array().ceil() + 1 + 2 * kPixelsAround;
  };
  while (size_with(pixel).prod() * stack.slices > kMostContourVoxels) pixel *= 1.02;
  stack.to_patient.linear().col(0) = pixel * Eigen::Vector3d::UnitX();
  stack.to_patient.linear().col(1) = pixel * Eigen::Vector3d::UnitY();
  stack.to_patient.translation().head<2>() = box.min().array() - kPixelsAround * pixel;
  return size_with(pixel).cast<int>();
}

// Fills regions of one set in one volume.
class RegionFiller {
 public:
  RegionFiller(const StructureSet& set, const SliceStack& stack, LabelVolume& volume) : volume_(volume) {
    std::size_t next = 0;
    const Eigen::Vector2d origin = stack.to_patient.translation().head<2>();
    const Eigen::Vector2d pixel(stack.to_patient(0, 0), stack.to_patient(1, 1));
    for (const ContouredRegion& region : set.regions) {
      auto& slices = slices_.emplace_back();
      for (const Eigen::Matrix2Xd& contour : region.contours) {
        slices[stack.slice_of[next++]].push_back((contour.colwise() - origin).array().colwise() / pixel.array());
      }
    }
  }

  // Calls then(index) for each voxel of a region.
  template <typename Then>
  void ForEachVoxel(std::size_t region, const Then& then) const {
    for (const auto& [k, contours] : slices_[region]) {
      std::vector<const Contour*> pointers;
      for (const Contour& contour : contours) pointers.push_back(&contour);
      for (const PixelRun& run : FillContours(pointers, volume_.size.head<2>())) {
        const std::size_t row = volume_.Index({0, run.row, k});
        for (int i = run.first; i <= run.last; ++i) then(row + static_cast<std::size_t>(i));
      }
    }
  }

  // Returns how many slices between the first and the last of a region have no contour of it.
  int Gaps(std::size_t region) const {
    const auto& slices = slices_[region];
    return slices.rbegin()->first - slices.begin()->first + 1 - static_cast<int>(slices.size());
  }

 private:
  LabelVolume& volume_;
  std::vector<std::map<int, std::vector<Contour>>> slices_;  // of each region, by slice
};

// Returns the regions' labels.
std::vector<Label> RegionLabels(const StructureSet& set) {
  std::set<int> numbers;
  std::vector<Label> labels, counted;
  for (const ContouredRegion& region : set.regions) {
    numbers.insert(region.number);
    labels.push_back(static_cast<Label>(region.number));
    counted.push_back(static_cast<Label>(counted.size() + 1));
  }
  const bool usable = numbers.size() == set.regions.size() && *numbers.begin() >= 1 &&
                      *numbers.rbegin() <= std::numeric_limits<Label>::max();
  return usable ? labels : counted;
}

void FillRegions(const StructureSet& set, const RegionFiller& filler, LabelVolume& volume) {
  std::vector<std::size_t> voxels(set.regions.size(), 0), order(set.regions.size());
  for (std::size_t r = 0; r < order.size(); ++r) filler.ForEachVoxel(r, [&](std::size_t) { ++voxels[r]; });
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return voxels[a] > voxels[b]; });
  const std::vector<Label> labels = RegionLabels(set);
  std::size_t overlaps = 0;
  for (const std::size_t r : order) {
    filler.ForEachVoxel(r, [&](std::size_t at) {
      overlaps += volume.labels[at] != 0 ? 1 : 0;
      volume.labels[at] = labels[r];
    });
    volume.names.emplace(labels[r], set.regions[r].name);
    volume.meanings.emplace(labels[r], set.regions[r].meaning);
    if (const int gaps = filler.Gaps(r); gaps > 0) {
      volume.remarks.push_back(absl::StrCat("the region \"", set.regions[r].name, "\" has no contour in ", gaps,
                                            " slices between its first and its last one, where it is empty"));
    }
  }
  if (overlaps > 0) {
    volume.remarks.push_back(absl::StrCat("regions overlap in ", overlaps, " voxels; the smaller region counts there"));
  }
  if (set.skipped > 0) {
    volume.remarks.push_back(absl::StrCat(set.skipped, " points and open contours are left out"));
  }
}

}  // namespace

absl::StatusOr<LabelVolume> ReadRtStructures(DcmDataset& dataset) {
  const absl::StatusOr<StructureSet> set = ReadSet(dataset);
  if (!set.ok()) return set.status();
  if (set->regions.size() > std::numeric_limits<Label>::max()) {
    return absl::InvalidArgumentError("it has more than 65535 regions; export those of the thorax");
  }
  absl::StatusOr<SliceStack> stack = StackContours(*set);
  if (!stack.ok()) return stack.status();
  constexpr double kMostSlices = 1e5;
  if (stack->slices > kMostSlices)
    return absl::InvalidArgumentError("it has too many slices; export those of the thorax");
  const Eigen::Vector2i plane = SizePlane(*set, *stack);
  LabelVolume volume;
  volume.size = {plane.x(), plane.y(), stack->slices};
  volume.to_patient = stack->to_patient;
  if (!IsVoxelFrame(volume.to_patient)) {
    return absl::InvalidArgumentError(absl::StrCat("its contours do not make a grid with ", kVoxelFrameRule,
                                                   "; export contours of every slice of the CT"));
  }
  volume.labels.assign(static_cast<std::size_t>(plane.x()) * plane.y() * stack->slices, 0);
  FillRegions(*set, RegionFiller(*set, *stack, volume), volume);
  return volume;
}

}  // namespace phrenic::imaging
