// Motions in the thesis' .depl format (table 4.1). README.md in this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_DEPL_H_
#define PHRENIC_SERVER_RECORD_DEPL_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder. The format is ordered by vertex, so frames are spooled to disk and transposed by VertexSpool,
// which bounds the memory. AddFrame rounds positions to nanometres, so that the changes from frame to frame add up
// exactly. Begin, AddFrame and End also return the errors of VertexSpool; End writes the whole file and reports every
// 64 vertices.
std::unique_ptr<Recorder> MakeDeplRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_DEPL_H_
