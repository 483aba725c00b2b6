#include "server/phantom/dicom/snomed.h"

#include <iterator>

namespace phrenic::phantom {
namespace {

const Code kRibs[] = {{"48535007", "First rib"},   {"78247007", "Second rib"},   {"25888004", "Third rib"},
                      {"25523003", "Fourth rib"},  {"15339008", "Fifth rib"},    {"59558009", "Sixth rib"},
                      {"24915002", "Seventh rib"}, {"5953002", "Eighth rib"},    {"22565002", "Ninth rib"},
                      {"77644006", "Tenth rib"},   {"58830002", "Eleventh rib"}, {"43993008", "Twelfth rib"}};
const Code kVertebrae[] = {{"64864005", "T1 vertebra"}, {"53733008", "T2 vertebra"},  {"1626008", "T3 vertebra"},
                           {"73071006", "T4 vertebra"}, {"56401006", "T5 vertebra"},  {"45296009", "T6 vertebra"},
                           {"62487009", "T7 vertebra"}, {"11068009", "T8 vertebra"},  {"82687006", "T9 vertebra"},
                           {"7610001", "T10 vertebra"}, {"12989004", "T11 vertebra"}, {"23215003", "T12 vertebra"},
                           {"66794005", "L1 vertebra"}, {"14293000", "L2 vertebra"},  {"36470004", "L3 vertebra"},
                           {"11994002", "L4 vertebra"}, {"49668003", "L5 vertebra"}};

const Code kLobes[] = {
    {"45653009", "Upper lobe of lung"}, {"72481006", "Middle lobe of right lung"}, {"90572001", "Lower lobe of lung"}};

// Returns the code of a number from 1, else that of all of the kind.
template <std::size_t count>
Code Numbered(const Code (&codes)[count], int number, const Code& all) {
  return number >= 1 && number <= static_cast<int>(count) ? codes[number - 1] : all;
}

}  // namespace

Code CodeOf(const v1::Anatomy& anatomy) {
  switch (anatomy.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
      return {"5798000", "Diaphragm"};
    case v1::STRUCTURE_RIB:
      return Numbered(kRibs, anatomy.number(), {"113197003", "Rib"});
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return {"50016007", "Costal Cartilage"};
    case v1::STRUCTURE_MANUBRIUM:
      return {"37285002", "Manubrium of sternum"};
    case v1::STRUCTURE_STERNUM_BODY:
      return {"52509009", "Body of sternum"};
    case v1::STRUCTURE_XIPHOID:
      return {"20298003", "Xiphoid Process"};
    case v1::STRUCTURE_VERTEBRA:
      return Numbered(kVertebrae, anatomy.number(), {"51282000", "Vertebra"});
    case v1::STRUCTURE_LUNG:
      return {"39607008", "Lung"};
    case v1::STRUCTURE_DISC:
      return {"360499006", "Intervertebral disc"};
    case v1::STRUCTURE_HEART:
      return {"80891009", "Heart"};
    case v1::STRUCTURE_AORTA:
      return {"15825003", "Aorta"};
    case v1::STRUCTURE_VENA_CAVA:
      return anatomy.number() == 1 ? Code{"48345005", "Superior Vena Cava"} : Code{"64131007", "Inferior Vena Cava"};
    case v1::STRUCTURE_OESOPHAGUS:
      return {"32849002", "Esophagus"};
    case v1::STRUCTURE_TRACHEA:
      return {"110726009", "Trachea and bronchus"};
    case v1::STRUCTURE_LIVER:
      return {"10200004", "Liver"};
    case v1::STRUCTURE_STOMACH:
      return {"69695003", "Stomach"};
    case v1::STRUCTURE_SPLEEN:
      return {"78961009", "Spleen"};
    case v1::STRUCTURE_CLAVICLE:
      return {"51299004", "Clavicle"};
    case v1::STRUCTURE_SCAPULA:
      return {"79601000", "Scapula"};
    case v1::STRUCTURE_KIDNEY:
      return {"64033007", "Kidney"};
    case v1::STRUCTURE_LUNG_LOBE:
      return Numbered(kLobes, anatomy.number(), {"31094006", "Lobe of lung"});
    case v1::STRUCTURE_FISSURE:
      return {"278983006", "Fissure of lung"};
    case v1::STRUCTURE_INNER_CAGE:  // a surface of the mechanics
    case v1::STRUCTURE_UNSPECIFIED:
    case v1::Structure_INT_MIN_SENTINEL_DO_NOT_USE_:
    case v1::Structure_INT_MAX_SENTINEL_DO_NOT_USE_:
      break;
  }
  return {"85756007", "Tissue"};
}

Code CodeOf(v1::Side side) {
  if (side == v1::SIDE_RIGHT) return {"24028007", "Right"};
  if (side == v1::SIDE_LEFT) return {"7771000", "Left"};
  return {};
}

}  // namespace phrenic::phantom
