#include "server/session/export/body_writer.h"

#include <utility>
#include <vector>

#include "server/mechanics/skinning/body_points.h"

namespace phrenic::session {

BodyWriter::BodyWriter(const ExportPlan& plan, record::Sink sink)
    : plan_(plan),
      recorder_(plan.format.make({.sink = std::move(sink),
                                  .values = plan.values,
                                  .stem = plan.file_stem,
                                  .spool_folder = plan.spool_folder})) {
  positions_.resize(3, plan.vertices);
}

absl::Status BodyWriter::Begin(const Run& run) {
  PlaceBodies(run);
  record::Recording recording;
  Eigen::Index first = 0;
  for (const int body : plan_.bodies) {
    recording.bodies.push_back({run.model().bodies[body].name, run.model().bodies[body].mesh});
    Points& vertices = recording.bodies.back().mesh.vertices;
    vertices = positions_.middleCols(first, vertices.cols());
    first += vertices.cols();
  }
  if (plan_.format.numbers_only) recording.columns = ColumnsOf(run.model());
  return recorder_->Begin(recording);
}

absl::Status BodyWriter::AddFrame(const Run& run) {
  PlaceBodies(run);
  std::vector<double> numbers;
  if (plan_.format.numbers_only) numbers = NumbersAt(run.model(), run.parameters(), run.state());
  return recorder_->AddFrame({run.state().time, positions_, numbers});
}

void BodyWriter::PlaceBodies(const Run& run) {
  Eigen::Index first = 0;
  for (const int body : plan_.bodies) {
    const Eigen::Index count = run.model().bodies[body].mesh.vertices.cols();
    PlaceBody(run.model(), run.state(), body, positions_.middleCols(first, count));
    first += count;
  }
}

}  // namespace phrenic::session
