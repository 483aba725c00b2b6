// Motion files, read back by small independent parsers, by Gmsh and by VTK.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "absl/strings/str_format.h"
#include "server/record/msh.h"
#include "server/record/recorder.h"
#include "server/record/vertex_spool.h"

namespace phrenic::record {
namespace {

constexpr int kFrames = 5;

std::vector<RecordedBody> TwoBodies() {
  Mesh sheet;
  sheet.vertices.resize(3, 4);
  sheet.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0.1, 0.1, 0.1, 0.1;
  sheet.triangles.resize(3, 2);
  sheet.triangles << 0, 0, 1, 2, 2, 3;
  Mesh wire;
  wire.vertices.resize(3, 2);
  wire.vertices << 2, 3, 0, 0, 0, 0.5;
  wire.edges.resize(2, 1);
  wire.edges << 0, 1;
  return {{"sheet", sheet}, {"wire", wire}};
}

Points PositionsAt(int frame) {
  const std::vector<RecordedBody> bodies = TwoBodies();
  Points all(3, 6);
  all << bodies[0].mesh.vertices, bodies[1].mesh.vertices;
  if (frame > 0) all.array() += 1e-3 * frame * frame / 3.0;
  return all;
}

absl::Status NoReport(double) { return absl::OkStatus(); }

// Records a motion of kFrames frames and keeps the bytes.
struct Recorded {
  explicit Recorded(const std::string& format, std::optional<Values> values = {}) {
    const Format row = *FindFormat(Formats(), format);
    Settings settings = {.sink = [this](std::string_view bytes) {
      file.append(bytes);
      return absl::OkStatus();
    }};
    settings.values = values.value_or(row.values.empty() ? Values::kPositions : row.values.front());
    settings.spool_folder = testing::TempDir();
    const auto recorder = row.make(settings);
    EXPECT_TRUE(recorder->Begin(recording).ok());
    for (int f = 0; f < kFrames; ++f) {
      EXPECT_TRUE(recorder->AddFrame({0.25 * f, PositionsAt(f), {1.5 * f}}).ok());
    }
    EXPECT_TRUE(recorder->End(NoReport).ok());
  }

  const Recording recording = {.bodies = TwoBodies(), .columns = {{"volume, \"right\"", "l"}}};
  std::string file;
};

std::string Record(const std::string& format) { return Recorded(format).file; }

TEST(Formats, UnknownNamesListTheKnownOnes) {
  const auto format = FindFormat(Formats(), "avi");
  ASSERT_FALSE(format.ok());
  EXPECT_THAT(std::string(format.status().message()),
              testing::AllOf(testing::HasSubstr("avi"), testing::HasSubstr("msh, depl, pvd, glb, csv")));
}

TEST(Formats, ASinksErrorEndsTheRecording) {
  for (const Format& format : Formats()) {
    const auto full = [](std::string_view) { return absl::ResourceExhaustedError("disk full"); };
    const auto recorder = format.make({.sink = full, .spool_folder = testing::TempDir()});
    absl::Status status = recorder->Begin({.bodies = TwoBodies()});
    if (status.ok()) status = recorder->AddFrame({0, PositionsAt(0), {}});
    if (status.ok()) status = recorder->End(NoReport);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << format.name;
  }
}

TEST(Formats, AMissingSpoolFolderIsNamed) {
  const auto recorder = FindFormat(Formats(), "depl")->make({.sink = {}, .spool_folder = "/nowhere/spool"});
  const absl::Status status = recorder->Begin({.bodies = TwoBodies()});
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("/nowhere/spool"));
}

TEST(SpoolFile, TooLittleSpaceIsReportedWithFolderAndSizes) {
  EXPECT_TRUE(CheckRoom(testing::TempDir(), 1).ok());
  const absl::Status status = CheckRoom(testing::TempDir(), std::int64_t{1} << 60);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(status.message()),
              testing::AllOf(testing::HasSubstr("1152921504606.8 MB are needed"),
                             testing::HasSubstr(testing::TempDir()), testing::HasSubstr("MB are free")));
}

TEST(VertexSpool, TransposesForEveryBufferSize) {
  constexpr int kVertices = 7, kRows = 23;
  for (const std::size_t buffer : {1, 200, 500, 1000, 100'000}) {
    auto spool = VertexSpool::Open(testing::TempDir(), kVertices, buffer);
    ASSERT_TRUE(spool.ok()) << spool.status();
    const auto value = [](int vertex, int frame, int axis) { return 1000 * vertex + 10 * frame + axis; };
    for (int frame = 0; frame < kRows; ++frame) {
      VertexSpool::Rows rows(3, kVertices);
      for (int i = 0; i < 3 * kVertices; ++i) rows(i % 3, i / 3) = value(i / 3, frame, i % 3);
      ASSERT_TRUE((*spool)->Add(rows).ok());
    }
    int vertex = 0;
    const absl::Status all = (*spool)->ForEachVertex([&](const VertexSpool::Rows& rows) {
      EXPECT_EQ(rows.cols(), kRows);
      for (int i = 0; i < 3 * kRows; ++i) EXPECT_EQ(rows(i % 3, i / 3), value(vertex, i / 3, i % 3)) << buffer;
      ++vertex;
      return absl::OkStatus();
    });
    EXPECT_TRUE(all.ok()) << all;
    EXPECT_EQ(vertex, kVertices);
  }
}

// Returns the peak resident memory of a process that spools so many frames and reads them back [kB].
long PeakWith(int frames) {
  constexpr int kVertices = 1000;
  const pid_t child = fork();
  if (child == 0) {
    auto spool = VertexSpool::Open(testing::TempDir(), kVertices, std::size_t{1} << 20);
    const VertexSpool::Rows rows = VertexSpool::Rows::Ones(3, kVertices);
    std::int64_t sum = 0;
    for (int f = 0; f < frames; ++f) (void)(*spool)->Add(rows);
    const absl::Status all = (*spool)->ForEachVertex([&](const VertexSpool::Rows& path) {
      sum += path.sum();
      return absl::OkStatus();
    });
    _exit(all.ok() && sum == std::int64_t{3} * kVertices * frames ? 0 : 1);
  }
  int status = 0;
  struct rusage usage {};
  wait4(child, &status, 0, &usage);
  EXPECT_EQ(status, 0);
  return usage.ru_maxrss;
}

TEST(VertexSpool, MemoryDoesNotGrowWithTheNumberOfFrames) {
  EXPECT_LT(PeakWith(2000), PeakWith(50) + 8'000) << "48 MB of positions against 1 MB";
}

TEST(Depl, RunningSumIsThePositionToTheLastDecimal) {
  std::istringstream file(Record("depl"));
  std::string kind;
  int vertices = 0, shapes = 0, rows = 0;
  file >> kind >> vertices >> shapes >> rows;
  EXPECT_EQ(kind, "TRIANGLES");
  EXPECT_EQ(vertices, 6);
  EXPECT_EQ(shapes, 2);
  ASSERT_EQ(rows, kFrames);
  for (int i = 0; i < vertices; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int f = 0; f < rows; ++f) {
      Eigen::Vector3d change;
      file >> change.x() >> change.y() >> change.z();
      sum += change;
      const Eigen::Vector3d exact = 1e3 * PositionsAt(f).col(i);
      EXPECT_LT((sum - exact).cwiseAbs().maxCoeff(), 0.5000001e-6) << "vertex " << i << " frame " << f;
    }
  }
  EXPECT_TRUE(static_cast<bool>(file));
  file >> kind;
  EXPECT_TRUE(file.eof()) << "nothing follows the last row";
}

TEST(Msh, NodeDataIsTheDisplacementFromTheFirstFrame) {
  std::istringstream file(Record("msh"));
  std::string line;
  int frame = 0;
  while (std::getline(file, line)) {
    if (line != "$NodeData") continue;
    std::string name;
    int count = 0, step = 0, components = 0, nodes = 0;
    double time = 0;
    file >> count >> name >> count >> time >> count >> step >> components >> nodes;
    EXPECT_EQ(name, "\"displacement\"");
    EXPECT_EQ(step, frame);
    EXPECT_DOUBLE_EQ(time, 0.25 * frame);
    ASSERT_EQ(nodes, 6);
    for (int i = 0; i < nodes; ++i) {
      int number = 0;
      Eigen::Vector3d u;
      file >> number >> u.x() >> u.y() >> u.z();
      EXPECT_EQ(number, i + 1);
      EXPECT_LT((u - 1e3 * (PositionsAt(frame) - PositionsAt(0)).col(i)).norm(), 1e-5);
    }
    ++frame;
  }
  EXPECT_EQ(frame, kFrames);
}

TEST(Msh, EveryBodyIsAPhysicalGroup) {
  EXPECT_THAT(Record("msh"), testing::HasSubstr("$PhysicalNames\n2\n2 1 \"sheet\"\n1 2 \"wire\"\n$EndPhysicalNames\n"));
}

TEST(Msh, NamesCannotBreakTheFile) {
  std::string file;
  const auto recorder = MakeMshRecorder({.sink = [&file](std::string_view bytes) {
    file.append(bytes);
    return absl::OkStatus();
  }});
  std::vector<RecordedBody> bodies = TwoBodies();
  bodies[0].name = "a\"b\n$Nodes";
  ASSERT_TRUE(recorder->Begin({.bodies = bodies}).ok());
  EXPECT_THAT(file, testing::HasSubstr("2 1 \"a_b_$Nodes\"\n"));
}

TEST(Msh, PositionsAreDisplacementsFromZero) {
  const std::string file = Recorded("msh", Values::kPositions).file;
  EXPECT_THAT(file, testing::HasSubstr("\"position\"\n1\n0\n3\n0\n3\n6\n1 0 0 100\n2 1000 0 100\n"));
  EXPECT_THAT(file, testing::Not(testing::HasSubstr("displacement")));
}

TEST(Csv, HasOneRowPerFrameAndQuotesNames) {
  EXPECT_EQ(Record("csv"), "time [s],\"volume, \"\"right\"\" [l]\"\n0,0\n0.25,1.5\n0.5,3\n0.75,4.5\n1,6\n");
}

TEST(Msh, OpensInGmshWithAllSteps) {
  if (std::system("command -v gmsh >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
  const std::string base = testing::TempDir() + "phrenic_record_" + std::to_string(getpid());
  std::ofstream(base + ".msh") << Record("msh");
  std::ofstream(base + ".geo") << "Merge \"" << base << ".msh\";\n"
                               << "Printf(\"views %g\", PostProcessing.NbViews);\n"
                               << "Printf(\"steps %g\", View[0].NbTimeStep);\n"
                               << "Printf(\"nodes %g\", Mesh.NbNodes);\n"
                               << "Printf(\"triangles %g\", Mesh.NbTriangles);\n";
  const std::string log = base + ".log";
  ASSERT_EQ(std::system(("gmsh -parse_and_exit " + base + ".geo >" + log + " 2>&1").c_str()), 0);
  std::ifstream file(log);
  const std::string said((std::istreambuf_iterator<char>(file)), {});
  EXPECT_THAT(said, testing::HasSubstr("views 1"));
  EXPECT_THAT(said, testing::HasSubstr("steps 5"));
  EXPECT_THAT(said, testing::HasSubstr("nodes 6"));
  EXPECT_THAT(said, testing::HasSubstr("triangles 2"));
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("Error")));
}

// Reads every .vtp of a .pvd archive by VTK and prints time, points, cells, displacement, frame and body names.
constexpr char kReadPvd[] = R"(
import sys, zipfile, os, vtk
import xml.etree.ElementTree as xml
folder = sys.argv[1] + '.d'
zipfile.ZipFile(sys.argv[1]).extractall(folder)
for step in xml.parse(folder + '/' + sys.argv[2] + '.pvd').getroot().iter('DataSet'):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(folder + '/' + step.get('file'))
    reader.Update()
    data = reader.GetOutput()
    moved = data.GetPointData().GetArray('displacement [mm]')
    names = data.GetFieldData().GetAbstractArray('body names')
    print(step.get('timestep'), data.GetNumberOfPoints(), data.GetNumberOfPolys(), data.GetNumberOfLines(),
          '%.9g' % data.GetPoint(1)[0], '%.9g' % moved.GetTuple(1)[0], data.GetFieldData().GetAbstractArray('SPACE').GetValue(0),
          [names.GetValue(int(data.GetCellData().GetArray('body').GetTuple1(c))) for c in range(data.GetNumberOfCells())])
)";

TEST(Pvd, OpensInVtkWithAllTimesPositionsAndBodies) {
  const std::string python = "/usr/bin/python3";  // Debian's Python, for which its VTK package is built
  if (std::system((python + " -c 'import vtk' >/dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  }
  const std::string base = testing::TempDir() + "phrenic_pvd_" + std::to_string(getpid());
  std::ofstream(base + ".py") << kReadPvd;
  for (const Values values : {Values::kPositions, Values::kDisplacements}) {
    std::ofstream(base + ".zip", std::ios::binary) << Recorded("pvd", values).file;
    const std::string command = python + " " + base + ".py " + base + ".zip motion >" + base + ".out 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::ifstream said(base + ".out");
    std::string line;
    for (int f = 0; f < kFrames; ++f) {
      ASSERT_TRUE(std::getline(said, line)) << f;
      const double moved = 1e3 * (PositionsAt(f)(0, 1) - PositionsAt(0)(0, 1));
      const double x = values == Values::kPositions ? 1e3 * PositionsAt(f)(0, 1) : 1000;
      EXPECT_EQ(line, absl::StrFormat("%.9g 6 2 1 %.9g %.9g LPS ['wire', 'sheet', 'sheet']", 0.25 * f, x, moved));
    }
    EXPECT_FALSE(std::getline(said, line)) << line;
  }
}

}  // namespace
}  // namespace phrenic::record
