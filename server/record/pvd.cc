#include "server/record/pvd.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/units.h"
#include "server/record/archive.h"
#include "server/vtk/polydata.h"

namespace phrenic::record {
namespace {

Eigen::Index LinesOf(const Mesh& mesh) { return mesh.triangles.cols() > 0 ? 0 : mesh.edges.cols(); }

// Returns all bodies as one PolyData; the cell array "body" holds each cell's body number.
PolyData Merge(const std::vector<RecordedBody>& bodies) {
  Eigen::Index points = 0, triangles = 0, lines = 0;
  for (const RecordedBody& body : bodies) {
    points += body.mesh.vertices.cols();
    triangles += body.mesh.triangles.cols();
    lines += LinesOf(body.mesh);
  }
  PolyData data = {.points = Points(3, points), .triangles = Triangles(3, triangles), .lines = Edges(2, lines)};
  Eigen::MatrixXd numbers(1, lines + triangles);
  Eigen::Index first = 0, triangle = 0, line = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Mesh& mesh = bodies[b].mesh;
    const int offset = static_cast<int>(first);
    data.points.middleCols(first, mesh.vertices.cols()) = mesh.vertices;
    data.triangles.middleCols(triangle, mesh.triangles.cols()) = mesh.triangles.array() + offset;
    data.lines.middleCols(line, LinesOf(mesh)) = mesh.edges.leftCols(LinesOf(mesh)).array() + offset;
    numbers.middleCols(line, LinesOf(mesh)).setConstant(static_cast<double>(b));
    numbers.middleCols(lines + triangle, mesh.triangles.cols()).setConstant(static_cast<double>(b));
    data.names.push_back(bodies[b].name);
    first += mesh.vertices.cols(), triangle += mesh.triangles.cols(), line += LinesOf(mesh);
  }
  data.cell_arrays.push_back({"body", numbers});
  return data;
}

class PvdRecorder final : public Recorder {
 public:
  explicit PvdRecorder(Settings settings)
      : moved_(settings.values == Values::kPositions), stem_(std::move(settings.stem)), archive_(settings.sink) {}

  absl::Status Begin(const Recording& recording) override {
    data_ = Merge(recording.bodies);
    first_ = data_.points;
    data_.points *= kMillimetresAMetre;
    data_.point_arrays.push_back({"displacement [mm]", Points::Zero(3, first_.cols())});
    return absl::OkStatus();
  }

  absl::Status AddFrame(const RecordedFrame& frame) override {
    if (moved_) data_.points = kMillimetresAMetre * frame.positions;
    data_.point_arrays[0].values = kMillimetresAMetre * (frame.positions - first_);
    const std::string name = absl::StrFormat("%s/%s_%06d.vtp", stem_, stem_, frames_++);
    absl::StrAppendFormat(&index_, "<DataSet timestep=\"%.9g\" group=\"\" part=\"0\" file=\"%s\"/>\n", frame.time,
                          name);
    return archive_.Add(name, WriteVtp(data_));
  }

  absl::Status End(const std::function<absl::Status(double share)>& /*report*/) override {
    const std::string text = absl::StrCat(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<Collection>\n",
        index_, "</Collection>\n</VTKFile>\n");
    if (absl::Status status = archive_.Add(stem_ + ".pvd", text); !status.ok()) return status;
    return archive_.Finish();
  }

 private:
  const bool moved_;  // true if points are the current positions, false for those of the first frame
  const std::string stem_;
  Archive archive_;
  PolyData data_;
  Points first_;  // [m]
  std::string index_;
  int frames_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> MakePvdRecorder(Settings settings) {
  return std::make_unique<PvdRecorder>(std::move(settings));
}

}  // namespace phrenic::record
