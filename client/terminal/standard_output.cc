#include "client/terminal/standard_output.h"

#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace phrenic::client {

StandardOutput::StandardOutput() : below_(std::cout.rdbuf()) { std::cout.rdbuf(this); }

StandardOutput::~StandardOutput() { std::cout.rdbuf(below_); }

absl::Status StandardOutput::Finish() {
  sync();
  // Some file systems report a full disk only when the file is closed; closing a copy of the descriptor does so too.
  errno = 0;
  const int copy = dup(STDOUT_FILENO);
  if (copy >= 0 && close(copy) != 0) NoteFailure();
  if (!failed_ || error_ == EPIPE) return absl::OkStatus();
  const std::string cause = error_ == 0 ? "it cannot be written" : std::generic_category().message(error_);
  return absl::DataLossError(absl::StrCat("standard output: ", cause));
}

StandardOutput::int_type StandardOutput::overflow(int_type letter) {
  if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
  errno = 0;
  const int_type put = below_->sputc(traits_type::to_char_type(letter));
  if (traits_type::eq_int_type(put, traits_type::eof())) NoteFailure();
  return put;
}

std::streamsize StandardOutput::xsputn(const char* letters, std::streamsize count) {
  errno = 0;
  const std::streamsize put = below_->sputn(letters, count);
  if (put != count) NoteFailure();
  return put;
}

int StandardOutput::sync() {
  errno = 0;
  const int result = below_->pubsync();
  if (result != 0) NoteFailure();
  return result;
}

void StandardOutput::NoteFailure() {
  if (!failed_) error_ = errno;
  failed_ = true;
}

}  // namespace phrenic::client
