#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string Readme() {
  std::stringstream text;
  text << std::ifstream(PHRENIC_SOURCE_DIR "/server/README.md").rdbuf();
  return text.str();
}

Faults FaultsOf(const std::string& path, const std::string& text) {
  return IncludeFaults(DirectionsOf(Readme()), path, text);
}

Faults Including(const std::string& path, const std::string& header) {
  return FaultsOf(path, "// A file.\n#include <vector>\n#include \"" + header + "\"\n");
}

TEST(Repository, KeepsEveryRule) { EXPECT_THAT(AllFaults(PHRENIC_SOURCE_DIR), IsEmpty()); }

TEST(Includes, FollowTheDirections) {
  EXPECT_THAT(Including("server/mesh/mesh.cc", "server/mesh/mesh.h"), IsEmpty());
  EXPECT_THAT(Including("server/mechanics/step.cc", "server/mesh/mesh.h"), IsEmpty());
  EXPECT_THAT(Including("server/mechanics/forces/springs.cc", "server/mechanics/force.h"), IsEmpty());
  EXPECT_THAT(Including("server/stream/frame.cc", "server/mechanics/model.h"), IsEmpty());
  EXPECT_THAT(Including("server/session/session.cc", "server/stream/frame.h"), IsEmpty());
  EXPECT_THAT(Including("server/main.cc", "server/daemon/serve.h"), IsEmpty());
  EXPECT_THAT(Including("client/main.cc", "server/service/serve.h"), IsEmpty());
  EXPECT_THAT(Including("tests/mesh/mesh_test.cc", "client/main.h"), IsEmpty());
}

TEST(Includes, AgainstADirectionAreFaults) {
  EXPECT_THAT(Including("server/mesh/mesh.cc", "server/mechanics/model.h"),
              ElementsAre("server/mesh/mesh.cc:3: mesh/ may not include server/mechanics/model.h"));
  EXPECT_THAT(Including("server/schema/schema.h", "server/mesh/mesh.h"), Not(IsEmpty()));
  EXPECT_THAT(Including("server/mechanics/model.h", "server/session/session.h"), Not(IsEmpty()));
  EXPECT_THAT(Including("server/session/session.h", "server/service/serve.h"), Not(IsEmpty()));
  EXPECT_THAT(Including("server/session/session.h", "server/study/error.h"), Not(IsEmpty()));
  EXPECT_THAT(Including("server/service/serve.h", "client/connection.h"), Not(IsEmpty()));
  EXPECT_THAT(Including("server/mesh/mesh.h", "tests/mesh/solids.h"), Not(IsEmpty()));
}

TEST(Includes, OfTheFiveDomainsAreIndependent) {
  const char* five[] = {"meshio", "anatomy", "mechanics", "stream", "record"};
  for (const std::string from : five) {
    for (const std::string to : five) {
      const bool allowed = from == to || (from == "stream" && to == "mechanics");
      const Faults faults = Including("server/" + from + "/x.cc", "server/" + to + "/y.h");
      EXPECT_EQ(faults.empty(), allowed) << from << " includes " << to;
    }
  }
}

TEST(Includes, OfGrpcAreOnlyAtTheEdge) {
  for (const std::string header : {"grpcpp/grpcpp.h", "grpc/grpc.h", "phrenic/v1/session.grpc.pb.h"}) {
    const std::string line = "#include <" + header + ">\n";
    EXPECT_THAT(FaultsOf("server/session/session.cc", line), ElementsAre(HasSubstr("include gRPC")));
    EXPECT_THAT(FaultsOf("server/service/x.cc", line), IsEmpty());
    EXPECT_THAT(FaultsOf("server/main.cc", line), IsEmpty());
    EXPECT_THAT(FaultsOf("client/connection.cc", line), IsEmpty());
  }
}

TEST(Includes, OfTheCoreAreOfFourLibraries) {
  for (const std::string header : {"boost/asio/post.hpp", "openssl/evp.h", "zlib.h", "nanoflann.hpp"}) {
    const std::string line = "#include <" + header + ">\n";
    for (const std::string folder : {"schema", "mesh", "mechanics"}) {
      EXPECT_THAT(FaultsOf("server/" + folder + "/x.cc", line), ElementsAre(HasSubstr("the core needs no libraries")));
    }
    EXPECT_THAT(FaultsOf("server/service/x.cc", line), IsEmpty());
  }
  for (const std::string header :
       {"vector", "sys/mman.h", "Eigen/Core", "hwy/highway.h", "google/protobuf/message.h"}) {
    EXPECT_THAT(FaultsOf("server/mesh/x.cc", "#include <" + header + ">\n"), IsEmpty());
  }
}

TEST(Directions, AreReadFromATable) {
  const Directions read = DirectionsOf(
      "# Map\n\n| folder | what is in it | may include |\n|--|--|--|\n"
      "| [`mesh/`](mesh/README.md) | `nearest` points | `schema` |\n"
      "| `main.cc` | starts | `mesh`, `schema` |\n\n| `other/` | x | `y` |\n");
  EXPECT_EQ(read, (Directions{{"mesh", {"schema"}}, {"main", {"mesh", "schema"}}}));
}

TEST(Directions, ThemselvesFormNoCycle) {
  const Directions directions = DirectionsOf(Readme());
  EXPECT_GE(directions.size(), 20U);
  Texts texts;
  for (const auto& [folder, allowed] : directions) {
    std::string& text = texts["server/" + folder + "/x.h"];
    for (const std::string& to : allowed) text += "#include \"server/" + to + "/x.h\"\n";
  }
  EXPECT_THAT(CycleFaults(texts), IsEmpty());
}

TEST(Cycles, BetweenFilesAreFaults) {
  EXPECT_THAT(CycleFaults({{"server/a/x.cc", "#include \"server/a/y.h\"\n"},
                           {"server/a/x.h", ""},
                           {"server/a/y.h", "#include \"server/a/x.h\"\n"}}),
              ElementsAre(HasSubstr("server/a/x -> server/a/y -> server/a/x")));
  EXPECT_THAT(CycleFaults({{"server/a/x.cc", "#include \"server/a/x.h\"\n#include \"server/a/y.h\"\n"},
                           {"server/a/x.h", ""},
                           {"server/a/y.h", ""}}),
              IsEmpty());
}

TEST(Cycles, BetweenFoldersAreFaults) {
  EXPECT_THAT(CycleFaults({{"server/a/x.h", "#include \"server/a/b/y.h\"\n"},
                           {"server/a/b/y.h", ""},
                           {"server/a/b/z.h", "#include \"server/a/w.h\"\n"},
                           {"server/a/w.h", ""}}),
              ElementsAre(HasSubstr("between folders: server/a -> server/a/b -> server/a")));
}

TEST(Folders, HaveAtMostThirtyUnits) {
  std::vector<std::string> paths;
  for (size_t i = 0; i < kLargestFolder; ++i) {
    paths.push_back("server/a/x" + std::to_string(i) + ".cc");
    paths.push_back("server/a/x" + std::to_string(i) + ".h");
  }
  EXPECT_THAT(FolderSizeFaults(paths), IsEmpty());
  paths.emplace_back("server/a/one_more.h");
  EXPECT_THAT(FolderSizeFaults(paths), ElementsAre(StartsWith("server/a: 31 units")));
}

TEST(Includes, AreNamedFromTheRoot) {
  EXPECT_THAT(Including("server/mesh/mesh.cc", "mesh.h"), ElementsAre(HasSubstr("path from the repository's root")));
}

TEST(Includes, OfAnUnknownFolderAreAFault) {
  EXPECT_THAT(Including("server/physics/x.cc", "server/mesh/mesh.h"), ElementsAre(HasSubstr("has no row")));
}

TEST(Imports, OfThreeAreOnlyInTheViewer) {
  const std::string text = "// A file.\nimport { Mesh } from \"three\";\n";
  EXPECT_THAT(ImportFaults("web/src/viewer/rig.ts", text), IsEmpty());
  EXPECT_THAT(ImportFaults("web/src/panels/dom.ts", text), ElementsAre(StartsWith("web/src/panels/dom.ts:2: ")));
  for (const char* line : {"import * as T from 'three/addons/x.js';", "import type { A,\n B } from \"three\";",
                           "const t = await import(\"three\");", "import \"three\";"}) {
    EXPECT_THAT(ImportFaults("web/src/app.ts", line), Not(IsEmpty())) << line;
  }
  EXPECT_THAT(ImportFaults("web/src/app.ts", "import { three } from \"./threefold\";"), IsEmpty());
}

TEST(Lengths, OfFilesAreCapped) {
  EXPECT_THAT(LengthFaults("a.cc", std::string(kLongestFile, '\n')), IsEmpty());
  EXPECT_THAT(LengthFaults("a.cc", std::string(kLongestFile + 1, '\n')), ElementsAre(StartsWith("a.cc: 501 lines")));
}

std::string FunctionOf(int lines) { return "int F(int x) {\n" + std::string(lines - 2, '\n') + "}\n"; }

TEST(Lengths, OfFunctionsAreCapped) {
  EXPECT_THAT(FunctionFaults("a.cc", FunctionOf(kLongestFunction)), IsEmpty());
  EXPECT_THAT(FunctionFaults("a.cc", "// Two.\n\n" + FunctionOf(kLongestFunction + 1)),
              ElementsAre(StartsWith("a.cc:3: a function of 61 lines")));
}

TEST(Functions, AreFoundInNamespacesAndClasses) {
  const std::vector<Function> found = FunctionsOf(R"text(
#define OPEN(x) \
  if (x) {
namespace a::b {
// Not a function {
class C : public D<int> {
 public:
  int Get() const { return x_; }
  template <typename T>
  void Set(T t) {
    if (t) { x_ = t; }
  }
 private:
  int x_{3};
};
enum class E { kA, kB };
constexpr int kTable[] = {
  1,
};
const char* kText = "} {" R"(})";
C::C(int x)
    : x_{x},
      y_(2) {
  Go([&] { return '}' + 1'000; });
}
}  // namespace a::b
TEST(X, Y) {}
)text");
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].line, 8);
  EXPECT_EQ(found[0].lines, 1);
  EXPECT_EQ(found[1].line, 9);
  EXPECT_EQ(found[1].lines, 4);
  EXPECT_EQ(found[2].line, 21);
  EXPECT_EQ(found[2].lines, 5);
  EXPECT_EQ(found[3].line, 27);
}

// A tree on disk that breaks the rules one after the other.
class Tree : public testing::Test {
 protected:
  void SetUp() override {
    root_ = std::filesystem::path(testing::TempDir()) / ("phrenic_architecture_" + std::to_string(getpid()));
    std::filesystem::remove_all(root_);
    Write("CMakeLists.txt", "");
    Write("server/README.md",
          "| folder | what is in it | may include |\n|--|--|--|\n| `mesh/` | x | - |\n| `session/` | x | `mesh` |\n");
    Write("server/mesh/mesh.cc", "#include \"server/mesh/mesh.h\"\n");
    Write(".clang-format", "");
    Write("build/utils/made.cc", std::string(9999, '\n'));
  }
  void TearDown() override { std::filesystem::remove_all(root_); }
  void Write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::filesystem::path root_;
};

TEST_F(Tree, InOrderHasNoFaults) { EXPECT_THAT(AllFaults(root_), IsEmpty()); }

TEST_F(Tree, HoldsNothingElseAtTheTop) {
  Write("scripts/run", "");
  EXPECT_THAT(AllFaults(root_), ElementsAre(StartsWith("scripts: does not belong")));
}

TEST_F(Tree, CallsFoldersByWhatIsInThem) {
  Write("server/mesh/utils/x.cc", "");
  EXPECT_THAT(AllFaults(root_), ElementsAre(StartsWith("server/mesh/utils: ")));
}

TEST_F(Tree, IsReadFileByFile) {
  Write("server/mesh/long.cc", FunctionOf(70) + std::string(450, '\n'));
  Write("server/mesh/up.h", "#include \"server/session/session.h\"\n");
  Write("web/src/app.ts", "import \"three\";\n");
  Write("deploy/run", std::string(501, '\n'));
  EXPECT_EQ(AllFaults(root_).size(), 5U);
}

}  // namespace
}  // namespace phrenic::architecture
