// What `phrenic watch` prints of each event.
#ifndef PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
#define PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_

#include <memory>

#include "client/connection/connection.h"
#include "phrenic/v1/frames.pb.h"

namespace phrenic::client {

// Not thread-safe. What is drawn stays when the object goes.
class WatchPrinter {
 public:
  virtual ~WatchPrinter() = default;
  virtual void Print(const v1::WatchFramesResponse& event) = 0;
  // Somebody else writes below: what is there is drawn over no more.
  virtual void Leave() {}
};

// Live bars where standard output is a terminal, a line a frame where not; as the context's output says otherwise.
std::unique_ptr<WatchPrinter> MakeWatchPrinter(const Context& context);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_WATCH_PRINTER_H_
