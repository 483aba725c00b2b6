// Motions as Gmsh MSH 2.2 text with $NodeData. README.md in this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_MSH_H_
#define PHRENIC_SERVER_RECORD_MSH_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder that keeps one frame, the first, and streams the others to the sink. Writes millimetres: positions
// with 9 digits, or displacements from the first frame with 6 (Settings::values). AddFrame returns INTERNAL if a frame
// has another number of vertices than the first.
std::unique_ptr<Recorder> MakeMshRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_MSH_H_
