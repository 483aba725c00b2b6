// Numbers over time as comma-separated values (RFC 4180). README.md in this folder specifies the format.
#ifndef PHRENIC_SERVER_RECORD_CSV_H_
#define PHRENIC_SERVER_RECORD_CSV_H_

#include "server/record/recorder.h"

namespace phrenic::record {

// Returns a recorder that writes one row per frame and keeps nothing. Writes the times [s] with 12 digits and the
// numbers with 9, in the units of Recording::columns; ignores bodies. Lines end with "\n"; a line break in a name
// becomes a blank.
std::unique_ptr<Recorder> MakeCsvRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_CSV_H_
