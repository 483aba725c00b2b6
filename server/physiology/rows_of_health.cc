#include "server/physiology/rows.h"

namespace phrenic::physiology {
namespace {

constexpr const char *kBoussuges = "Boussuges 2009", *kGauthier = "Gauthier 1994", *kWilson = "from Wilson 1987",
                     *kKonno = "Konno and Mead", *kKnown = "general knowledge",
                     *kConstantVolume = "20-36 % shortening at constant volume", *kLaw = "conservation of volume",
                     *kScans = "ten CTs", *kTendon = "tendon is not stretched by physiological stress";

constexpr Row kHealthRows[] = {
    {"quiet", "right dome, descent at the apex", "mm", 10, 25, &RightApex, Needs::kSheet, kBoussuges},
    {"quiet", "right dome, descent 40 mm behind", "mm", 10, 25, &RightBack, Needs::kSheet, kBoussuges},
    {"quiet", "left dome, descent at the apex", "mm", 0, 0, &LeftApex, Needs::kSheet, ""},
    {"quiet", "left dome, descent 40 mm behind", "mm", 0, 0, &LeftBack, Needs::kSheet, ""},
    {"quiet", "left over right descent", "1", 0.6, 1.1, &LeftOverRight, Needs::kSheet, kBoussuges},
    {"quiet", "back over front descent", "1", 1, 10, &BackOverFront, Needs::kSheet, kBoussuges},
    {"quiet", "right side, mean descent", "mm", 0, 0, &RightMean, Needs::kSheet, ""},
    {"quiet", "left side, mean descent", "mm", 0, 0, &LeftMean, Needs::kSheet, ""},
    {"quiet", "dome speed", "mm/s", 2, 25, &DomeSpeed, Needs::kSheet, kBoussuges},
    {"quiet", "fibre shortening", "%", 5, 15, &Shortening, Needs::kFibres, kKnown},
    {"quiet", "shortening, coronal section", "%", 5, 15, &CoronalShortening, Needs::kFibres, kKnown},
    {"quiet", "shortening, sagittal section", "%", 5, 15, &SagittalShortening, Needs::kFibres, kKnown},
    {"quiet", "strain across fibres, half the muscle", "%", 0, 2, &AcrossMedian, Needs::kFibres, kGauthier},
    {"quiet", "strain across fibres, 95 % of the muscle", "%", 0, 5, &AcrossNearlyAll, Needs::kFibres, kGauthier},
    {"quiet", "tendon area change", "%", 0, 2, &TendonArea, Needs::kFibres, kTendon},
    {"quiet", "thickness at the wall over that at rest", "1", 1.05, 1.25, &Thickening, Needs::kWall, kConstantVolume},
    {"quiet", "sternum forward", "mm", 1.5, 5, &SternumVentral, Needs::kBones, kWilson, "", Follows::kLength},
    {"quiet", "sternum upward", "mm", 2, 9, &SternumCranial, Needs::kBones, kWilson, "", Follows::kLength},
    {"quiet", "ribs 7-10 outward", "mm", 1.5, 5, &RibsOutward, Needs::kBones, kWilson, "", Follows::kLength},
    {"quiet", "abdominal share of volume", "%", 52, 75, &AbdominalShare, Needs::kLungs, kKonno},
    {"quiet", "tidal volume", "l", 0.4, 0.7, &TidalVolume, Needs::kPressures, kKnown, "", Follows::kLungs},
    {"quiet", "transdiaphragmatic pressure, swing", "cmH2O", 4, 15, &PdiSwing, Needs::kPressures, kKnown},
    {"quiet", "pleural pressure, fall", "cmH2O", 3, 8, &PleuralFall, Needs::kPressures, kKnown},
    {"quiet", "volume of the cavity against the flow", "%", -2, 2, &CavityError, Needs::kPressures, kLaw},
    {"quiet", "lungs downward, least", "mm", 0, 20, &LungLeast, Needs::kLungs, kScans, "", Follows::kLength},
    {"quiet", "lungs downward, apex", "mm", 1, 4, &LungApex, Needs::kLungs, kScans, "", Follows::kLength},
    {"quiet", "lungs downward, base", "mm", 8, 16, &LungBase, Needs::kLungs, kScans, "", Follows::kLength},
    {"quiet", "lungs downward, back over front", "1", 1.3, 2.5, &LungBackOverFront, Needs::kLungs, kScans},
    {"deep", "right dome, descent at the apex or behind", "mm", 40, 95, &RightApexOrBack, Needs::kSheet, kBoussuges},
    {"deep", "left over right descent", "1", 0.6, 1.1, &LeftOverRight, Needs::kSheet, kBoussuges},
    {"deep", "right side, mean descent", "mm", 0, 0, &RightMean, Needs::kSheet, ""},
    {"deep", "left side, mean descent", "mm", 0, 0, &LeftMean, Needs::kSheet, ""},
    {"deep", "fibre shortening", "%", 20, 36, &Shortening, Needs::kFibres, kGauthier},
    {"deep", "shortening, coronal section", "%", 20, 36, &CoronalShortening, Needs::kFibres, kGauthier},
    {"deep", "shortening, sagittal section", "%", 20, 36, &SagittalShortening, Needs::kFibres, kGauthier},
    {"deep", "tendon area change", "%", 0, 3, &TendonArea, Needs::kFibres, kTendon},
    {"deep", "thickness at the wall over that at rest", "1", 1.3, 1.9, &Thickening, Needs::kWall, kConstantVolume},
    {"deep", "sternum forward", "mm", 8, 20, &SternumVentral, Needs::kBones, kWilson, "", Follows::kLength},
    {"deep", "sternum upward", "mm", 15, 45, &SternumCranial, Needs::kBones, kWilson, "", Follows::kLength},
    {"deep", "ribs 7-10 outward", "mm", 9, 20, &RibsOutward, Needs::kBones, kWilson, "", Follows::kLength},
    {"deep", "inspiratory capacity", "l", 2.3, 3.8, &InspiredVolume, Needs::kPressures, kKnown, "", Follows::kInspired},
    {"deep", "volume of the cavity against the flow", "%", -2, 2, &CavityError, Needs::kPressures, kLaw},
    {"vital-capacity", "vital capacity", "l", 3.5, 5.5, &TidalVolume, Needs::kPressures, kKnown, "", Follows::kVital},
    {"diaphragmatic", "abdominal share of volume", "%", 75, 110, &AbdominalShare, Needs::kLungs, kKonno},
    {"chest", "abdominal share of volume", "%", -100, 35, &AbdominalShare, Needs::kLungs, kKonno},
    {"sniff", "transdiaphragmatic pressure, swing", "cmH2O", 70, 150, &PdiSwing, Needs::kPressures, "sniffs of adults"},
    {"sniff", "ribs 7-10 drawn in", "mm", 0, 2, &RibsDrawnIn, Needs::kBones, kKnown},
};

constexpr FlawRow kFlawRows[] = {
    {kSelfCrossings, "crossings of the sheet with itself", "1", 1, 0, Needs::kSheet},
    {kCrossedLayers, "crossed layers of the sheet", "1", 1, 0, Needs::kSheet},
    {kPiercingRibs, "rib vertices through the sheet by 0.5 mm", "1", 1, 0, Needs::kBones},
    {kPiercingLungs, "lungs through sheet or ribs by 1 mm", "1", 1, 0, Needs::kLungs},
    {kHollow, "hollow of a dome", "mm", 1e3, 1, Needs::kSheet},
};

}  // namespace

std::span<const Row> RowsOfHealth() { return kHealthRows; }
std::span<const FlawRow> FlawRows() { return kFlawRows; }

}  // namespace phrenic::physiology
