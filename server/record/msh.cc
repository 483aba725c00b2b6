#include "server/record/msh.h"

#include "server/mesh/units.h"
#include "server/record/text_block.h"

namespace phrenic::record {
namespace {

constexpr int kDigits = 6, kPositionDigits = 9;
constexpr int kGmshLine = 1, kGmshTriangle = 2;
constexpr int kCurve = 1, kSurface = 2;  // dimensions of physical groups

// Returns the number of the mesh's elements: triangles, else edges.
Eigen::Index ElementsOf(const Mesh& mesh) {
  return mesh.triangles.cols() > 0 ? mesh.triangles.cols() : mesh.edges.cols();
}

// Replaces quotation marks and control characters, which the format cannot quote.
std::string Quotable(std::string name) {
  for (char& c : name) {
    if (c == '"' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  return name;
}

class MshRecorder final : public Recorder {
 public:
  explicit MshRecorder(Settings settings)
      : displacements_(settings.values == Values::kDisplacements), text_(std::move(settings.sink)) {}

  absl::Status Begin(const Recording& recording) override {
    const std::vector<RecordedBody>& bodies = recording.bodies;
    text_.Append("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", bodies.size());
    for (size_t b = 0; b < bodies.size(); ++b) {
      text_.Append("%d %d \"%s\"\n", bodies[b].mesh.triangles.cols() > 0 ? kSurface : kCurve, b + 1,
                   Quotable(bodies[b].name));
    }
    text_.Append("$EndPhysicalNames\n");
    WriteNodes(bodies);
    WriteElements(bodies);
    return text_.Flush();
  }

  absl::Status AddFrame(const RecordedFrame& frame) override {
    if (frames_ == 0) first_ = displacements_ ? frame.positions : Points::Zero(3, frame.positions.cols());
    if (frame.positions.cols() != first_.cols())
      return absl::InternalError("a frame has a different number of vertices than the first one");
    text_.Append("$NodeData\n1\n\"%s\"\n1\n%.9g\n3\n%d\n3\n%d\n", displacements_ ? "displacement" : "position",
                 frame.time, frames_, first_.cols());
    const int digits = displacements_ ? kDigits : kPositionDigits;
    for (Eigen::Index i = 0; i < first_.cols(); ++i) {
      const Eigen::Vector3d u = kMillimetresAMetre * (frame.positions.col(i) - first_.col(i));
      text_.AppendInteger(i + 1, ' ');
      for (int axis = 0; axis < 3; ++axis) text_.AppendNumber(u[axis], digits, axis < 2 ? ' ' : '\n');
    }
    text_.Append("$EndNodeData\n");
    ++frames_;
    return text_.Flush();
  }

  absl::Status End(const std::function<absl::Status(double share)>& /*report*/) override { return text_.Flush(); }

 private:
  void WriteNodes(const std::vector<RecordedBody>& bodies) {
    Eigen::Index nodes = 0;
    for (const RecordedBody& body : bodies) nodes += body.mesh.vertices.cols();
    text_.Append("$Nodes\n%d\n", nodes);
    Eigen::Index number = 0;
    for (const RecordedBody& body : bodies) {
      for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
        const Eigen::Vector3d x = kMillimetresAMetre * body.mesh.vertices.col(i);
        text_.Append("%d %.9g %.9g %.9g\n", ++number, x.x(), x.y(), x.z());
      }
    }
    text_.Append("$EndNodes\n");
  }

  void WriteElements(const std::vector<RecordedBody>& bodies) {
    Eigen::Index elements = 0;
    for (const RecordedBody& body : bodies) elements += ElementsOf(body.mesh);
    text_.Append("$Elements\n%d\n", elements);
    Eigen::Index number = 0, first = 1;
    for (size_t b = 0; b < bodies.size(); ++b) {
      const Mesh& mesh = bodies[b].mesh;
      for (Eigen::Index i = 0; i < ElementsOf(mesh); ++i) {
        if (mesh.triangles.cols() > 0) {
          text_.Append("%d %d 2 %d %d %d %d %d\n", ++number, kGmshTriangle, b + 1, b + 1, first + mesh.triangles(0, i),
                       first + mesh.triangles(1, i), first + mesh.triangles(2, i));
        } else {
          text_.Append("%d %d 2 %d %d %d %d\n", ++number, kGmshLine, b + 1, b + 1, first + mesh.edges(0, i),
                       first + mesh.edges(1, i));
        }
      }
      first += mesh.vertices.cols();
    }
    text_.Append("$EndElements\n");
  }

  const bool displacements_;
  TextBlock text_;
  Points first_;  // [m]; zero if positions are written
  int frames_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> MakeMshRecorder(Settings settings) {
  return std::make_unique<MshRecorder>(std::move(settings));
}

}  // namespace phrenic::record
