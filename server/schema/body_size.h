// How large a person's chest and lungs are, relative to the adult's (a man of 30 years and 1.75 m), and the numbers of
// a scene's forces that follow from it. All ratios are exactly 1 for the adult. Stateless; thread-safe.
//
//   volume     of the cage: (height/1.75 m)^3 times chest's width and depth, as the map of anatomy/physique.h scales it
//   length     its cube root
//   lungs, resting, inspired, vital: total lung capacity, functional residual capacity, inspiratory and vital capacity,
//              predicted by height, sex and age (Quanjer et al., Eur Respir J 1993;6 suppl 16:5; heights in m, years):
//                men    TLC = 7.99 H - 7.08   FRC = 2.34 H + 0.009 A - 1.09   RV = 1.31 H + 0.022 A - 1.23   [l]
//                women  TLC = 6.60 H - 5.79   FRC = 2.24 H + 0.001 A - 1.00   RV = 1.81 H + 0.016 A - 2.00   [l]
//              IC = TLC - FRC, VC = TLC - RV, times the chest's width and depth over those that the sex chooses. The
//              formulas hold from 1.45 to 1.95 m and from 18 to 70 years: beyond, volumes go with the cube of the
//              height and stay at those of 70 years.
#ifndef PHRENIC_SERVER_SCHEMA_BODY_SIZE_H_
#define PHRENIC_SERVER_SCHEMA_BODY_SIZE_H_

#include "phrenic/v1/scene.pb.h"

namespace phrenic::schema {

struct BodySize {
  double length = 1, volume = 1;
  double lungs = 1, resting = 1, inspired = 1, vital = 1;
};

BodySize SizeOf(const v1::Physique& physique);

// Scales the forces that a thorax breathes with, so that the same pressures and activations move a body of this size
// by the same share of its own length:
//   muscle              thickness and tensions with the length
//   lungs               room with `inspired`, so that the recoil at total lung capacity is the adult's: the exponent of
//                       the curve does not depend on size (Colebatch et al., J Appl Physiol 1979;46:387); resistances
//                       with 1/`resting`, as specific conductance is alike; rest volume with `resting`
//   abdomen, rib cage   compliances and volumes with the volume
// What a force does not set is its default.
void ScaleForces(const BodySize& size, v1::Scene* scene);

// Scales the forces to the scene's physique. Numbers that the scene sets stay.
void ScaleForcesToPhysique(v1::Scene* scene);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_BODY_SIZE_H_
