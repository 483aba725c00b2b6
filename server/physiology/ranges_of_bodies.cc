#include "server/physiology/rows.h"
#include "server/schema/body_size.h"

namespace phrenic::physiology {
namespace {

double RatioOf(Follows what, const schema::BodySize& size) {
  switch (what) {
    case Follows::kLength:
      return size.length;
    case Follows::kLungs:
      return size.lungs;
    case Follows::kInspired:
      return size.inspired;
    case Follows::kVital:
      return size.vital;
    default:
      return 1;
  }
}

}  // namespace

Range RangeFor(const Row& row, const v1::Physique& physique) {
  const double ratio = RatioOf(row.follows, schema::SizeOf(physique));
  return {ratio * row.low, ratio * row.high};
}

}  // namespace phrenic::physiology
