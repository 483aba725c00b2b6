// A fit as bytes, so that an interrupted study of many people keeps those who are finished.
#ifndef PHRENIC_SERVER_FIT_KEPT_FIT_H_
#define PHRENIC_SERVER_FIT_KEPT_FIT_H_

#include <optional>
#include <string>
#include <string_view>

#include "server/fit/motion_fit.h"

namespace phrenic::fit {

// Returns all of a fit, bit for bit. For the same machine and version: little-endian, without a promise of format.
std::string KeepFit(const MotionFit& fit);
// Returns the fit, or nothing if the bytes are not of KeepFit. Thread-safe.
std::optional<MotionFit> ReadKeptFit(std::string_view bytes);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_KEPT_FIT_H_
