#include "client/files/motion_vectors.h"

#include <numeric>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "client/files/whole_file.h"
#include "server/vtk/polydata.h"

namespace phrenic::client {
namespace {

constexpr double kMillimetres = 1000;

// Returns lines from the columns of `from` to those of `to` [m], in mm.
PolyData LinesBetween(const Points& from, const Points& to) {
  const Eigen::Index count = from.cols();
  PolyData data;
  data.points.resize(3, 2 * count);
  data.points << kMillimetres * from, kMillimetres * to;
  data.lines.resize(2, count);
  for (int i = 0; i < count; ++i) data.lines.col(i) = Eigen::Vector2i(i, i + static_cast<int>(count));
  return data;
}

std::string Cells(const Eigen::Vector3d& metres) {
  const Eigen::Vector3d mm = kMillimetres * metres;
  return absl::StrFormat("%.3f,%.3f,%.3f", mm.x(), mm.y(), mm.z());
}

Eigen::RowVectorXd HeldOutMarks(const fit::MotionFit& fit) {
  Eigen::RowVectorXd marks = Eigen::RowVectorXd::Zero(fit.exhale.cols());
  marks(fit.halves.held_out).setOnes();
  return marks;
}

}  // namespace

absl::Status WriteResiduals(const std::string& file, const fit::MotionFit& fit) {
  const Points residual = fit.motion - fit.predicted;
  const Eigen::RowVectorXd held_out = HeldOutMarks(fit);
  if (absl::EndsWithIgnoreCase(file, ".vtp")) {
    PolyData data = LinesBetween(fit.exhale + fit.predicted, fit.exhale + fit.motion);
    data.cell_arrays = {{"residual_mm", kMillimetres * residual},
                        {"error_mm", kMillimetres * residual.colwise().norm()},
                        {"motion_mm", kMillimetres * fit.motion},
                        {"held_out", held_out}};
    return WriteWhole(file, WriteVtp(data));
  }
  std::string text =
      "x,y,z,motion_x,motion_y,motion_z,predicted_x,predicted_y,predicted_z,residual_x,residual_y,residual_z,held_"
      "out\n";
  for (Eigen::Index i = 0; i < fit.exhale.cols(); ++i) {
    absl::StrAppendFormat(&text, "%s,%s,%s,%s,%d\n", Cells(fit.exhale.col(i)), Cells(fit.motion.col(i)),
                          Cells(fit.predicted.col(i)), Cells(residual.col(i)), held_out[i] > 0 ? 1 : 0);
  }
  return WriteWhole(file, text);
}

absl::Status WriteExpected(const std::string& file, const Points& exhale, const Points& motion,
                           const Eigen::VectorXd& spread) {
  if (absl::EndsWithIgnoreCase(file, ".vtp")) {
    PolyData data = LinesBetween(exhale, exhale + motion);
    data.cell_arrays = {{"motion_mm", kMillimetres * motion}, {"spread_mm", kMillimetres * spread.transpose()}};
    return WriteWhole(file, WriteVtp(data));
  }
  std::string text = "x,y,z,expected_x,expected_y,expected_z,spread\n";
  for (Eigen::Index i = 0; i < exhale.cols(); ++i) {
    absl::StrAppendFormat(&text, "%s,%s,%.3f\n", Cells(exhale.col(i)), Cells(motion.col(i)), kMillimetres * spread[i]);
  }
  return WriteWhole(file, text);
}

}  // namespace phrenic::client
