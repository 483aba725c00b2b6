// Images are in millimetres, meshes in metres.
#ifndef PHRENIC_SERVER_IMAGING_MILLIMETRE_H_
#define PHRENIC_SERVER_IMAGING_MILLIMETRE_H_

namespace phrenic::imaging {

inline constexpr double kMillimetre = 1e-3;  // [m]

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_MILLIMETRE_H_
