// The generated lungs, coarser than a scene's, made once a program.
#ifndef PHRENIC_TESTS_FIT_TEMPLATE_LUNGS_H_
#define PHRENIC_TESTS_FIT_TEMPLATE_LUNGS_H_

#include "server/anatomy/anatomy.h"
#include "server/fit/person.h"

namespace phrenic::fit {

inline Mesh GeneratedLung(Side side) {
  v1::Anatomy part;
  part.set_structure(v1::STRUCTURE_LUNG);
  part.set_side(side == kLeft ? v1::SIDE_LEFT : v1::SIDE_RIGHT);
  return *anatomy::Generate(part, 8);
}

inline const LungTemplates& GeneratedLungs() {
  static const auto* const lungs =
      new LungTemplates{LungTemplate(GeneratedLung(kRight)), LungTemplate(GeneratedLung(kLeft))};
  return *lungs;
}

}  // namespace phrenic::fit

#endif  // PHRENIC_TESTS_FIT_TEMPLATE_LUNGS_H_
