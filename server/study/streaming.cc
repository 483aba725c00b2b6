#include "server/study/streaming.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/step/step.h"
#include "server/schema/thread_cpu.h"
#include "server/stream/basis.h"
#include "server/stream/codecs/decode.h"
#include "server/stream/frame.h"
#include "server/stream/frame_encoding.h"
#include "server/stream/rest_shape.h"

namespace phrenic::study {
namespace {

using stream::Floats;

constexpr double kFramesPerSecond = 30;
constexpr double kRunEnd = 0.8;  // fraction of the progress at which the simulation ends

// Positions of the streamed vertices, 3 x n per frame [m].
struct Frames {
  stream::RestShape shape;
  std::vector<Floats> training, measured;  // frames from which shapes are made; frames that are encoded
};

// Simulates `count` frames, `interval` [s] apart, and calls `take` with the positions of each.
absl::Status RunFrames(const Subject& subject, double interval, int count, const Progress& progress,
                       const std::function<void(int frame, Floats positions)>& take) {
  const Model& model = *subject.model;
  const stream::Layout layout(model);
  stream::Snapshot snapshot{.state = model.InitialState(), .parameters = subject.parameters, .made = absl::Now()};
  Workspace work = model.MakeWorkspace();
  for (int i = 0; i < count; ++i) {
    if (!progress(kRunEnd * i / count, "running the scene")) return Cancelled();
    while (snapshot.state.time < interval * (i + 1)) {
      absl::Status stepped = Step(model, subject.parameters, subject.parameters.time_step(), snapshot.state, work);
      if (!stepped.ok()) return stepped;
    }
    const auto frame = stream::MakeFrame(model, layout, snapshot);
    if (!frame.ok()) return frame.status();
    take(i, Eigen::Map<const Floats>(reinterpret_cast<const float*>(frame->positions().data()), 3, layout.vertices()));
  }
  return absl::OkStatus();
}

absl::StatusOr<Frames> MakeFrames(const Subject& subject, const v1::StreamingStudy& study, const Progress& progress) {
  const stream::Layout layout(*subject.model);
  Frames frames{.shape = stream::MakeRestShape(*subject.model, stream::StreamedBodies(*subject.model, layout)),
                .training = {},
                .measured = {}};
  if (layout.vertices() == 0) {
    return absl::FailedPreconditionError("the scene has no body whose vertices are streamed");
  }
  const absl::Status status =
      RunFrames(subject, study.interval(), 2 * study.frames(), progress, [&](int i, Floats positions) {
        (i < study.frames() ? frames.training : frames.measured).push_back(std::move(positions));
      });
  if (!status.ok()) return status;
  return frames;
}

// Adds the shapes of the training frames to the rest shape. Returns the number of bytes for sending them.
absl::StatusOr<std::int64_t> AddShapes(Frames& frames) {
  std::vector<Floats> displacements;
  for (const Floats& positions : frames.training) displacements.emplace_back(positions - frames.shape.rest);
  const auto predicted = stream::MakeCodec(v1::CODEC_PREDICTED, frames.shape);
  auto basis = stream::MakeBasis(*predicted, frames.shape.rest, stream::FindShapes(displacements), 1);
  if (!basis.ok()) return basis.status();
  frames.shape.shapes = std::move(basis->shapes);
  std::int64_t bytes = 0;
  for (const std::string& shape : basis->encoded) bytes += static_cast<std::int64_t>(shape.size());
  return bytes;
}

// Sums over frames.
struct CodecSums {
  double bytes = 0, encode = 0, decode = 0;  // sizes; CPU times [s]
  double squares = 0, worst = 0;             // mean squared errors [m^2]; largest error [m]
  int held = 0;                              // number of frames that the codec could encode
};

// A codec, and the decoder of all codecs as a viewer keeps it.
struct RoundTrip {
  const stream::CodecRow& row;
  std::unique_ptr<stream::Codec> codec;
  stream::PositionDecoder& decoder;
};

// Encodes and decodes one frame. Adds nothing if the codec cannot encode it.
absl::Status AddRoundTrip(const RoundTrip& way, const Floats& frame, double bound, CodecSums& sums) {
  const double start = ThreadCpuSeconds();
  const auto bytes = way.codec->Encode(frame, bound);
  const double encoded = ThreadCpuSeconds();
  if (!bytes.ok()) return absl::OkStatus();
  const auto decoded = stream::DecodeBy(way.decoder, way.row.codec, *bytes);
  const double end = ThreadCpuSeconds();
  if (!decoded.ok()) return decoded.status();
  const Eigen::VectorXd squares = (decoded->cast<double>() - frame.cast<double>()).colwise().squaredNorm();
  sums.worst = std::max(sums.worst, std::sqrt(squares.maxCoeff()));
  sums.squares += squares.mean();
  sums.bytes += static_cast<double>(bytes->size());
  sums.encode += encoded - start;
  sums.decode += end - encoded;
  ++sums.held;
  return absl::OkStatus();
}

std::string VerdictOf(const CodecSums& sums, double bound, std::size_t frames) {
  if (sums.worst > bound) return "FAILED";
  if (sums.held == static_cast<int>(frames)) return "ok";
  return absl::StrCat("holds ", sums.held, " of ", frames, " frames");
}

// Adds a row for one codec and bound level; `bound_level` is -1 for a codec without bounds. Adds nothing if the codec
// could encode no frame.
absl::Status AddCodecRow(const RoundTrip& way, int bound_level, const std::vector<Floats>& frames,
                         v1::StreamingTable& table) {
  const double bound = bound_level < 0 ? 0 : 1e-3 * stream::BoundMillimetres(bound_level);
  CodecSums sums;
  for (const Floats& frame : frames) {
    if (absl::Status status = AddRoundTrip(way, frame, bound, sums); !status.ok()) return status;
  }
  if (sums.held == 0) return absl::OkStatus();
  v1::StreamingRow& row = *table.add_rows();
  row.set_codec(std::string(way.row.name));
  if (bound_level >= 0) row.set_bound_mm(1e3 * bound);
  row.set_bytes_per_frame(sums.bytes / sums.held);
  row.set_mbit_per_second(8e-6 * kFramesPerSecond * row.bytes_per_frame());
  row.set_error_max_mm(1e3 * sums.worst);
  row.set_error_rms_mm(1e3 * std::sqrt(sums.squares / sums.held));
  row.set_encode_us(1e6 * sums.encode / sums.held);
  row.set_decode_us(1e6 * sums.decode / sums.held);
  row.set_verdict(VerdictOf(sums, bound, frames.size()));
  return absl::OkStatus();
}

// Marks the Pareto front: rows that no other row beats in both size and error.
void MarkPareto(v1::StreamingTable& table) {
  for (v1::StreamingRow& row : *table.mutable_rows()) {
    const auto dominates = [&row](const v1::StreamingRow& other) {
      return other.bytes_per_frame() < row.bytes_per_frame() && other.error_max_mm() <= row.error_max_mm();
    };
    row.set_pareto(std::none_of(table.rows().begin(), table.rows().end(), dominates));
  }
}

// Returns a sentence about the bandwidth at the default error bound.
std::string AdviceOf(const v1::StreamingTable& table) {
  const double bound = stream::BoundMillimetres(stream::kDefaultBoundLevel);
  std::string advice;
  for (const v1::StreamingRow& row : table.rows()) {
    if (!row.has_bound_mm() || std::abs(row.bound_mm() - bound) > 1e-9) continue;
    absl::StrAppend(&advice, advice.empty() ? absl::StrFormat("Within %g mm a frame takes ", bound) : ", ",
                    absl::StrFormat("%.3g kB by %s (%.3g Mbit/s)", 1e-3 * row.bytes_per_frame(), row.codec(),
                                    row.mbit_per_second()));
  }
  return advice.empty() ? "" : advice + " at 30 frames a second.";
}

}  // namespace

absl::StatusOr<v1::StreamingTable> StudyStreaming(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress) {
  auto frames = MakeFrames(subject, request.streaming(), progress);
  if (!frames.ok()) return frames.status();
  v1::StreamingTable table;
  const auto basis_bytes = AddShapes(*frames);
  if (!basis_bytes.ok()) return basis_bytes.status();
  table.set_basis_bytes(*basis_bytes);
  table.set_vertices(frames->shape.rest.cols());
  table.set_frames(request.streaming().frames());
  const auto decoder = stream::MakeDecoder(frames->shape);
  const std::size_t codecs = stream::Codecs().size();
  for (std::size_t i = 0; i < codecs; ++i) {
    const stream::CodecRow& each = stream::Codecs()[i];
    const RoundTrip way = {.row = each, .codec = each.make(frames->shape), .decoder = *decoder};
    const bool bounded = each.codec != v1::CODEC_RAW;
    for (int bound_level = bounded ? 0 : -1; bound_level <= (bounded ? stream::kCoarsestBoundLevel : -1);
         ++bound_level) {
      const double done = kRunEnd + (1 - kRunEnd) * static_cast<double>(i) / static_cast<double>(codecs);
      if (!progress(done, absl::StrCat("encoding with ", std::string(each.name)))) return Cancelled();
      if (absl::Status status = AddCodecRow(way, bound_level, frames->measured, table); !status.ok()) return status;
    }
  }
  MarkPareto(table);
  table.set_advice(AdviceOf(table));
  return table;
}

}  // namespace phrenic::study
