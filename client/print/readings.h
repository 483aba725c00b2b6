// A scene's measures as text and JSON.
#ifndef PHRENIC_CLIENT_PRINT_READINGS_H_
#define PHRENIC_CLIENT_PRINT_READINGS_H_

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "client/connection/measure_ranges.h"

namespace phrenic::client {

// Returns the value in four digits, in litres for m^3, l/s for m^3/s and millimetres for m: "2.513 l", "0.4 l/s",
// "-530 Pa". `unit` is the SI unit of `value`. Other units stay as they are.
std::string ReadingText(double value, const std::string& unit);

// Prints a table in the units of ReadingText. Prints nothing if there are no measures.
void PrintMeasureRanges(const MeasureRanges& measures, std::ostream& out);
// Returns [{"name", "unit", "last", "minimum", "maximum"}] in SI units. Empty list without measures.
nlohmann::json MeasureRangesJson(const MeasureRanges& measures);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_READINGS_H_
