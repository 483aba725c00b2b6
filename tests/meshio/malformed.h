// Checks that the readers' tests share: malformed files give the right error or a valid mesh.
#ifndef PHRENIC_TESTS_MESHIO_MALFORMED_H_
#define PHRENIC_TESTS_MESHIO_MALFORMED_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>

#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {

// Expects INVALID_ARGUMENT with a message that starts with `start` and contains `words`.
inline void ExpectParseError(std::string_view name, std::string_view text, const char* start, const char* words) {
  const auto mesh = Parse(name, text, 1.0);
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << text;
  EXPECT_THAT(std::string(mesh.status().message()), ::testing::StartsWith(start)) << text;
  EXPECT_THAT(std::string(mesh.status().message()), ::testing::HasSubstr(words)) << text;
}

// An edit that makes a valid file malformed, and the error it gives.
struct Malformation {
  const char* from;
  const char* to;
  const char* start;
  const char* words;
};

inline void ExpectParseErrors(std::string_view name, const std::string& valid,
                              std::initializer_list<Malformation> malformations) {
  for (const Malformation& edit : malformations) {
    const std::string text = absl::StrReplaceAll(valid, {{edit.from, edit.to}});
    EXPECT_NE(text, valid) << edit.from;
    ExpectParseError(name, text, edit.start, edit.words);
  }
}

// Expects a valid mesh or an error from every prefix, and at least one mesh.
inline void ExpectTruncationsHandled(std::string_view name, std::string_view whole) {
  int meshes = 0;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const auto mesh = Parse(name, whole.substr(0, length), 1.0);
    if (!mesh.ok()) continue;
    ++meshes;
    EXPECT_TRUE(Validate(*mesh).ok()) << length;
  }
  EXPECT_GT(meshes, 0);
}

// Expects a valid mesh or an error with each byte replaced by each of `replacements`.
inline void ExpectGarbledBytesHandled(std::string_view name, const std::string& whole, std::string_view replacements) {
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char byte : replacements) {
      std::string garbled = whole;
      garbled[at] = byte;
      const auto mesh = Parse(name, garbled, 1.0);
      EXPECT_TRUE(!mesh.ok() || Validate(*mesh).ok()) << at;
    }
  }
}

}  // namespace phrenic::meshio

#endif  // PHRENIC_TESTS_MESHIO_MALFORMED_H_
