// Uploaded files belong to those who sent their bytes.
#include <gmock/gmock.h>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"
#include "server/session/uploads.h"

namespace phrenic::session {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr char kTriangleFile[] = "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n";

class OwnedUploads : public testing::Test {
 protected:
  static std::string Surface(int number) { return absl::StrCat(kTriangleFile, "# ", number, "\n"); }
  // Uploads a whole file.
  absl::Status Upload(const Requester& by, const std::string& bytes, const std::string& name = "a.obj") {
    const auto begun = uploads_.Begin(by, name, static_cast<std::int64_t>(bytes.size()), Sha256Hex(bytes));
    if (!begun.ok()) return begun.status();
    if (begun->id.empty()) return absl::OkStatus();
    if (auto added = uploads_.Add(by, begun->id, 0, bytes); !added.ok()) return added.status();
    return uploads_.Finish(by, begun->id, 1).status();
  }
  static std::string PathOf(const std::string& bytes) { return "upload:" + Sha256Hex(bytes); }

  const Requester anna_{.owner = "anna"}, ben_{.owner = "ben"}, admin_{.owner = "root", .all_files = true};
  Uploads uploads_{{.upload_bytes = 200, .uploads_bytes = 1000, .uploads_bytes_of_user = 200}, testing::TempDir()};
};

TEST_F(OwnedUploads, AnIdIsRandomAndUselessToAnotherAccount) {
  const std::string bytes = Surface(1);
  const auto size = static_cast<std::int64_t>(bytes.size());
  const std::string id = uploads_.Begin(anna_, "a.obj", size, "")->id;
  EXPECT_THAT(id, SizeIs(32));
  EXPECT_NE(id, uploads_.Begin(anna_, "a.obj", size, "")->id);
  const auto other = uploads_.Add(ben_, id, 0, bytes), none = uploads_.Add(ben_, std::string(32, '0'), 0, bytes);
  EXPECT_TRUE(absl::IsNotFound(other.status()));
  EXPECT_EQ(other.status().code(), none.status().code()) << "whether it exists is not revealed";
  ASSERT_TRUE(uploads_.Add(anna_, id, 0, bytes).ok());
  EXPECT_TRUE(absl::IsNotFound(uploads_.Finish(ben_, id, 1).status()));
  EXPECT_TRUE(uploads_.Finish(anna_, id, 1).ok());
  EXPECT_TRUE(absl::IsNotFound(uploads_.Finish(ben_, id, 1).status())) << "nor afterwards";
  EXPECT_TRUE(uploads_.Finish(anna_, id, 1).ok()) << "a repeat";
}

TEST_F(OwnedUploads, KnowingAHashGivesNeitherTheFileNorWord) {
  const std::string bytes = Surface(1);
  ASSERT_TRUE(Upload(anna_, bytes, "patient-doe.obj").ok());
  const auto begun = uploads_.Begin(ben_, "b.obj", static_cast<std::int64_t>(bytes.size()), Sha256Hex(bytes));
  ASSERT_TRUE(begun.ok()) << begun.status();
  EXPECT_THAT(begun->id, SizeIs(32)) << "as for a file that nobody has";
  EXPECT_EQ(begun->received, 0);
  EXPECT_EQ(begun->file.name, "b.obj");
  EXPECT_TRUE(absl::IsNotFound(uploads_.Hold(ben_, PathOf(bytes)).status()));
  EXPECT_TRUE(absl::IsNotFound(uploads_.Delete(ben_, PathOf(bytes))));
  EXPECT_THAT(uploads_.List(ben_), IsEmpty());
  EXPECT_TRUE(uploads_.Hold(anna_, PathOf(bytes)).ok());
  EXPECT_TRUE(uploads_.Hold(admin_, PathOf(bytes)).ok());
}

TEST_F(OwnedUploads, TwoOwnersOfTheSameBytesShareTheDiskAndNothingElse) {
  const std::string bytes = Surface(1);
  ASSERT_TRUE(Upload(anna_, bytes, "anna.obj").ok());
  ASSERT_TRUE(Upload(ben_, bytes, "ben.obj").ok());
  EXPECT_EQ(uploads_.Hold(anna_, PathOf(bytes))->spool, uploads_.Hold(ben_, PathOf(bytes))->spool);
  EXPECT_EQ(uploads_.List(ben_)[0].name, "ben.obj");
  ASSERT_TRUE(uploads_.Delete(ben_, PathOf(bytes)).ok());
  EXPECT_EQ(uploads_.Hold(anna_, PathOf(bytes))->file.name, "anna.obj");
  EXPECT_TRUE(absl::IsNotFound(uploads_.Hold(ben_, PathOf(bytes)).status()));
}

TEST_F(OwnedUploads, AGreedyAccountEvictsItsOwnFilesAlone) {
  ASSERT_TRUE(Upload(ben_, Surface(0)).ok());
  const std::string unfinished = uploads_.Begin(ben_, "b.obj", 10, "")->id;
  for (int i = 1; i < 40; ++i) ASSERT_TRUE(Upload(anna_, Surface(i)).ok());
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(uploads_.Begin(anna_, "a.obj", 40, "").ok());
  EXPECT_LE(uploads_.List(anna_).size(), 5U);
  EXPECT_THAT(uploads_.List(ben_), SizeIs(1));
  EXPECT_TRUE(uploads_.Add(ben_, unfinished, 0, "v 0 0 0\n").ok());
}

TEST_F(OwnedUploads, ManyAccountsThatFillTheServerEvictNobody) {
  ASSERT_TRUE(Upload(ben_, Surface(0)).ok());
  bool full = false;
  for (int account = 0; account < 40; ++account) {
    const Requester greedy{.owner = absl::StrCat("greedy", account)};
    for (int i = 0; i < 4; ++i) {
      const absl::Status uploaded = Upload(greedy, Surface(10 * account + i + 1));
      full = full || absl::IsResourceExhausted(uploaded);
      EXPECT_TRUE(uploaded.ok() || absl::IsResourceExhausted(uploaded)) << uploaded;
    }
  }
  EXPECT_TRUE(full);
  EXPECT_THAT(uploads_.List(ben_), SizeIs(1));
}

TEST_F(OwnedUploads, AFileThatASessionHoldsOutlivesItsOwnersOthers) {
  const std::string bytes = Surface(0);
  ASSERT_TRUE(Upload(anna_, bytes).ok());
  const auto held = uploads_.Hold(anna_, PathOf(bytes));
  for (int i = 1; i < 20; ++i) ASSERT_TRUE(Upload(anna_, Surface(i)).ok());
  EXPECT_TRUE(absl::IsNotFound(uploads_.Hold(anna_, PathOf(bytes)).status()));
  EXPECT_EQ(*held->Bytes(), bytes);
}

TEST_F(OwnedUploads, AnAdministratorSeesAndDeletesEveryones) {
  ASSERT_TRUE(Upload(anna_, Surface(1), "anna.obj").ok());
  ASSERT_TRUE(Upload(ben_, Surface(1), "ben.obj").ok());
  EXPECT_THAT(uploads_.List(admin_), SizeIs(2));
  ASSERT_TRUE(uploads_.Delete(admin_, PathOf(Surface(1))).ok());
  EXPECT_THAT(uploads_.List(anna_), IsEmpty());
  EXPECT_THAT(uploads_.List(ben_), IsEmpty());
}

}  // namespace
}  // namespace phrenic::session
