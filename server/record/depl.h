// Motions in the thesis' .depl format (table 4.1). README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_DEPL_H_
#define PHRENIC_SERVER_RECORD_DEPL_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// The format runs vertex by vertex, so all frames are held until the end; RESOURCE_EXHAUSTED past 1 GiB.
std::unique_ptr<Recorder> MakeDeplRecorder(Sink sink);
// The same past `max_bytes` of frames.
std::unique_ptr<Recorder> MakeBoundedDeplRecorder(Sink sink, std::size_t max_bytes);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_DEPL_H_
