// Error against bandwidth: bytes a frame and CPU of every codec at every bound, on frames of a breath: streaming_bench
// [SCENE] [--frames N] [--data FOLDER]. What it costs to look closely; the first decoding of a frame is checked against
// its bound. Exit code 1 where a scene or a bound fails.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>

#include "server/mechanics/step.h"
#include "server/session/models.h"
#include "server/stream/form.h"
#include "server/stream/frame.h"
#include "server/stream/rest_shape.h"

namespace phrenic::bench {
namespace {

constexpr double kApart = 0.25;  // seconds of the simulation between two frames

using stream::Floats;

struct Frames {
  stream::RestShape shape;
  std::vector<Floats> positions;
};

absl::StatusOr<Frames> Run(const std::string& scene, const std::string& data, int count) {
  session::Models models(session::SceneCatalogue({PHRENIC_SCENES_DIR}), data, 1);
  v1::SceneSource source;
  source.set_name(scene);
  const auto model = models.Get(source);
  if (!model.ok()) return model.status();
  const stream::Layout layout(**model);
  Frames frames{.shape = stream::MakeRestShape(**model, stream::StreamedBodies(**model, layout)), .positions = {}};
  stream::Snapshot snapshot{.state = (*model)->InitialState(), .parameters = (*model)->parameters, .made = absl::Now()};
  Workspace work = (*model)->MakeWorkspace();
  for (int i = 0; i < count; ++i) {
    const double until = kApart * (i + 1);
    while (snapshot.state.time < until) {
      const absl::Status stepped =
          Step(**model, snapshot.parameters, snapshot.parameters.time_step(), snapshot.state, work);
      if (!stepped.ok()) return stepped;
    }
    const auto frame = stream::MakeFrame(**model, layout, snapshot);
    if (!frame.ok()) return frame.status();
    frames.positions.push_back(
        Eigen::Map<const Floats>(reinterpret_cast<const float*>(frame->positions().data()), 3, layout.vertices()));
  }
  return frames;
}

// CPU seconds of this thread.
double Cpu() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Row {
  double bytes = 0, encode = 0, decode = 0, worst = 0;  // a frame; [s], [s], [m]
  int held = 0;                                         // frames that the codec could hold
};

absl::StatusOr<Row> Measure(const stream::Codec& codec, const std::vector<Floats>& frames, double bound) {
  Row row;
  for (const Floats& frame : frames) {
    const double start = Cpu();
    const auto bytes = codec.Encode(frame, bound);
    const double encoded = Cpu();
    if (!bytes.ok()) continue;
    const auto decoded = codec.Decode(*bytes);
    const double end = Cpu();
    if (!decoded.ok()) return decoded.status();
    ++row.held;
    row.bytes += static_cast<double>(bytes->size());
    row.encode += encoded - start;
    row.decode += end - encoded;
    const double error = (decoded->cast<double>() - frame.cast<double>()).colwise().norm().maxCoeff();
    row.worst = std::max(row.worst, error);
  }
  if (row.worst > bound) return absl::InternalError("a vertex is further off than the bound");
  return row;
}

int Fail(const absl::Status& status) {
  std::fprintf(stderr, "%s\n", std::string(status.message()).c_str());
  return 1;
}

int Print(const Frames& frames) {
  std::printf("%td vertices, %zu frames\n%-10s %9s %10s %12s %10s %10s %10s\n", frames.shape.rest.cols(),
              frames.positions.size(), "codec", "bound mm", "worst mm", "bytes/frame", "Mbit/s@30", "encode us",
              "decode us");
  for (const stream::CodecRow& each : stream::Codecs()) {
    const auto codec = each.make(frames.shape);
    for (const int rung : {0, 3, stream::kDefaultRung, stream::kCoarsestRung}) {
      const double bound = stream::RungMillimetres(rung);
      const auto row = Measure(*codec, frames.positions, 1e-3 * bound);
      if (!row.ok()) return Fail(row.status());
      if (row->held == 0) continue;
      const double bytes = row->bytes / row->held;
      std::printf("%-10s %9.3f %10.4f %12.0f %10.2f %10.0f %10.0f\n", std::string(each.name).c_str(), bound,
                  1e3 * row->worst, bytes, 8e-6 * 30 * bytes, 1e6 * row->encode / row->held,
                  1e6 * row->decode / row->held);
    }
  }
  return 0;
}

int Main(int argc, char** argv) {
  std::string scene = "thorax", data;
  int count = 16;
  CLI::App app("Bytes and time of a frame by every codec and error bound.");
  app.add_option("scene", scene, "Scene")->capture_default_str();
  app.add_option("--frames", count, "Frames, a quarter of a simulated second apart")->check(CLI::Range(1, 1000));
  app.add_option("--data", data, "Folder of surface files");
  CLI11_PARSE(app, argc, argv);
  const auto frames = Run(scene, data, count);
  return frames.ok() ? Print(*frames) : Fail(frames.status());
}

}  // namespace
}  // namespace phrenic::bench

int main(int argc, char** argv) { return phrenic::bench::Main(argc, argv); }
