#include "server/record/vertex_spool.h"

#include <algorithm>
#include <string_view>

namespace phrenic::record {
namespace {

// Returns the number of rows that fit into a buffer.
Eigen::Index RowsIn(std::size_t bytes) { return static_cast<Eigen::Index>(bytes / VertexSpool::kRow); }

}  // namespace

absl::StatusOr<std::unique_ptr<VertexSpool>> VertexSpool::Open(const std::string& folder, Eigen::Index vertices,
                                                               std::size_t buffer_bytes) {
  auto file = SpoolFile::Open(folder);
  if (!file.ok()) return file.status();
  return std::unique_ptr<VertexSpool>(new VertexSpool(*std::move(file), vertices, buffer_bytes));
}

VertexSpool::VertexSpool(std::unique_ptr<SpoolFile> file, Eigen::Index vertices, std::size_t buffer_bytes)
    : file_(std::move(file)),
      vertices_(vertices),
      buffer_bytes_(buffer_bytes),
      tile_frames_(std::max<Eigen::Index>(1, RowsIn(buffer_bytes) / std::max<Eigen::Index>(1, vertices))),
      tile_(static_cast<std::size_t>(3 * vertices * tile_frames_)) {}

absl::Status VertexSpool::Add(const Rows& frame) {
  const Eigen::Index at = frames_ % tile_frames_;
  for (Eigen::Index i = 0; i < vertices_; ++i) {
    std::copy_n(frame.col(i).data(), 3, tile_.begin() + 3 * (i * tile_frames_ + at));
  }
  ++frames_;
  return frames_ % tile_frames_ == 0 ? WriteTile() : absl::OkStatus();
}

// Appends the tile to the file. Compacts the rows of a partial last tile first.
absl::Status VertexSpool::WriteTile() {
  const Eigen::Index rows = InTile((frames_ - 1) / tile_frames_);
  for (Eigen::Index i = 1; rows < tile_frames_ && i < vertices_; ++i) {
    std::copy_n(tile_.begin() + 3 * i * tile_frames_, 3 * rows, tile_.begin() + 3 * i * rows);
  }
  return file_->Append(
      std::string_view(reinterpret_cast<const char*>(tile_.data()), static_cast<std::size_t>(kRow * vertices_ * rows)));
}

absl::Status VertexSpool::ReadBlock(Eigen::Index first, Eigen::Index count) {
  block_.resize(static_cast<std::size_t>(3 * count * frames_));
  for (Eigen::Index start = 0; start < frames_; start += tile_frames_) {
    const Eigen::Index rows = InTile(start / tile_frames_);
    const std::int64_t offset = kRow * (start * vertices_ + first * rows);
    char* const to = reinterpret_cast<char*>(block_.data() + 3 * start * count);
    if (absl::Status status = file_->Read(offset, to, static_cast<std::size_t>(kRow * rows * count)); !status.ok()) {
      return status;
    }
  }
  return absl::OkStatus();
}

void VertexSpool::Gather(Eigen::Index at, Eigen::Index count, Rows& rows) const {
  for (Eigen::Index start = 0; start < frames_; start += tile_frames_) {
    const Eigen::Index in_tile = InTile(start / tile_frames_);
    std::copy_n(block_.begin() + 3 * (start * count + at * in_tile), 3 * in_tile, rows.data() + 3 * start);
  }
}

absl::Status VertexSpool::ForEachVertex(const std::function<absl::Status(const Rows& rows)>& visit) {
  if (frames_ % tile_frames_ != 0) {
    if (absl::Status status = WriteTile(); !status.ok()) return status;
  }
  tile_ = {};
  Rows rows(3, frames_);
  const Eigen::Index fit = RowsIn(buffer_bytes_) / std::max<Eigen::Index>(1, frames_);
  const Eigen::Index max_count = std::max<Eigen::Index>(1, fit);
  for (Eigen::Index first = 0; first < vertices_; first += max_count) {
    const Eigen::Index count = std::min(max_count, vertices_ - first);
    if (absl::Status status = ReadBlock(first, count); !status.ok()) return status;
    for (Eigen::Index i = 0; i < count; ++i) {
      Gather(i, count, rows);
      if (absl::Status status = visit(rows); !status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

}  // namespace phrenic::record
