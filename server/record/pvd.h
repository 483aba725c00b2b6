// Motions for ParaView: a .vtp a frame, and the .pvd that has their times. README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_PVD_H_
#define PHRENIC_SERVER_RECORD_PVD_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Holds one frame, the first; every other one goes to the sink as it comes, and the .pvd last.
std::unique_ptr<Recorder> MakePvdRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_PVD_H_
