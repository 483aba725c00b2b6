#include "server/mechanics/compile/catalogue.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/limits.h"
#include "server/mechanics/constraints/rigid_links.h"
#include "server/mechanics/forces/action_line.h"
#include "server/mechanics/forces/attachment.h"
#include "server/mechanics/forces/bending.h"
#include "server/mechanics/forces/cables.h"
#include "server/mechanics/forces/chest_wall.h"
#include "server/mechanics/forces/contact.h"
#include "server/mechanics/forces/cross_layer.h"
#include "server/mechanics/forces/fibres.h"
#include "server/mechanics/forces/friction.h"
#include "server/mechanics/forces/gravity.h"
#include "server/mechanics/forces/lungs.h"
#include "server/mechanics/forces/membrane.h"
#include "server/mechanics/forces/muscle.h"
#include "server/mechanics/forces/point_load.h"
#include "server/mechanics/forces/pressure.h"
#include "server/mechanics/forces/solid.h"
#include "server/mechanics/forces/springs.h"
#include "server/mechanics/forces/target_spring.h"
#include "server/mechanics/forces/thorax_pressures.h"
#include "server/mechanics/forces/wall_contact.h"
#include "server/mechanics/measures/energy.h"
#include "server/mechanics/measures/force_output.h"
#include "server/mechanics/measures/highest.h"
#include "server/mechanics/measures/volume.h"
#include "server/mechanics/motions/cage_limit.h"
#include "server/mechanics/motions/insertion.h"
#include "server/mechanics/motions/lung_modes.h"
#include "server/mechanics/motions/oscillation.h"
#include "server/mechanics/motions/ribs.h"
#include "server/mechanics/motions/sternum.h"
#include "server/mechanics/skinning/add_skins.h"
#include "server/mechanics/skinning/sheet_obstacle.h"

namespace phrenic {
namespace {

std::string In(std::string_view path, const char* field) { return absl::StrCat(std::string(path), ".", field); }

absl::Status NoKind(std::string_view path) { return FieldError(path, "says no kind: set one of its kinds"); }

absl::Status Add(absl::StatusOr<std::unique_ptr<Motion>> motion, ModelBuilder& builder) {
  if (!motion.ok()) return motion.status();
  if (*motion != nullptr) builder.model.motions.push_back(*std::move(motion));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> MakeForce(const v1::Force& scene, std::string_view path, ModelBuilder& builder) {
  switch (scene.kind_case()) {
    case v1::Force::kSprings:
      return Springs::Make(scene.springs(), scene.name(), In(path, "springs"), builder);
    case v1::Force::kFriction:
      return Friction::Make(scene.friction(), scene.name(), In(path, "friction"), builder);
    case v1::Force::kActionLine:
      return ActionLine::Make(scene.action_line(), scene.name(), In(path, "action_line"), builder);
    case v1::Force::kAttachment:
      return Attachment::Make(scene.attachment(), scene.name(), In(path, "attachment"), builder);
    case v1::Force::kGravity:
      return Gravity::Make(scene.gravity(), scene.name(), In(path, "gravity"), builder);
    case v1::Force::kContact:
      return Contact::Make(scene.contact(), scene.name(), In(path, "contact"), builder);
    case v1::Force::kCables:
      return Cables::Make(scene.cables(), scene.name(), In(path, "cables"), builder);
    case v1::Force::kMembrane:
      return MakeMembrane(scene.membrane(), scene.name(), In(path, "membrane"), builder);
    case v1::Force::kSolid:
      return MakeSolid(scene.solid(), scene.name(), In(path, "solid"), builder);
    case v1::Force::kFibres:
      return Fibres::Make(scene.fibres(), scene.name(), In(path, "fibres"), builder);
    case v1::Force::kBending:
      return Bending::Make(scene.bending(), scene.name(), In(path, "bending"), builder);
    case v1::Force::kCrossLayer:
      return MakeCrossLayer(scene.cross_layer(), scene.name(), In(path, "cross_layer"), builder);
    case v1::Force::kTargetSpring:
      return TargetSpring::Make(scene.target_spring(), scene.name(), In(path, "target_spring"), builder);
    case v1::Force::kPointLoad:
      return PointLoad::Make(scene.point_load(), scene.name(), In(path, "point_load"), builder);
    case v1::Force::kPressure:
      return Pressure::Make(scene.pressure(), scene.name(), In(path, "pressure"), builder);
    case v1::Force::kLungs:
      return Lungs::Make(scene.lungs(), scene.name(), In(path, "lungs"), builder);
    case v1::Force::kWallContact:
      return WallContact::Make(scene.wall_contact(), scene.name(), In(path, "wall_contact"), builder);
    case v1::Force::kChestWall:
      return ChestWall::Make(scene.chest_wall(), scene.name(), In(path, "chest_wall"), builder);
    case v1::Force::kThoraxPressures:
      return ThoraxPressures::Make(scene.thorax_pressures(), scene.name(), In(path, "thorax_pressures"), builder);
    case v1::Force::kMuscle:
      return Muscle::Make(scene.muscle(), scene.name(), In(path, "muscle"), builder);
    case v1::Force::KIND_NOT_SET:
      break;
  }
  return NoKind(path);
}

absl::StatusOr<std::unique_ptr<Constraint>> MakeConstraint(const v1::Constraint& scene, std::string_view path,
                                                           ModelBuilder& builder) {
  switch (scene.kind_case()) {
    case v1::Constraint::kRigidLinks:
      return RigidLinks::Make(scene.rigid_links(), scene.name(), In(path, "rigid_links"), builder);
    case v1::Constraint::kLengthLimits:
      return Limits::Make(scene.length_limits(), scene.name(), In(path, "length_limits"), builder);
    case v1::Constraint::KIND_NOT_SET:
      break;
  }
  return NoKind(path);
}

// Adds skins and their corrections, the wall before the obstacle: later corrections act on the results of earlier ones.
absl::Status AddCorrectedSkins(const v1::Skin& scene, const std::string& name, std::string_view path,
                               ModelBuilder& builder) {
  if (absl::Status status = AddSkins(scene, name, path, builder); !status.ok()) return status;
  if (absl::Status status = AddCageLimit(scene, path, builder); !status.ok()) return status;
  return AddObstacle(scene, path, builder);
}

absl::Status AddMotion(const v1::Motion& scene, std::string_view path, ModelBuilder& builder) {
  switch (scene.kind_case()) {
    case v1::Motion::kRibs:
      return Add(Ribs::Make(scene.ribs(), scene.name(), In(path, "ribs"), builder), builder);
    case v1::Motion::kSternum:
      return Add(Sternum::Make(scene.sternum(), scene.name(), In(path, "sternum"), builder), builder);
    case v1::Motion::kOscillation:
      return Add(Oscillation::Make(scene.oscillation(), scene.name(), In(path, "oscillation"), builder), builder);
    case v1::Motion::kSkin:
      return AddCorrectedSkins(scene.skin(), scene.name(), In(path, "skin"), builder);
    case v1::Motion::kInsertion:
      return Add(Insertion::Make(scene.insertion(), scene.name(), In(path, "insertion"), builder), builder);
    case v1::Motion::kLungModes:
      return Add(LungModes::Make(scene.lung_modes(), scene.name(), In(path, "lung_modes"), builder), builder);
    case v1::Motion::KIND_NOT_SET:
      break;
  }
  return NoKind(path);
}

absl::StatusOr<std::unique_ptr<Measure>> MakeMeasure(const v1::Measure& scene, std::string_view path,
                                                     ModelBuilder& builder) {
  switch (scene.kind_case()) {
    case v1::Measure::kVolume:
      return MakeVolume(scene.volume(), scene.name(), In(path, "volume"), builder);
    case v1::Measure::kFlow:
      return MakeFlow(scene.flow(), scene.name(), In(path, "flow"), builder);
    case v1::Measure::kKineticEnergy:
      return MakeKineticEnergy(scene.kinetic_energy(), scene.name(), In(path, "kinetic_energy"), builder);
    case v1::Measure::kElasticEnergy:
      return MakeElasticEnergy(scene.elastic_energy(), scene.name(), In(path, "elastic_energy"), builder);
    case v1::Measure::kHighest:
      return MakeHighest(scene.highest(), scene.name(), In(path, "highest"), builder);
    case v1::Measure::kForceOutput:
      return MakeForceOutput(scene.force_output(), scene.name(), In(path, "force_output"), builder);
    case v1::Measure::KIND_NOT_SET:
      break;
  }
  return NoKind(path);
}

}  // namespace phrenic
