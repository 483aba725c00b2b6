// The part of Abseil's StrCat that the codecs use, in the decoder alone (see absl/status/status.h).
#ifndef PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STRINGS_STR_CAT_H_
#define PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STRINGS_STR_CAT_H_

#include <string>
#include <type_traits>

namespace absl {

// Returns the texts and whole numbers one after the other.
template <typename... Parts>
std::string StrCat(const Parts&... parts) {
  std::string text;
  const auto append = [&text](const auto& part) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(part)>>) {
      text += std::to_string(part);
    } else {
      text += part;
    }
  };
  (append(parts), ...);
  return text;
}

}  // namespace absl

#endif  // PHRENIC_CLIENT_PYTHON_DECODER_WITHOUT_ABSEIL_ABSL_STRINGS_STR_CAT_H_
