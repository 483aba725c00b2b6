// Markers in a laboratory's frame: they find their bones whatever the frame, and tell the breath that moved them.
#include "server/calibrate/cage_markers.h"

#include <gmock/gmock.h>

#include "server/calibrate/breath_fit.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic::calibrate {
namespace {

using ::testing::HasSubstr;

class MarkedThorax : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = CompileShipped("thorax", 30);
    subject_ = *physiology::Subject::Of(*model_);
    const auto made = physiology::Record(
        *subject_, "made", Drive(0.09, 0.4), [](double) { return true; }, physiology::FlawSearch::kNever);
    ASSERT_TRUE(made.ok());
    made_ = new physiology::Recording(*made);
  }
  static void TearDownTestSuite() {
    delete made_;
    subject_.reset();
    model_.reset();
  }
  static v1::Parameters Drive(double diaphragm, double intercostals) {
    v1::Parameters parameters = model_->parameters;
    parameters.set_breath_length(2);
    parameters.set_time_step(1.4 * parameters.time_step());  // the laws hold for coarser breaths too
    parameters.set_diaphragm_activation(diaphragm);
    parameters.set_intercostal_activation(intercostals);
    return parameters;
  }

  // Markers 12 mm over the front and the side of ribs and sternum, in a frame that is turned, shifted and scaled.
  static fit::Evidence::MarkerFile Marked(const Eigen::Affine3d& to_frame, int named = 100, double motion = 1) {
    fit::Evidence::MarkerFile file;
    file.kind = {"markers", "lab.csv", "mm", 1e-3, 0.001, 1};
    std::vector<Eigen::Vector3d> rest, moved;
    for (size_t b = 0; b < model_->bodies.size(); ++b) {
      const BodyModel& body = model_->bodies[b];
      const v1::Structure structure = body.anatomy.structure();
      const bool rib = structure == v1::STRUCTURE_RIB && body.anatomy.number() >= 3 && body.anatomy.number() <= 9;
      if (!rib && structure != v1::STRUCTURE_STERNUM_BODY) continue;
      const Points& points = body.mesh.vertices;
      Eigen::Index front = 0, side = 0;
      points.row(1).minCoeff(&front);
      points.row(0).cwiseAbs().maxCoeff(&side);
      const int index = static_cast<int>(b);
      const Points base = physiology::Placed(*model_, made_->base, index);
      const Points shift = physiology::Placed(*model_, made_->peak, index) - base;
      for (const Eigen::Index vertex : {front, side}) {
        if (!rib && vertex == side) continue;
        const Eigen::Vector3d at = points.col(vertex), out(0.7 * (at.x() > 0 ? 1 : -1), vertex == front ? -1 : 0, 0);
        const Eigen::Vector3d place = at + 0.012 * out.normalized();
        rest.push_back(to_frame * place);
        moved.push_back(to_frame * Eigen::Vector3d(place + motion * shift.col(vertex)));
        const bool has_name = static_cast<int>(rest.size()) <= named;
        file.markers.names.push_back(has_name ? body.name + (vertex == front ? " front" : " side") : "m");
      }
    }
    file.markers.rest.resize(3, static_cast<Eigen::Index>(rest.size()));
    file.markers.motion.resize(3, static_cast<Eigen::Index>(rest.size()));
    for (size_t i = 0; i < rest.size(); ++i) {
      file.markers.rest.col(static_cast<Eigen::Index>(i)) = rest[i];
      file.markers.motion.col(static_cast<Eigen::Index>(i)) = moved[i] - rest[i];
    }
    return file;
  }
  // A frame with y up, turned about, 2 m away.
  static Eigen::Affine3d Laboratory() {
    return Eigen::Translation3d(2, -0.4, 1.1) * Eigen::AngleAxisd(1.9, Eigen::Vector3d(0.3, 1, -0.5).normalized()) *
           Eigen::Affine3d::Identity();
  }

  inline static std::shared_ptr<const Model> model_;
  inline static std::unique_ptr<const physiology::Subject> subject_;
  inline static const physiology::Recording* made_ = nullptr;
};

TEST_F(MarkedThorax, FindsTheCageFromAnyFrame) {
  for (const int named : {100, 10}) {
    const fit::Evidence::MarkerFile file = Marked(Laboratory(), named);
    const auto cage = RegisterToCage(*subject_, "lab.csv", file.markers);
    ASSERT_TRUE(cage.ok()) << cage.status();
    EXPECT_LT(cage->rms, 0.02);
    EXPECT_NEAR(cage->scale, 1, 0.15);
    const Points home = Laboratory().inverse() * file.markers.rest, found = cage->to_scene * file.markers.rest;
    const double off = std::sqrt((home - found).colwise().squaredNorm().mean());
    std::printf("%d named of %ld: off by %.1f mm, scale %.3f\n", cage->named, static_cast<long>(home.cols()),
                1000 * off, cage->scale);
    EXPECT_LT(off, 0.02);
  }
}

// Without the points of the bones, markers of one side alone may slide along the ribs: that is refused, or right.
TEST_F(MarkedThorax, NeverPlacesMarkersWrongly) {
  for (const int named : {6, 10, 29}) {
    fit::Markers markers = Marked(Laboratory(), named).markers;
    for (std::string& name : markers.names) name = name.substr(0, name.find(' '));
    const auto cage = RegisterToCage(*subject_, "lab.csv", markers);
    if (!cage.ok()) {
      std::printf("%d named: %s\n", named, std::string(cage.status().message()).c_str());
      continue;
    }
    const Points home = Laboratory().inverse() * markers.rest, found = cage->to_scene * markers.rest;
    const double off = std::sqrt((home - found).colwise().squaredNorm().mean());
    std::printf("%d named without points: off by %.1f mm\n", named, 1000 * off);
    EXPECT_LT(off, 0.03);
  }
}

TEST_F(MarkedThorax, RefusesWhatIsNoChest) {
  const auto refusal = [](const fit::Markers& markers) {
    return std::string(RegisterToCage(*subject_, "lab.csv", markers).status().message());
  };
  EXPECT_THAT(refusal(Marked(Laboratory(), 3).markers), HasSubstr("rib-7-right"));
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear()(0, 0) = -1;
  EXPECT_THAT(refusal(Marked(Laboratory() * mirror).markers), HasSubstr("mirror image"));
  fit::Markers wide = Marked(Laboratory()).markers;
  wide.rest *= 10;
  EXPECT_THAT(refusal(wide), HasSubstr("mm"));
  fit::Markers mixed = Marked(Laboratory()).markers;
  std::reverse(mixed.names.begin() + 2, mixed.names.end());
  EXPECT_FALSE(RegisterToCage(*subject_, "lab.csv", mixed).ok());
}

TEST_F(MarkedThorax, TellsTheMusclesOfTheCageThatMovedIt) {
  auto cage = CageData(*subject_, Marked(Laboratory()));
  ASSERT_TRUE(cage.ok()) << cage.status();
  AllBreathData data;
  data.push_back(*std::move(cage));
  const v1::Parameters start = Drive(0.09, 0.175);
  const auto fit = FitBreath(*subject_, start, {PriorOf(*ReadVaried("intercostal_activation"), start)}, data, {2},
                             [](double, const std::string&) { return true; });
  ASSERT_TRUE(fit.ok()) << fit.status();
  const fit::FittedQuantity& found = fit->numbers[0];
  const fit::KindReport& kind = fit->kinds[0];
  std::printf("intercostal_activation: %.3f +- %.3f, made by 0.4; rms %.2f mm, held out %.2f of %.2f\n", found.value,
              found.standard_error, 1000 * kind.after, 1000 * kind.held_out_after, 1000 * kind.held_out_still);
  // The registration turns and scales the chest by a little, which is no noise: 15 % of the truth beside the error.
  EXPECT_NEAR(found.value, 0.4, 3 * found.standard_error + 0.06);
  EXPECT_GT(kind.held_out, 2);
  EXPECT_LT(kind.held_out_after, 0.5 * kind.held_out_still);
}

}  // namespace
}  // namespace phrenic::calibrate
