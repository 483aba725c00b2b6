// Motions as Gmsh MSH 2.2 text with $NodeData. README.md in this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_MSH_H_
#define PHRENIC_SERVER_RECORD_MSH_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder that keeps one frame, the first, and streams the others to the sink.
std::unique_ptr<Recorder> MakeMshRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_MSH_H_
