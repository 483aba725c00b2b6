// A live picture of a session's breath, for a terminal.
#ifndef PHRENIC_CLIENT_PRINT_LIVE_VIEW_H_
#define PHRENIC_CLIENT_PRINT_LIVE_VIEW_H_

#include <deque>
#include <string>
#include <vector>

#include "phrenic/v1/frames.pb.h"

namespace phrenic::client {

// The area to draw on.
struct Canvas {
  int width = 80;  // [columns]
  bool unicode = true;
};

// Keeps the last values of the breath, of each measure, and of each probe's distance from rest [m]. Not thread-safe.
// The watch printer owns one and draws its lines on a terminal. Values are in SI units and shown as by ReadingText.
class LiveView {
 public:
  // Clears the history if the frame's tick is before the last one: the session was reset. Requires: frames of one
  // session, which have the same measures and probes in the same order.
  void Add(const v1::Frame& frame);
  void Add(const v1::Session& session) { session_ = session; }

  // Returns a heading and one line per row: name, value, a bar between the smallest and the greatest value seen, and a
  // sparkline of the last frames. No line is wider than the canvas.
  std::vector<std::string> Lines(const Canvas& canvas) const;

 private:
  struct Row {
    std::string name, unit;
    double least, greatest;     // of all frames since the first
    std::deque<double> values;  // the last 400
  };
  // Adds a value to the row `index`, or a row at the end.
  void Put(size_t index, const std::string& name, const std::string& unit, double value);
  // Session, state, time, tick, pace and residuals.
  std::string Heading() const;
  std::string Line(const Row& row, int name_width, int value_width, const Canvas& canvas) const;

  v1::Session session_;
  double time_ = 0;  // [s]
  std::int64_t tick_ = 0;
  std::vector<Row> rows_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_LIVE_VIEW_H_
