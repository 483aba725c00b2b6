// Out-of-core transposition: positions are added frame by frame and read vertex by vertex.
#ifndef PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_
#define PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "server/mesh/mesh.h"
#include "server/record/spool_file.h"

namespace phrenic::record {

// Collects frames in tiles of several frames and all vertices and appends each full tile to the file ordered by vertex.
// A block of consecutive vertices then takes one read per tile. Memory: two buffers of about `buffer_bytes` and the
// rows of one vertex, independent of the number of frames. Not thread-safe. The .depl recorder owns one and stores
// nanometres. Numbers are in the byte order of the machine, since no other process reads the file.
class VertexSpool {
 public:
  using Rows = Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>;    // one column per frame, or per vertex
  static constexpr std::size_t kBuffer = std::size_t{32} << 20;   // [bytes]
  static constexpr std::int64_t kRow = 3 * sizeof(std::int64_t);  // [bytes]

  // Errors as SpoolFile::Open. The file holds 24 bytes per vertex and frame.
  static absl::StatusOr<std::unique_ptr<VertexSpool>> Open(const std::string& folder, Eigen::Index vertices,
                                                           std::size_t buffer_bytes = kBuffer);

  // Adds a frame, one column per vertex. Errors as SpoolFile::Append. Requires: the frame has as many columns as
  // `vertices`.
  absl::Status Add(const Rows& frame);
  std::int64_t frames() const { return frames_; }
  // Calls `visit` with the rows of each vertex in order, one column per frame. Stops at its first error. Call once; no
  // frame may be added afterwards. `rows` are valid during the call. Also the errors of SpoolFile::Append and Read.
  absl::Status ForEachVertex(const std::function<absl::Status(const Rows& rows)>& visit);

 private:
  VertexSpool(std::unique_ptr<SpoolFile> file, Eigen::Index vertices, std::size_t buffer_bytes);

  // Returns the number of frames in a tile.
  Eigen::Index InTile(Eigen::Index tile) const { return std::min(tile_frames_, frames_ - tile * tile_frames_); }
  // Appends the tile in memory to the file; a partial last one with as many frames as it has.
  absl::Status WriteTile();
  // Reads the rows of `count` vertices from vertex `first`, of all frames, into block_.
  absl::Status ReadBlock(Eigen::Index first, Eigen::Index count);
  // Copies the rows of vertex `at` of the block, which has `count` vertices.
  void Gather(Eigen::Index at, Eigen::Index count, Rows& rows) const;

  const std::unique_ptr<SpoolFile> file_;
  const Eigen::Index vertices_;
  const std::size_t buffer_bytes_;
  Eigen::Index tile_frames_;  // frames of a full tile, at least 1
  Eigen::Index frames_ = 0;
  std::vector<std::int64_t> tile_;   // [vertex][frame of the tile][axis]
  std::vector<std::int64_t> block_;  // [tile][vertex of the block][frame of the tile][axis]
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_
