// Unit conversion: files and user interfaces use millimetres, all computation uses metres.
#ifndef PHRENIC_SERVER_MESH_UNITS_H_
#define PHRENIC_SERVER_MESH_UNITS_H_

namespace phrenic {

inline constexpr double kMillimetre = 1e-3;        // [m]
inline constexpr double kMillimetresAMetre = 1e3;  // exact; 1 / kMillimetre is rounded

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_UNITS_H_
