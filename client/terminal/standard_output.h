// Standard output whose failures are noticed.
#ifndef PHRENIC_CLIENT_TERMINAL_STANDARD_OUTPUT_H_
#define PHRENIC_CLIENT_TERMINAL_STANDARD_OUTPUT_H_

#include <streambuf>
#include <string>

#include "absl/status/status.h"

namespace phrenic::client {

// Passes what std::cout prints on to its buffer and keeps the cause of the first failure, which std::cout does not. The
// destructor gives std::cout its buffer back. Not thread-safe. Requires: one at a time.
class StandardOutput : private std::streambuf {
 public:
  StandardOutput();
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  // Prints what is left in the buffer. DATA_LOSS, "standard output: No space left on device", if anything since the
  // start was not written. OK if its reader has closed the pipe (`| head`).
  absl::Status Finish();

 private:
  int_type overflow(int_type letter) override;
  std::streamsize xsputn(const char* letters, std::streamsize count) override;
  int sync() override;
  // Keeps errno if it is the first failure.
  void NoteFailure();

  std::streambuf* const below_;
  bool failed_ = false;
  int error_ = 0;  // errno of the first failure
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_STANDARD_OUTPUT_H_
