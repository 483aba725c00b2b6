// Motions for ParaView: one .vtp per frame and a .pvd with their times. README.md in this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_PVD_H_
#define PHRENIC_SERVER_RECORD_PVD_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder that keeps one frame, the first, streams the others to the sink, and writes the .pvd last. The
// sink gets a zip archive (Archive). Points and displacements are in millimetres; with Values::kDisplacements the
// points stay those of the first frame. Begin writes nothing.
std::unique_ptr<Recorder> MakePvdRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_PVD_H_
