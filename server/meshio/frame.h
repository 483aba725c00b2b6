// The patient frame that a file states in a comment, a header or a field, by 3D Slicer's convention "SPACE=LPS".
// All functions are thread-safe.
#ifndef PHRENIC_SERVER_MESHIO_FRAME_H_
#define PHRENIC_SERVER_MESHIO_FRAME_H_

#include <string>
#include <string_view>

#include "server/meshio/meshio.h"

namespace phrenic::meshio {

// Reads every statement of the frame in `text`, a comment or a header: the word SPACE, "=" or ":", and the name of a
// frame, in any case and with blanks and quotes around the name: "space = ras", "SPACE:LPS", NRRD's
// "left-posterior-superior". Without a sign between, only the name of a frame makes a statement. Sets `frame`, and
// leaves it unchanged without a statement. Returns an empty text, or the fault: another frame ("SPACE=RAST",
// "SPACE=LAS"), or one that contradicts `frame`. The parsers call it for each comment and header, and add the position
// to the fault.
std::string ReadFrame(std::string_view text, Frame& frame);

// The same for the value of a VTK field "SPACE": the name of a frame, or a statement. A value that is neither is a
// fault.
std::string ReadFrameField(std::string_view value, Frame& frame);

// True if `name` is that of a field that states the frame.
bool IsFrameField(std::string_view name);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_FRAME_H_
