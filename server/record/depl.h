// Motions in the thesis' .depl format (table 4.1). README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_DEPL_H_
#define PHRENIC_SERVER_RECORD_DEPL_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// The format runs vertex by vertex: frames are spooled to disk and transposed there, in VertexSpool's memory.
std::unique_ptr<Recorder> MakeDeplRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_DEPL_H_
