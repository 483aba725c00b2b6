// Numbers over time as comma-separated values. README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_CSV_H_
#define PHRENIC_SERVER_RECORD_CSV_H_

#include "server/record/recorder.h"

namespace phrenic::record {

std::unique_ptr<Recorder> MakeCsvRecorder(Settings settings);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_CSV_H_
