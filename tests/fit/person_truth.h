// Data of several kinds made by the model itself, from known numbers and with noise.
#ifndef PHRENIC_TESTS_FIT_PERSON_TRUTH_H_
#define PHRENIC_TESTS_FIT_PERSON_TRUTH_H_

#include <random>

#include "absl/strings/str_format.h"
#include "server/fit/joint_fit.h"
#include "server/mechanics/breath_signal.h"
#include "server/meshio/meshio.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {

// A person whose lungs are those registered to the points, and who breathes with known amplitudes.
class PersonTruth {
 public:
  static const PersonTruth& One() {
    static const auto* const truth = new PersonTruth;
    return *truth;
  }

  const Eigen::VectorXd& amplitudes() const { return amplitudes_; }
  double volume() const { return person_->VolumeResponses().dot(amplitudes_); }  // [m^3]

  MeasuredFile Exhale() const {
    MeasuredFile file = Named(Measured::kExhale, "exhale.csv");
    file.bytes = "x,y,z\n";
    for (const auto& p : points_.colwise()) file.bytes += Place(p) + "\n";
    return file;
  }

  // Every `stride`th point, moved by `depth` of the breath.
  MeasuredFile Landmarks(double noise, int stride = 1, double depth = 1) const {
    MeasuredFile file = Named(Measured::kLandmarks, absl::StrFormat("pairs-%g.csv", depth));
    file.bytes = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z\n";
    std::mt19937_64 random(17);
    std::normal_distribution<double> normal(0, noise);
    const Points moved = points_ + depth * Motion(points_);
    for (Eigen::Index i = 0; i < points_.cols(); i += stride) {
      Eigen::Vector3d to = moved.col(i);
      for (double& value : to) value += normal(random);
      file.bytes += Place(points_.col(i)) + "," + Place(to) + "\n";
    }
    return file;
  }

  // Both lungs' surfaces, at rest or moved.
  MeasuredFile Surface(Measured measured, bool at_exhale, double noise = 0) const {
    Mesh both;
    std::mt19937_64 random(19);
    std::normal_distribution<double> normal(0, noise);
    for (const Side side : {kRight, kLeft}) {
      const Mesh& lung = person_->tissue(side).surface();
      const Eigen::Index before = both.vertices.cols(), count = lung.vertices.cols();
      both.vertices.conservativeResize(3, before + count);
      both.vertices.rightCols(count) = lung.vertices;
      if (!at_exhale) both.vertices.rightCols(count) += Motion(lung.vertices);
      both.triangles.conservativeResize(3, both.triangles.cols() + lung.triangles.cols());
      both.triangles.rightCols(lung.triangles.cols()) = lung.triangles.array() + static_cast<int>(before);
    }
    for (double& value : both.vertices.reshaped()) value += normal(random);
    MeasuredFile file = Named(measured, at_exhale ? "rest.obj" : "moved.obj");
    file.at_exhale = at_exhale;
    file.bytes = *meshio::Write(file.name, both, 0.001);
    return file;
  }

  // Breaths of 4.4 s, 0.4 of them inspiration and 0.08 pause, at 25 samples a second.
  MeasuredFile Trace(Measured measured, double depth, double noise, int breaths = 8) const {
    MeasuredFile file = Named(measured, measured == Measured::kVolume ? "spiro.csv" : "mmode.csv");
    file.bytes = measured == Measured::kVolume ? "time_s,volume_l\n" : "time_s,displacement_mm\n";
    v1::Breath breath;
    breath.set_waveform(v1::WAVEFORM_RAISED_COSINE);
    v1::Parameters shape;
    shape.set_inspiratory_share(0.4);
    shape.set_pause_share(0.08);
    std::mt19937_64 random(23);
    std::normal_distribution<double> normal(0, noise);
    for (int i = 0; i < breaths * 110; ++i) {
      const double t = 0.04 * i, s = BreathSignalAt(breath, shape, t / 4.4 - 0.3).value;
      file.bytes += absl::StrFormat("%.3f,%.5f\n", t, 1000 * (depth * s + normal(random)) + 3 + 0.002 * t);
    }
    return file;
  }
  MeasuredFile Volume(double noise = 0.00002) const { return Trace(Measured::kVolume, volume(), noise); }

  // Places beside the lungs, 5 mm from their surface.
  MeasuredFile MarkersOf(double noise) const {
    MeasuredFile file = Named(Measured::kMarkers, "markers.csv");
    file.bytes = "name,rest_x,rest_y,rest_z,moved_x,moved_y,moved_z\n";
    std::mt19937_64 random(29);
    std::normal_distribution<double> normal(0, noise);
    for (const Side side : {kRight, kLeft}) {
      const LungTissue& tissue = person_->tissue(side);
      for (Eigen::Index i = 0; i < tissue.points().cols(); i += 7) {
        const Eigen::Vector3d at = tissue.points().col(i), out = tissue.normals().col(i);
        if (PlaceOf(at, out, tissue.box(), side == kLeft ? 1 : -1).costal < 0.9) continue;
        Eigen::Vector3d to = at + Motion(at);
        for (double& value : to) value += normal(random);
        file.bytes += "m" + std::to_string(i) + "," + Place(at + 0.005 * out) + "," + Place(to + 0.005 * out) + "\n";
      }
    }
    return file;
  }

  Points Motion(const Points& points) const {
    return (person_->Responses(points) * amplitudes_).reshaped(3, points.cols());
  }

 private:
  PersonTruth() : points_(SyntheticPerson(400).exhale), amplitudes_(8) {
    amplitudes_ << 14, 12, 17, 5, 2, -6, 1.5, 0.5;
    amplitudes_ /= 1000;
    // As the files have it.
    points_ = (points_ * 1e5).array().round() / 1e5;
    person_.emplace(
        *Person::Make(GeneratedLungs(), *RegisterLungs(GeneratedLungs(), points_), BreathAmplitudes(8), {}));
  }
  static MeasuredFile Named(Measured measured, const std::string& name) {
    MeasuredFile file;
    file.measured = measured;
    file.name = name;
    return file;
  }
  static std::string Place(const Eigen::Vector3d& p) {
    return absl::StrFormat("%.5f,%.5f,%.5f", 1000 * p.x(), 1000 * p.y(), 1000 * p.z());
  }

  Points points_;
  Eigen::VectorXd amplitudes_;  // [m]
  std::optional<Person> person_;
};

}  // namespace phrenic::fit

#endif  // PHRENIC_TESTS_FIT_PERSON_TRUTH_H_
