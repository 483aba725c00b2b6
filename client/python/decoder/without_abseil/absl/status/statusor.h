// The part of Abseil's StatusOr that the codecs use, in the decoder alone (see status.h).
#ifndef PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUSOR_H_
#define PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUSOR_H_

#include <optional>
#include <utility>

#include "absl/status/status.h"

namespace absl {

// A value, or the error in its place. Requires: ok() where the value is read.
template <typename T>
class [[nodiscard]] StatusOr {
 public:
  StatusOr(Status status) : status_(std::move(status)) {}
  StatusOr(const T& value) : value_(value) {}
  StatusOr(T&& value) : value_(std::move(value)) {}

  bool ok() const { return status_.ok(); }
  const Status& status() const { return status_; }
  T& operator*() & { return *value_; }
  const T& operator*() const& { return *value_; }
  T&& operator*() && { return *std::move(value_); }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }

 private:
  Status status_;
  std::optional<T> value_;
};

}  // namespace absl

#endif  // PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUSOR_H_
