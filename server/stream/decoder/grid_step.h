// The step of the grid that positions are rounded to: what encoders may write and decoders accept.
#ifndef PHRENIC_SERVER_STREAM_DECODER_GRID_STEP_H_
#define PHRENIC_SERVER_STREAM_DECODER_GRID_STEP_H_

namespace phrenic::stream {

inline constexpr double kLargestStep = 1;  // [m]: decoders accept steps in (0, kLargestStep]

// True for a step that decoders accept: 2^31 steps are then finite as float32.
inline bool IsGridStep(double step) { return step > 0 && step <= kLargestStep; }

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_GRID_STEP_H_
