#include "server/schema/physique.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;

constexpr double kAdultAge = 30;                                         // [years]
constexpr double kManHeight = 1.75, kWomanHeight = 1.62;                 // [m]
constexpr double kWomanChest = 0.95;                                     // width and depth, of a man's of her height
constexpr double kWomanSlope = 3;                                        // [degrees]
constexpr double kSlopeAYear = -0.1, kKyphosisAYear = 0.3;               // [degrees]
constexpr double kBarrelDepth = 0.22;                                    // more than 1
constexpr double kBarrelSlope = -6;                                      // [degrees]
constexpr double kBarrelDomes = -0.02;                                   // [m]
constexpr double kYoungest = 24, kOldest = 75;                           // in whom compliance was measured [years]
constexpr double kYoungGroup = 31.5, kOldGroup = 65;                     // middles of the two groups [years]
constexpr double kOldCage = 0.114 / 0.164, kOldAbdomen = 0.020 / 0.032;  // compliance of the old, of the young one's

// Sets the number to `value`, moved into its range, unless it is set. Never sets -0, which would differ from 0.
void Choose(int field, double value, v1::Physique& physique) {
  const FieldDescriptor& number = *v1::Physique::descriptor()->FindFieldByNumber(field);
  const google::protobuf::Reflection& reflection = *physique.GetReflection();
  if (reflection.HasField(physique, &number)) return;
  const v1::Quantity& quantity = *QuantityOf(number);
  reflection.SetDouble(&physique, &number, std::clamp(value + 0.0, quantity.minimum(), quantity.maximum()));
}

// Returns the compliance at an age, of that at the adult's, if it falls linearly between the two groups.
double ComplianceAt(double age, double of_old) {
  const double slope = (of_old - 1) / (kOldGroup - kYoungGroup);
  const auto line = [&](double years) { return 1 + slope * (std::clamp(years, kYoungest, kOldest) - kYoungGroup); };
  return line(age) / line(kAdultAge);
}

}  // namespace

v1::Physique CompletePhysique(const v1::Physique& physique) {
  v1::Physique full = physique;
  FillDefaults(&full);  // sex, age and barrel chest
  const bool woman = full.sex() == v1::SEX_FEMALE;
  const double years = full.age() - kAdultAge, barrel = full.barrel_chest(), chest = woman ? kWomanChest : 1;
  Choose(v1::Physique::kHeightFieldNumber, woman ? kWomanHeight : kManHeight, full);
  Choose(v1::Physique::kChestWidthFieldNumber, chest, full);
  Choose(v1::Physique::kChestDepthFieldNumber, chest * (1 + kBarrelDepth * barrel), full);
  Choose(v1::Physique::kRibSlopeDegreesFieldNumber,
         (woman ? kWomanSlope : 0) + kSlopeAYear * years + kBarrelSlope * barrel, full);
  Choose(v1::Physique::kRightDomeHeightFieldNumber, kBarrelDomes * barrel, full);
  Choose(v1::Physique::kLeftDomeHeightFieldNumber, kBarrelDomes * barrel, full);
  Choose(v1::Physique::kScoliosisDegreesFieldNumber, 0, full);
  Choose(v1::Physique::kKyphosisDegreesFieldNumber, kKyphosisAYear * years, full);
  return full;
}

void SetCompliancesOfAge(v1::Scene* scene) {
  if (!scene->physique().has_age()) return;
  const double age = scene->physique().age();
  v1::Parameters& parameters = *scene->mutable_parameters();
  if (!parameters.has_chest_wall_compliance()) parameters.set_chest_wall_compliance(ComplianceAt(age, kOldCage));
  if (!parameters.has_abdominal_compliance()) parameters.set_abdominal_compliance(ComplianceAt(age, kOldAbdomen));
}

absl::Status ReplacePhysique(const v1::Physique& physique, v1::Scene* scene) {
  if (absl::Status status = Validate(physique); !status.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("physique.", status.message()));
  }
  int generated = 0;
  for (v1::Body& body : *scene->mutable_bodies()) {
    if (!body.has_generated()) continue;
    body.mutable_generated()->mutable_physique()->MergeFrom(physique);
    ++generated;
  }
  if (generated == 0) {
    return absl::InvalidArgumentError(absl::StrCat("physique: scene \"", scene->name(),
                                                   "\" generates no body; choose one that does, such as thorax"));
  }
  scene->mutable_physique()->MergeFrom(physique);
  return absl::OkStatus();
}

}  // namespace phrenic::schema
