// Reads the pixels of a DICOM Segmentation (PS3.5, 8.1 and D; PS3.3, C.8.20.2).
#ifndef PHRENIC_SERVER_IMAGING_DICOM_PIXELS_H_
#define PHRENIC_SERVER_IMAGING_DICOM_PIXELS_H_

#include <cstddef>
#include <cstdint>

#include "absl/status/statusor.h"

class DcmDataset;

namespace phrenic::imaging {

// Pixels of all frames, one frame after the other without gaps. Views into the data set.
struct DicomPixels {
  std::size_t rows = 0, columns = 0;
  int frames = 0;
  bool label_map = false;                // pixels are segment numbers
  int bits = 0;                          // of a pixel: 1, 8 or 16
  unsigned least = 1;                    // least value inside a segment
  unsigned background = 0;               // of label maps
  const std::uint8_t* bytes = nullptr;   // if bits is 1 (the lowest bit first) or 8
  const std::uint16_t* words = nullptr;  // if bits is 16

  std::size_t in_frame() const { return rows * columns; }
  unsigned at(std::size_t pixel) const {
    if (bits == 1) return bytes[pixel / 8] >> (pixel % 8) & 1;
    return bits == 8 ? bytes[pixel] : words[pixel];
  }
  // Calls then(pixel in the frame, value) for each pixel that is not background.
  template <typename Then>
  void ForEachInside(int frame, const Then& then) const {
    const std::size_t start = frame * in_frame();
    for (std::size_t p = 0; p < in_frame(); ++p) {
      if (bits == 1 && (start + p) % 8 == 0) {  // most bytes are empty
        while (in_frame() - p >= 8 && bytes[(start + p) / 8] == 0) p += 8;
        if (p == in_frame()) return;
      }
      const unsigned value = at(start + p);
      if (value >= least && !(label_map && value == background)) then(p, value);
    }
  }
};

// Reads size, type and pixels; RLE is decoded. Every size is checked against the pixels that are there, and RLE, whose
// size is not bounded by the file's, against kMaxVoxels. INVALID_ARGUMENT with attribute and remedy. The data set must
// outlive the result.
absl::StatusOr<DicomPixels> ReadDicomPixels(DcmDataset& dataset);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_PIXELS_H_
