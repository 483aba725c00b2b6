#include "server/record/depl.h"

#include "server/record/text_block.h"
#include "server/record/vertex_spool.h"

namespace phrenic::record {
namespace {

constexpr double kNanometres = 1e9;
constexpr std::int64_t kPerMillimetre = 1'000'000;  // nanometres
constexpr int kDecimals = 6;                        // of a millimetre: nanometres
constexpr Eigen::Index kBetweenReports = 64;        // vertices

// Appends an integer number of nanometres as millimetres with six decimals, and the character `after`.
void AppendMillimetres(std::int64_t nanometres, char after, TextBlock& text) {
  if (nanometres < 0) text.Put('-');
  const std::int64_t size = nanometres < 0 ? -nanometres : nanometres;
  text.AppendInteger(size / kPerMillimetre, '.');
  std::int64_t rest = size % kPerMillimetre;
  char decimals[kDecimals];
  for (int digit = kDecimals - 1; digit >= 0; --digit, rest /= 10) decimals[digit] = static_cast<char>('0' + rest % 10);
  for (const char decimal : decimals) text.Put(decimal);
  text.Put(after);
}

class DeplRecorder final : public Recorder {
 public:
  explicit DeplRecorder(Settings settings) : folder_(std::move(settings.spool_folder)), text_(settings.sink) {}

  absl::Status Begin(const Recording& recording) override {
    for (const RecordedBody& body : recording.bodies) {
      triangles_ += body.mesh.triangles.cols();
      edges_ += body.mesh.edges.cols();
      vertices_ += body.mesh.vertices.cols();
    }
    auto spool = VertexSpool::Open(folder_, vertices_);
    if (!spool.ok()) return spool.status();
    spool_ = *std::move(spool);
    return absl::OkStatus();
  }

  absl::Status AddFrame(const RecordedFrame& frame) override {
    rounded_ = (kNanometres * frame.positions).array().round().cast<std::int64_t>();
    return spool_->Add(rounded_);
  }

  absl::Status End(const std::function<absl::Status(double share)>& report) override {
    text_.Append("%s %d %d %d\n", triangles_ > 0 ? "TRIANGLES" : "EDGES", vertices_,
                 triangles_ > 0 ? triangles_ : edges_, spool_->frames());
    Eigen::Index written = 0;
    const absl::Status all = spool_->ForEachVertex([&](const VertexSpool::Rows& rows) {
      WriteVertex(rows);
      if (!text_.status().ok() || ++written % kBetweenReports != 0) return text_.status();
      return report(static_cast<double>(written) / static_cast<double>(vertices_));
    });
    return all.ok() ? text_.Flush() : all;
  }

 private:
  void WriteVertex(const VertexSpool::Rows& rows) {
    Eigen::Matrix<std::int64_t, 3, 1> before = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
    for (const auto row : rows.colwise()) {
      for (int axis = 0; axis < 3; ++axis) AppendMillimetres(row[axis] - before[axis], axis < 2 ? ' ' : '\n', text_);
      before = row;
    }
  }

  const std::string folder_;
  TextBlock text_;
  std::unique_ptr<VertexSpool> spool_;
  VertexSpool::Rows rounded_;
  Eigen::Index triangles_ = 0, edges_ = 0, vertices_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> MakeDeplRecorder(Settings settings) {
  return std::make_unique<DeplRecorder>(std::move(settings));
}

}  // namespace phrenic::record
