// The part of Abseil's status that the codecs use, in the decoder alone. Wheels run on machines that lack Abseil, and
// Debian's archives of it cannot be linked into a shared library (their thread-local variables are not position
// independent).
#ifndef PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUS_H_
#define PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUS_H_

#include <optional>
#include <string>
#include <string_view>

namespace absl {

// An error with its message, or none.
class [[nodiscard]] Status {
 public:
  Status() = default;
  bool ok() const { return !message_.has_value(); }
  std::string_view message() const { return message_.has_value() ? std::string_view(*message_) : std::string_view(); }

 private:
  friend Status ErrorWith(std::string_view message);
  std::optional<std::string> message_;
};

inline Status ErrorWith(std::string_view message) {
  Status status;
  status.message_ = std::string(message);
  return status;
}
inline Status OkStatus() { return {}; }
inline Status InvalidArgumentError(std::string_view message) { return ErrorWith(message); }
inline Status OutOfRangeError(std::string_view message) { return ErrorWith(message); }

}  // namespace absl

#endif  // PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STATUS_STATUS_H_
