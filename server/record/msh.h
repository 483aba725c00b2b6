// Motions as Gmsh 2.2 text with NodeData. README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_MSH_H_
#define PHRENIC_SERVER_RECORD_MSH_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Holds one frame, the first; every other one goes to the sink as it comes.
std::unique_ptr<Recorder> MakeMshRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_MSH_H_
