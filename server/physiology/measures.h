// What is read off a recorded breath. A measure is kNone if the scene lacks what it is measured on.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_MEASURES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_MEASURES_H_

#include "server/physiology/recording.h"

namespace phrenic::physiology {

// `other` is the breath that `r` is compared with; the same breath if the measure compares nothing. Units are those of
// people: mm, l, l/s, cmH2O, %, J/l.
using BreathMeasure = double (*)(const Recording& r, const Recording& other);

// Descent of a column: its height at the beginning of the breath minus its lowest [mm].
double RightApex(const Recording& r, const Recording&);
double RightBack(const Recording& r, const Recording&);
double LeftApex(const Recording& r, const Recording&);
double LeftBack(const Recording& r, const Recording&);
double RightApexOrBack(const Recording& r, const Recording&);  // the larger one
double LeftOverRight(const Recording& r, const Recording&);    // at the apex [1]
double BackOverFront(const Recording& r, const Recording&);    // of the upper face [1]
double RightMean(const Recording& r, const Recording&);        // over the upper face, at the peak [mm]
double LeftMean(const Recording& r, const Recording&);
double DomeSpeed(const Recording& r, const Recording&);  // greatest descent of the right apex over 0.1 s [mm/s]
// Greatest motion of either apex, up or down [mm].
double DomeMotion(const Recording& r, const Recording&);
// Rise of a column: its greatest height minus that at the beginning [mm]; and of both apices at the peak, the smaller.
double RightRise(const Recording& r, const Recording&);
double LeftRise(const Recording& r, const Recording&);
double BothRise(const Recording& r, const Recording&);
double LesserDescent(const Recording& r, const Recording&);
// Height of the right apex at the beginning over that of the other breath [mm].
double ApexAbove(const Recording& r, const Recording& other);
// The descent of the right apex or back, whichever is larger, over that of the other breath [%].
double DescentShare(const Recording& r, const Recording& other);

// Between the beginning and the peak: fibres, all and cut by planes; strain across; area; thickness [%; 1].
double Shortening(const Recording& r, const Recording&);
double CoronalShortening(const Recording& r, const Recording&);
double SagittalShortening(const Recording& r, const Recording&);  // through the right apex
double AcrossMedian(const Recording& r, const Recording&);
double AcrossNearlyAll(const Recording& r, const Recording&);  // of 95 % of the muscle
double TendonArea(const Recording& r, const Recording&);
double Thickening(const Recording& r, const Recording&);

double SternumVentral(const Recording& r, const Recording&);
double SternumCranial(const Recording& r, const Recording&);
double RibsOutward(const Recording& r, const Recording&);
double RibsDrawnIn(const Recording& r, const Recording&);  // greatest inward motion
// Of ribs 4 to 7 between the beginning and the peak: right ones inwards, left ones outwards [mm], right of left [%].
double RightRibsIn(const Recording& r, const Recording&);
double LeftRibsOut(const Recording& r, const Recording&);
double RightRibsShare(const Recording& r, const Recording&);
double LungLeast(const Recording& r, const Recording&);
double LungApex(const Recording& r, const Recording&);
double LungBase(const Recording& r, const Recording&);
double LungBackOverFront(const Recording& r, const Recording&);

double TidalVolume(const Recording& r, const Recording&);               // greatest minus least [l]
double InspiredVolume(const Recording& r, const Recording&);            // greatest minus that at the beginning [l]
double VolumeAtRest(const Recording& r, const Recording&);              // at the beginning [l]
double VolumeAbove(const Recording& r, const Recording& other);         // at the beginning, over the other's [l]
double InspiredShare(const Recording& r, const Recording& other);       // inspired volume, of the other's [%]
double TidalVolumeLost(const Recording& r, const Recording& other);     // of the other's [%]
double AbdominalShare(const Recording& r, const Recording&);            // of the volume breathed in [%]
double AbdominalShareLost(const Recording& r, const Recording& other);  // [points]
double CavityError(const Recording& r, const Recording&);               // closed surface over integrated flow, - 1 [%]
double PdiSwing(const Recording& r, const Recording&);                  // greatest minus that at the beginning [cmH2O]
double PdiShare(const Recording& r, const Recording& other);            // of the other's swing [%]
double PleuralFall(const Recording& r, const Recording&);               // [cmH2O]
double PleuralFallShare(const Recording& r, const Recording& other);    // [1]
double PleuralRise(const Recording& r, const Recording&);               // over that at the beginning [cmH2O]
double FlowOut(const Recording& r, const Recording&);                   // greatest expiratory flow [l/s]
double FlowOutShare(const Recording& r, const Recording& other);        // of the other's [1]
double PleuralRiseShare(const Recording& r, const Recording& other);    // of the other's [1]
double FlowShare(const Recording& r, const Recording& other);           // greatest inspiratory flow, of the other's [1]
double WorkShare(const Recording& r, const Recording& other);           // of a litre breathed in, over the other's [1]
double LoopShare(const Recording& r, const Recording& other);           // area of the pressure-volume loop a litre [1]

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_MEASURES_H_
