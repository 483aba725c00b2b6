// Positions that come frame by frame and are read vertex by vertex: transposed on disk.
#ifndef PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_
#define PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "server/mesh/mesh.h"
#include "server/record/spool_file.h"

namespace phrenic::record {

// Frames are gathered in tiles of some frames and all vertices, and each full tile is appended to the file vertex by
// vertex; a block of vertices is then one read a tile. Memory is two buffers of about `buffer_bytes`, whatever the
// number of frames, but for one vertex' rows. Not thread-safe.
class VertexSpool {
 public:
  using Rows = Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>;  // a column a frame, or a vertex
  static constexpr std::size_t kBuffer = std::size_t{32} << 20;
  static constexpr std::int64_t kRow = 3 * sizeof(std::int64_t);  // [bytes]

  // Errors as SpoolFile::Open.
  static absl::StatusOr<std::unique_ptr<VertexSpool>> Open(const std::string& folder, Eigen::Index vertices,
                                                           std::size_t buffer_bytes = kBuffer);

  // A column a vertex.
  absl::Status Add(const Rows& frame);
  std::int64_t frames() const { return frames_; }
  // Each vertex' rows, a column a frame, in the order of the vertices; the first error of `visit` ends it. No frame is
  // added afterwards.
  absl::Status ForEachVertex(const std::function<absl::Status(const Rows& rows)>& visit);

 private:
  VertexSpool(std::unique_ptr<SpoolFile> file, Eigen::Index vertices, std::size_t buffer_bytes);

  // Rows that one tile has of each vertex.
  Eigen::Index InTile(Eigen::Index tile) const { return std::min(tile_frames_, frames_ - tile * tile_frames_); }
  absl::Status WriteTile();
  absl::Status ReadBlock(Eigen::Index first, Eigen::Index count);
  // Of the block's vertex `at`, which has `count` vertices.
  void Gather(Eigen::Index at, Eigen::Index count, Rows& rows) const;

  const std::unique_ptr<SpoolFile> file_;
  const Eigen::Index vertices_;
  const std::size_t buffer_bytes_;
  Eigen::Index tile_frames_;
  Eigen::Index frames_ = 0;
  std::vector<std::int64_t> tile_;   // [vertex][frame of the tile][axis]
  std::vector<std::int64_t> block_;  // [tile][vertex of the block][frame of the tile][axis]
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_VERTEX_SPOOL_H_
