// Motions as glTF 2.0 in one binary file (.glb): an animation of morph targets. README.md beside this file is the
// format.
#ifndef PHRENIC_SERVER_RECORD_GLTF_H_
#define PHRENIC_SERVER_RECORD_GLTF_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// The file's head tells its length, and viewers hold every frame at once, so that this does too: RESOURCE_EXHAUSTED
// past 64 MiB of key frames, or 1,000 of them.
std::unique_ptr<Recorder> MakeGltfRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_GLTF_H_
