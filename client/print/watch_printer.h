// Prints the events of `phrenic watch`.
#ifndef PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
#define PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_

#include <memory>

#include "client/connection/context.h"
#include "phrenic/v1/frames.pb.h"

namespace phrenic::client {

// Prints events on standard output. Not thread-safe. The last picture stays after destruction.
class WatchPrinter {
 public:
  virtual ~WatchPrinter() = default;
  virtual void Print(const v1::WatchFramesResponse& event) = 0;
  // Keeps the current picture: the next event is drawn below it.
  virtual void Detach() {}
};

// Returns a printer for the context's output format. For kTable: live bars on a terminal, one line per frame elsewhere.
std::unique_ptr<WatchPrinter> MakeWatchPrinter(const Context& context);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
