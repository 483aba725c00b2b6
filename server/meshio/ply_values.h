// A cursor over the numbers in the body of a PLY file, text or binary.
#ifndef PHRENIC_SERVER_MESHIO_PLY_VALUES_H_
#define PHRENIC_SERVER_MESHIO_PLY_VALUES_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/meshio/ply_header.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {

// Not thread-safe. In binary, rows have no delimiter: the caller takes the properties of the header in order.
class PlyValues {
 public:
  virtual ~PlyValues() = default;
  // Moves to the next row of an element (in text: the next non-blank line). Returns false at the end of the file. In
  // binary: true while bytes are left.
  virtual bool NextRow() = 0;
  // Reads the row's next number, NaN if the text is not a finite number. Returns false at the end of the row or file.
  // Text ignores `type`.
  virtual bool Take(PlyType type, double& number) = 0;
  // True if the row has no further numbers; always true in binary.
  virtual bool AtEndOfRow() const = 0;
  // True if the file has no further data. In text it moves to the next non-blank line.
  virtual bool AtEnd() = 0;
  // Returns INVALID_ARGUMENT with the current line or byte.
  virtual absl::Status Error(const std::string& message) const = 0;
};

// Returns a cursor at the start of the body. Requires: `reader` has read the header of `bytes`, which must outlive the
// result.
std::unique_ptr<PlyValues> MakePlyValues(PlyEncoding encoding, std::string_view name, std::string_view bytes,
                                         const TextReader& reader);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_PLY_VALUES_H_
