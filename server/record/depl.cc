#include "server/record/depl.h"

#include <cmath>
#include <cstdint>

#include "server/record/text_block.h"

namespace phrenic::record {
namespace {

using Rounded =
    Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>;  // positions in nanometres: six decimals of a millimetre

constexpr double kNanometres = 1e9;
constexpr double kPerMillimetre = 1e6;
constexpr std::size_t kLargest = std::size_t{1} << 30;  // [bytes]

class DeplRecorder final : public Recorder {
 public:
  explicit DeplRecorder(Sink sink) : text_(std::move(sink)) {}

  absl::Status Begin(const std::vector<RecordedBody>& bodies) override {
    for (const RecordedBody& body : bodies) {
      triangles_ += body.mesh.triangles.cols();
      edges_ += body.mesh.edges.cols();
    }
    return absl::OkStatus();
  }

  absl::Status AddFrame(double, const ConstPoints& positions) override {
    const std::size_t bytes = sizeof(std::int64_t) * static_cast<std::size_t>(positions.size());
    if ((frames_.size() + 1) * bytes > kLargest) {
      return absl::ResourceExhaustedError(absl::StrFormat(
          "a .depl recording holds all its frames in memory, 1 GiB at most, and frame %d is beyond that: record fewer "
          "frames a second, or a shorter time, or as .msh",
          frames_.size() + 1));
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
  TextBlock text_;
  std::vector<Rounded> frames_;
  Eigen::Index triangles_ = 0, edges_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> MakeDeplRecorder(Sink sink) { return std::make_unique<DeplRecorder>(std::move(sink)); }

}  // namespace phrenic::record
