// Pictures of line integrals as files.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_PICTURE_FILE_H_
#define PHRENIC_SERVER_FLUOROSCOPY_PICTURE_FILE_H_

#include <string>

#include "server/fluoroscopy/projection.h"

namespace phrenic::fluoroscopy {

// The line integrals that are black and white.
struct Window {
  double low = 0, high = 1;
};

// Returns the window in which nearly all rays through the trunk are grey, as the page chooses it.
Window WindowOf(const Picture& sums);

// Returns a PNG file of 16-bit grey (ISO 15948): linear in the line integral, so in the logarithm of the transmitted
// intensity, within the window. `dark_bones` inverts it.
std::string WritePng(const Picture& sums, const Window& window, bool dark_bones);

// Returns an uncompressed NIfTI-1 file of the line integrals, float32, size x size x 1, at the place of the isocentre's
// plane in the patient. Unlike NIfTI's usual grids, its rows go down the picture.
std::string WriteNifti(const Picture& sums, const Projection& projection);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_PICTURE_FILE_H_
