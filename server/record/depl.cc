#include "server/record/depl.h"

#include <cmath>
#include <cstdint>

#include "server/record/text_block.h"

namespace phrenic::record {
namespace {

// Positions in nanometres: six decimals of a millimetre.
using Rounded = Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>;

constexpr double kNanometres = 1e9;
constexpr double kPerMillimetre = 1e6;
class DeplRecorder final : public Recorder {
 public:
  DeplRecorder(Sink sink, std::size_t max_bytes) : max_bytes_(max_bytes), text_(std::move(sink)) {}

  absl::Status Begin(const std::vector<RecordedBody>& bodies) override {
    for (const RecordedBody& body : bodies) {
      triangles_ += body.mesh.triangles.cols();
      edges_ += body.mesh.edges.cols();
    }
    return absl::OkStatus();
  }

  absl::Status AddFrame(double, const ConstPoints& positions) override {
    const std::size_t bytes = sizeof(std::int64_t) * static_cast<std::size_t>(positions.size());
    if ((frames_.size() + 1) * bytes > max_bytes_) {
      return absl::ResourceExhaustedError(absl::StrFormat(
          "a .depl recording holds all its frames in memory, %d MiB at most, and frame %d is beyond that: record fewer "
          "frames a second, or a shorter time, or as .msh",
          max_bytes_ >> 20, frames_.size() + 1));
    }
    frames_.push_back((kNanometres * positions).array().round().cast<std::int64_t>());
    return absl::OkStatus();
  }

  absl::Status End() override {
    const Eigen::Index vertices = frames_.empty() ? 0 : frames_.front().cols();
    text_.Append("%s %d %d %d\n", triangles_ > 0 ? "TRIANGLES" : "EDGES", vertices,
                 triangles_ > 0 ? triangles_ : edges_, frames_.size());
    for (Eigen::Index i = 0; i < vertices; ++i) {
      Eigen::Matrix<std::int64_t, 3, 1> before = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
      for (const Rounded& frame : frames_) {
        const Eigen::Vector3d change = (frame.col(i) - before).cast<double>() / kPerMillimetre;
        text_.Append("%.6f %.6f %.6f\n", change.x(), change.y(), change.z());
        before = frame.col(i);
      }
    }
    return text_.Flush();
  }

 private:
  const std::size_t max_bytes_;
  TextBlock text_;
  std::vector<Rounded> frames_;
  Eigen::Index triangles_ = 0, edges_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> MakeDeplRecorder(Sink sink) {
  return MakeBoundedDeplRecorder(std::move(sink), std::size_t{1} << 30);
}

std::unique_ptr<Recorder> MakeBoundedDeplRecorder(Sink sink, std::size_t max_bytes) {
  return std::make_unique<DeplRecorder>(std::move(sink), max_bytes);
}

}  // namespace phrenic::record
