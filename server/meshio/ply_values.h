// The body of a PLY file, number by number, in text or binary.
#ifndef PHRENIC_SERVER_MESHIO_PLY_VALUES_H_
#define PHRENIC_SERVER_MESHIO_PLY_VALUES_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/meshio/ply_header.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {

class PlyValues {
 public:
  virtual ~PlyValues() = default;
  // Moves to the next row of an element, in text to the next line; false at the file's end.
  virtual bool NextRow() = 0;
  // The row's next number, which may be none that is finite; false where there is none left.
  virtual bool Take(PlyType type, double& number) = 0;
  // Whether nothing of the row is left.
  virtual bool RowIsDone() const = 0;
  // Whether nothing of the file is left.
  virtual bool FileIsDone() = 0;
  // INVALID_ARGUMENT at the present line or byte.
  virtual absl::Status Error(const std::string& message) const = 0;
};

// Those after the header, which `reader` has read of `bytes`. Holds views into `bytes`.
std::unique_ptr<PlyValues> MakePlyValues(PlyEncoding encoding, std::string_view name, std::string_view bytes,
                                         const TextReader& reader);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_PLY_VALUES_H_
