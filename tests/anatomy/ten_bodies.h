// The bodies of client/examples/bodies.txt.
#ifndef PHRENIC_TESTS_ANATOMY_TEN_BODIES_H_
#define PHRENIC_TESTS_ANATOMY_TEN_BODIES_H_

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "server/schema/schema.h"

namespace phrenic {

struct NamedBody {
  std::string title;
  v1::Physique physique;
};

inline std::vector<NamedBody> TenBodies() {
  std::vector<NamedBody> bodies;
  std::ifstream file(PHRENIC_SOURCE_DIR "/client/examples/bodies.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    const size_t colon = line.find(':');
    NamedBody& body = bodies.emplace_back();
    body.title = line.substr(0, colon);
    std::stringstream words(line.substr(colon + 1));
    for (std::string word; words >> word;) {
      const size_t equals = word.find('=');
      EXPECT_TRUE(schema::SetPhysique(word.substr(0, equals), word.substr(equals + 1), &body.physique).ok()) << line;
    }
  }
  EXPECT_EQ(bodies.size(), 10U);
  return bodies;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_ANATOMY_TEN_BODIES_H_
