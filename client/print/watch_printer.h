// Prints the events of `phrenic watch`.
#ifndef PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
#define PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_

#include <memory>

#include "client/connection/context.h"
#include "phrenic/v1/frames.pb.h"

namespace phrenic::client {

// Prints events on standard output. Not thread-safe. The last picture stays after destruction. `phrenic watch` makes
// one and passes each event from the thread that reads the stream.
class WatchPrinter {
 public:
  virtual ~WatchPrinter() = default;
  // Returns once the event is written; a status may change only what later frames show.
  virtual void Print(const v1::WatchFramesResponse& event) = 0;
  // Keeps the current picture: the next event is drawn below it. `phrenic watch` calls it when a stream ends, before
  // other text goes to the terminal.
  virtual void Detach() {}
};

// Returns a printer for the context's output format. For kTable: live bars on a terminal, one line per frame elsewhere.
// For JSON, one line per event; for CSV, one per frame, in SI units with all digits.
std::unique_ptr<WatchPrinter> MakeWatchPrinter(const Context& context);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
