// Equal scenes have equal hashes, other scenes others: saved sessions and replays rely on them.
#include "server/session/scene_hash.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"

namespace phrenic::session {
namespace {

std::string HashOf(const std::string& of_body, const std::string& stiffness, const std::string& columns = "3") {
  return SceneHash(*CompileText(absl::StrCat(
      "name: 's' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 1 ", of_body, " grid { columns: ", columns,
      " rows: 3 u { x: 1 } v { y: 1 } } } forces { springs { bodies: 'sheet' stiffness: ", stiffness, " } }")));
}

TEST(SceneHash, IsThatOfTheSceneHoweverItIsWritten) {
  EXPECT_EQ(HashOf("", "5"), HashOf("", "5.0"));
  EXPECT_EQ(HashOf("", "5").size(), 64u);
}

TEST(SceneHash, IsAnotherForAnotherForceMeshOrVelocity) {
  const std::string hash = HashOf("", "5");
  EXPECT_NE(HashOf("", "6"), hash);
  EXPECT_NE(HashOf("", "5", "4"), hash);
  EXPECT_NE(HashOf("initial_velocity { linear { x: 1 } }", "5"), hash);
}

}  // namespace
}  // namespace phrenic::session
