// Motions as binary glTF 2.0 (.glb; Khronos, "glTF 2.0 Specification"): an animation of morph targets. README.md in
// this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_GLTF_H_
#define PHRENIC_SERVER_RECORD_GLTF_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder that keeps all frames in memory, because the file's header has its length and viewers load every
// frame. AddFrame returns RESOURCE_EXHAUSTED beyond 64 MiB of key frames or 1,000 of them. A frame takes 12 bytes per
// vertex: float32 [m]. Times are relative to the first frame; a root node turns LPS to +y up. End passes the whole file
// to the sink in one call. Bodies without triangles and edges are left out.
std::unique_ptr<Recorder> MakeGltfRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_GLTF_H_
