// The commands: what the words after `phrenic` mean. Harnesses script these names; they are a contract.
#ifndef PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
#define PHRENIC_CLIENT_COMMANDS_COMMANDS_H_

#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/files/motion_file.h"
#include "phrenic/v1/study.pb.h"

namespace phrenic::client {

struct SceneOptions {
  std::string scene;
  double resolution_mm = 0;  // 0: the scene's own
};
struct RunOptions {
  SceneOptions scene;
  double seconds = 8;
  std::string preset;
  std::vector<std::string> settings;
  std::vector<std::string> pulls;   // "diaphragm:812:0,0,1"
  MotionOptions motion;             // of no file: none
  std::string data_dir, spool_dir;  // spool: empty for the usual one
  int threads = 1;
  bool dry = false;  // compile, and say what would run
};
struct CampaignOptions {
  std::string file;  // Campaign, as text
  std::string out;   // folder of results
  int jobs = 0;      // processes at once; 0: one a core
  std::string on = "here";
  std::string share;  // of a worker
  std::string page, data_dir;
};
struct ReplayOptions {
  std::string file;
  SceneOptions scene;  // empty: the one that the file names
  std::string data_dir;
};
struct PhysiologyOptions {
  SceneOptions scene;
  std::string data_dir;
  bool check = false;
  std::string junit_file;  // empty: none, here and below
};
struct StudyOptions {
  SceneOptions scene;
  std::vector<std::string> settings;
  v1::CreateStudyRequest request;  // the kind and its options; the rest is filled in from the above
  std::string id;
  std::string page, limits, junit_file;
  std::string data_dir;
  bool detach = false;  // on the server, without waiting
};
struct CompareOptions {
  std::string a, b;                      // files, or "session:ID/BODY"
  std::optional<double> time_a, time_b;  // [s]
  double unit_a_mm = 0, unit_b_mm = 0;   // 0: the schema's own, here and below
  double tolerance_mm = 0;
  double spacing_mm = 0;
  bool by_region = false;
  bool match_phases = false;
  std::string map_file;  // empty: none
  std::vector<std::string> checks;
  std::string junit_file;
};
struct InspectOptions {
  std::string file;
  double unit_mm = 1;  // in one unit of the file's lengths
};
struct ConvertOptions {
  std::string in, out;
  std::vector<std::string> repairs;     // in the order of Repairs() in convert.cc
  double within_mm = 1e-3;              // what is nearer is at one place
  double unit_mm = 1, out_unit_mm = 1;  // in one unit of IN's, and of OUT's lengths
};
struct PatientOptions {
  std::string volume, labels = "totalsegmentator";
  std::string out, name = "patient";
  double edge_length = 4;  // [mm]
  int vertices = 20000;
  double tendon_share = 0.22;
  bool serve = false;
  std::string web = "127.0.0.1:8080";
};
struct PhantomOptions {
  std::string body = "adult", labels = "totalsegmentator", out;
  double voxel = 2, noise = 0.02;
  int holes = 40;
  unsigned seed = 1;
};
struct CreateOptions {
  SceneOptions scene;
  std::string id;
  std::string preset;
  std::vector<std::string> settings;
  std::vector<std::string> pulls;
  bool play = false;
  bool mine = false;  // nobody else controls it
  std::string name;   // the owner's
};
struct SessionOptions {
  std::string id;
};
struct ForkOptions {
  std::string id;
  std::string fork_id;  // empty: the server chooses
  bool play = false;
  bool mine = false;
  std::string name;
};
struct WatchOptions {
  std::string id;
  double seconds = 0;  // 0: until interrupted
  int count = 0;       // 0: any number
  double frames_per_second = 5;
  std::string codec;    // of vertices that come with the numbers; empty: none come
  double bound_mm = 0;  // of it; 0: the server's own
};
struct SetOptions {
  std::string id;
  std::string preset;
  std::vector<std::string> settings;
  long at_tick = -1;            // -1: at once
  long expected_revision = -1;  // -1: any
  std::string request_id;
};
struct TakeControlOptions {
  std::string id, name;
  double minutes = 10;
};
struct HandControlOptions {
  std::string id, name;
};
struct LinkOptions {
  std::string id, link, role = "viewer";
  double hours = 168;
};
struct PullOptions {
  std::string id;
  std::string body;  // empty: none
  int vertex = 0;
  std::vector<double> force = {0, 0, 0};  // [N]; zero lets go
  bool release = false;
};
struct PlayOptions {
  std::string id;
  double speed = 0;  // 0: as it was
  bool fast = false;
  double until = 0;  // 0: for ever
  std::string in_step_with;
};
struct StepOptions {
  std::string id;
  long ticks = 1;
  long expected_tick = -1;  // -1: any
  std::string request_id;
};
struct ExportOptions {
  std::string id;
  MotionOptions motion;
  bool detach = false;  // the export's id, and no waiting
};
struct ExportsOptions {
  std::string id, file;
};
struct CompletionOptions {
  std::string shell;
};
struct UploadOptions {
  std::string file;
  double unit_mm = 1;  // in one unit of the file's lengths
};

// One command a file in commands/. Each gives the exit code.
int Scenes(const Context& context);
int Describe(const Context& context, const SceneOptions& options);
int Run(const Context& context, const RunOptions& options);
int RunCampaign(const Context& context, const CampaignOptions& options);
int WorkOnCampaign(const Context& context, const CampaignOptions& options);
int ReportCampaign(const Context& context, const CampaignOptions& options);
int Replay(const Context& context, const ReplayOptions& options);
int Physiology(const Context& context, const PhysiologyOptions& options);
int Study(const Context& context, const StudyOptions& options);
int ListStudies(const Context& context);
int WatchStudy(const Context& context, const StudyOptions& options);
int DeleteStudy(const Context& context, const StudyOptions& options);
int Compare(const Context& context, const CompareOptions& options);
int Inspect(const Context& context, const InspectOptions& options);
int Convert(const Context& context, const ConvertOptions& options);
int MakePatient(const Context& context, const PatientOptions& options);
int MakePhantom(const Context& context, const PhantomOptions& options);
int Create(const Context& context, const CreateOptions& options);
int Fork(const Context& context, const ForkOptions& options);
int Sessions(const Context& context);
int Watch(const Context& context, const WatchOptions& options);
int Set(const Context& context, const SetOptions& options);
int PullVertex(const Context& context, const PullOptions& options);
int Play(const Context& context, const PlayOptions& options);
int Pause(const Context& context, const SessionOptions& options);
int TakeSteps(const Context& context, const StepOptions& options);
int Reset(const Context& context, const SessionOptions& options);
int Delete(const Context& context, const SessionOptions& options);
int ShowControl(const Context& context, const SessionOptions& options);
int TakeControl(const Context& context, const TakeControlOptions& options);
int HandControl(const Context& context, const HandControlOptions& options);
int LendControl(const Context& context, const SessionOptions& options);
int ReleaseControl(const Context& context, const SessionOptions& options);
int CreateLink(const Context& context, const LinkOptions& options);
int ListLinks(const Context& context, const LinkOptions& options);
int RevokeLink(const Context& context, const LinkOptions& options);
int Export(const Context& context, const ExportOptions& options);
int ListExports(const Context& context);
int GetExport(const Context& context, const ExportsOptions& options);
int DeleteExport(const Context& context, const ExportsOptions& options);
int Upload(const Context& context, const UploadOptions& options);
int Doctor(const Context& context);
int PrintCompletion(const Context& context, const CompletionOptions& options);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
