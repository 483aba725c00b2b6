#include "client/commands.h"

#include <iostream>

#include "client/argument_kinds.h"
#include "client/command_line.h"
#include "client/comparison.h"
#include "client/manual.h"
#include "client/scene_argument.h"
#include "client/schema_options.h"
#include "phrenic/v1/compare.pb.h"
#include "phrenic/v1/export.pb.h"
#include "server/meshio/meshio.h"
#include "server/schema/fields.h"
#include "server/session/surface_recorder.h"

namespace phrenic::client {
namespace {

// Every command's options live here while the command line is parsed and run.
struct AllOptions {
  SceneOptions describe;
  RunOptions run;
  PhysiologyOptions physiology;
  StudyOptions error, stability, cost, study;
  CompareOptions compare;
  InspectOptions inspect;
  ConvertOptions convert;
  PatientOptions patient;
  PhantomOptions phantom;
  CreateOptions create;
  ForkOptions fork;
  SessionOptions session;
  WatchOptions watch;
  SetOptions set;
  PullOptions pull;
  PlayOptions play;
  StepOptions step;
  TakeControlOptions take_control;
  HandControlOptions hand_control;
  ExportOptions export_motion;
  ExportsOptions exports;
  UploadOptions upload;
  CompletionOptions completion;
};

class Commands {
 public:
  Commands(CLI::App& app, const Context& context, std::function<int()>& chosen)
      : app_(app), context_(context), chosen_(chosen) {
    AddSceneCommands();
    AddStudies();
    AddCompare();
    AddFileCommands();
    AddPatientCommands();
    AddSessionCommands();
    AddChanges();
    AddControl();
    AddExport();
    AddUpload();
    AddItself();
  }

 private:
  template <typename Function, typename Options>
  CLI::App* Add(const char* name, const char* help, Function function, Options& options, CLI::App* to = nullptr) {
    CLI::App* command = (to == nullptr ? &app_ : to)->add_subcommand(name, help);
    command->callback(
        [this, function, &options] { chosen_ = [this, function, &options] { return function(context_, options); }; });
    return command;
  }

  CLI::App* Add(const char* name, const char* help, int (*function)(const Context&), CLI::App* to = nullptr) {
    CLI::App* command = (to == nullptr ? &app_ : to)->add_subcommand(name, help);
    command->callback([this, function] { chosen_ = [this, function] { return function(context_); }; });
    return command;
  }

  static void AddScene(CLI::App* command, SceneOptions& options) {
    command->add_option("SCENE", options.scene, "name of a scene, or a .textproto file")->required();
    command->add_option("--resolution", options.resolution_mm, "edge length of generated bodies [mm]")
        ->check(NumberIn(0.5, 50.0));
  }

  static void AddParameters(CLI::App* command, std::vector<std::string>& settings) {
    command->add_option("--set", settings, "name=value of a live parameter; may be repeated")->allow_extra_args(false);
  }

  static void AddPulls(CLI::App* command, std::vector<std::string>& pulls) {
    command->add_option("--pull", pulls, "force [N] on a vertex, BODY:VERTEX:X,Y,Z; may be repeated")
        ->allow_extra_args(false);
  }

  static void AddPreset(CLI::App* command, std::string& preset) {
    command->add_option("--preset", preset, "one of the scene's ways to breathe, as `phrenic describe` lists them");
  }

  void AddSceneCommands() {
    Add("scenes", "List the scenes that the server knows", &Scenes);
    AddScene(Add("describe", "Show what a scene is made of, what runs, what was left out and why", &Describe,
                 options_.describe),
             options_.describe);
    RunOptions& run = options_.run;
    CLI::App* command = Add("run", "Run a scene here, with no server, and say how fast it was", &Run, run);
    AddScene(command, run.scene);
    AddPreset(command, run.preset);
    AddParameters(command, run.settings);
    AddPulls(command, run.pulls);
    command->add_option("--seconds", run.seconds, "simulated time [s]")
        ->check(NumberIn(1e-6, 3600.0))
        ->capture_default_str();
    command->add_option("--export", run.motion.file, "write the motion to this file" + ExportEndings());
    AddMotion(command, run.motion);
    command->add_option("--spool", run.spool_dir, "folder on a disk with room for what an export holds back");
    command->add_option("--data", run.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
    PhysiologyOptions& physiology = options_.physiology;
    command =
        Add("physiology", "Let a thorax breathe here, and hold it against published ranges", &Physiology, physiology);
    AddScene(command, physiology.scene);
    command->add_option("--data", physiology.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
  }

  void AddStudies() {
    CLI::App* study = app_.add_subcommand("study", "Error against run time, stability and cost of a scene");
    study->require_subcommand(1);
    AddStudy(study, "error", "Every integrator over a ladder of time steps, against an independent reference",
             options_.error, options_.error.request.mutable_error());
    AddStudy(study, "stability", "A map over stiffness and time step, and a suite of extreme cases", options_.stability,
             options_.stability.request.mutable_stability());
    AddStudy(study, "cost", "What each part of a scene costs, and what leaving it out saves", options_.cost,
             options_.cost.request.mutable_cost());
    StudyOptions& options = options_.study;
    Add("list", "List the studies of the server", &ListStudies, study);
    CLI::App* watch = Add("watch", "Wait for a study of the server, and print it", &WatchStudy, options, study);
    watch->add_option("STUDY", options.id)->required();
    AddFindings(watch, options);
    CLI::App* remove = Add("delete", "Cancel and forget a study of the server", &DeleteStudy, options, study);
    remove->add_option("STUDY", options.id)->required();
  }

  void AddStudy(CLI::App* to, const char* name, const char* help, StudyOptions& options,
                google::protobuf::Message* kind) {
    CLI::App* command = Add(name, help, &Study, options, to);
    AddScene(command, options.scene);
    AddPreset(command, *options.request.mutable_preset());
    AddParameters(command, options.settings);
    AddSchemaOptions(command, kind);
    AddFindings(command, options);
    command->add_option("--data", options.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
    command->add_option("--id", *options.request.mutable_study_id(), "its name: 1 to 64 of a-z, 0-9 and -");
    command->add_flag("--detach", options.detach,
                      "run it on the server, and do not wait (with --server alone: and wait)");
  }

  static void AddFindings(CLI::App* command, StudyOptions& options) {
    command->add_option("--page", options.page, "write tables and plots to this .html file");
    command->add_option("--check", options.limits, "limits (.textproto, StudyLimits): 4 is the exit code past one");
  }

  // A number of a message of the schema, with the schema's help and range.
  template <typename Value>
  static void AddNumber(CLI::App* command, const char* flag, Value& value, const google::protobuf::Descriptor& message,
                        const char* field) {
    const v1::Quantity& quantity = *schema::QuantityOf(*message.FindFieldByName(field));
    command->add_option(flag, value, FieldHelp(message, field))
        ->check(NumberIn(quantity.minimum(), quantity.maximum()));
  }

  void AddCompare() {
    CompareOptions& compare = options_.compare;
    CLI::App* command = Add("compare", "Say how far two surfaces, or two motions, are apart", &Compare, compare);
    command
        ->add_option("A", compare.a,
                     "surface (" + meshio::Endings() +
                         "), motion as `phrenic run --export` writes it (.msh), or a session's body as it is now: "
                         "session:ID or session:ID/BODY")
        ->required();
    command->add_option("B", compare.b, "the same; its times are interpolated to A's")->required();
    AddNumber(command, "--tolerance", compare.tolerance_mm, *v1::CompareRequest::descriptor(), "tolerance_mm");
    AddNumber(command, "--spacing", compare.spacing_mm, *v1::CompareRequest::descriptor(), "spacing_mm");
    AddNumber(command, "--unit-a", compare.unit_a_mm, *v1::ComparedSurface::descriptor(), "unit_mm");
    AddNumber(command, "--unit-b", compare.unit_b_mm, *v1::ComparedSurface::descriptor(), "unit_mm");
    AddNumber(command, "--time-a", compare.time_a, *v1::ComparedSurface::descriptor(), "time");
    AddNumber(command, "--time-b", compare.time_b, *v1::ComparedSurface::descriptor(), "time");
    command->add_flag("--regions", compare.by_region, "each named region (body) against that of the same name, too");
    command->add_flag("--phases", compare.match_phases, "stretch B's times to begin and end with A's");
    command->add_option("--map", compare.map_file,
                        "write A coloured by its distance to B (.msh: Gmsh; .vtp: ParaView)");
    command->add_option("--check", compare.checks, "measure=limit,...: exit code 4 where one is missed")
        ->delimiter(',')
        ->allow_extra_args(false);
    command->footer("\n" + MeasureHelp());
  }

  static void AddUnit(CLI::App* command, const char* flag, double& unit_mm, const std::string& whose) {
    command->add_option(flag, unit_mm, "millimetres in one unit of " + whose + " lengths")
        ->check(NumberIn(1e-6, 1e6))
        ->capture_default_str();
  }

  void AddFileCommands() {
    InspectOptions& inspect = options_.inspect;
    CLI::App* command = Add("inspect", "Say what a surface file holds, and whether it will do", &Inspect, inspect);
    command->add_option("FILE", inspect.file, "a surface (" + meshio::Endings() + ")")->required();
    AddUnit(command, "--unit-mm", inspect.unit_mm, "its");
    ConvertOptions& convert = options_.convert;
    command = Add("convert", "Write a surface file in another format", &Convert, convert);
    command->add_option("IN", convert.in, "a surface (" + meshio::Endings() + ")")->required();
    command->add_option("OUT", convert.out, "its ending tells the format (" + meshio::WrittenEndings() + ")")
        ->required();
    AddUnit(command, "--unit-mm", convert.unit_mm, "IN's");
    AddUnit(command, "--out-unit-mm", convert.out_unit_mm, "OUT's");
    command
        ->add_option(
            "--repair", convert.repairs,
            "weld (vertices at one place), slivers (and doubled triangles), fins (pieces that hang on an edge), "
            "orient (neighbours agree, closed parts face outwards), or all; nothing unless asked for")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"weld", "slivers", "fins", "orient", "all"}));
    command->add_option("--within-mm", convert.within_mm, "what is nearer than this is one place, to --repair")
        ->check(NumberIn(0.0, 10.0))
        ->capture_default_str();
  }

  void AddUpload() {
    UploadOptions& upload = options_.upload;
    CLI::App* command = Add("upload", "Give the server a surface file, for scenes of any session", &Upload, upload);
    command->add_option("FILE", upload.file, "a surface (" + meshio::Endings() + ")")->required();
    AddUnit(command, "--unit-mm", upload.unit_mm, "its");
  }

  static void AddLabels(CLI::App* command, std::string& labels) {
    command->add_option("--labels", labels, "what its numbers mean: totalsegmentator, or a file NAME.textproto")
        ->capture_default_str();
  }

  void AddPatientCommands() {
    PatientOptions& patient = options_.patient;
    CLI::App* command = Add("patient", "Make a thorax that breathes of a label volume", &MakePatient, patient);
    command->add_option("VOLUME", patient.volume, "labels as NIfTI (.nii, .nii.gz)")->required();
    AddLabels(command, patient.labels);
    command->add_option("--out", patient.out, "data folder to write surfaces and scene to")->required();
    command->add_option("--name", patient.name, "of the scene: 1 to 64 of a-z, 0-9 and -")->capture_default_str();
    command->add_option("--edge-length", patient.edge_length, "of bones' triangles [mm]; of lungs' half as much again")
        ->check(NumberIn(1.0, 20.0))
        ->capture_default_str();
    command->add_option("--vertices", patient.vertices, "on the diaphragm, about")
        ->check(NumberIn(500, 200000))
        ->capture_default_str();
    command->add_option("--tendon-share", patient.tendon_share, "of the diaphragm's area")
        ->check(NumberIn(0.05, 0.5))
        ->capture_default_str();
    CLI::Option* serve =
        command->add_flag("--serve", patient.serve, "then start phrenicd, which plays it in the viewer");
    command->add_option("--web", patient.web, "HOST:PORT of the viewer")->needs(serve)->capture_default_str();
    AddPhantom();
  }

  void AddPhantom() {
    PhantomOptions& phantom = options_.phantom;
    CLI::App* command = Add("phantom", "Write a label volume of a body whose truth is known", &MakePhantom, phantom);
    command->add_option("--body", phantom.body, "adult, small, tall or flat (its domes)")->capture_default_str();
    AddLabels(command, phantom.labels);
    command->add_option("--out", phantom.out, "file to write, .nii or .nii.gz")->required();
    command->add_option("--voxel", phantom.voxel, "edge length of a voxel [mm]")
        ->check(NumberIn(1.0, 10.0))
        ->capture_default_str();
    command->add_option("--noise", phantom.noise, "share of voxels at borders that have a neighbour's label")
        ->check(NumberIn(0.0, 0.3))
        ->capture_default_str();
    command->add_option("--holes", phantom.holes, "balls of 3 mm without a label")
        ->check(NumberIn(0, 10000))
        ->capture_default_str();
    command->add_option("--seed", phantom.seed, "of noise and holes")->capture_default_str();
  }

  void AddSessionCommands() {
    CreateOptions& create = options_.create;
    CLI::App* command = Add("create", "Create a session", &Create, create);
    AddScene(command, create.scene);
    AddPreset(command, create.preset);
    AddParameters(command, create.settings);
    AddPulls(command, create.pulls);
    command->add_option("--id", create.id, "its name: 1 to 64 of a-z, 0-9 and -");
    command->add_flag("--play", create.play, "let it play at once");
    AddOwner(command, create.mine, create.name);
    ForkOptions& fork = options_.fork;
    command = Add("fork", "Make another session that stands where this one stands", &Fork, fork);
    command->add_option("SESSION", fork.id)->required();
    command->add_option("--id", fork.fork_id, "its name: 1 to 64 of a-z, 0-9 and -");
    command->add_flag("--play", fork.play, "let it play at once");
    AddOwner(command, fork.mine, fork.name);
    Add("sessions", "List the sessions", &Sessions);
    WatchOptions& watch = options_.watch;
    command = Add("watch", "Print a session's numbers as they come", &Watch, watch);
    command->add_option("SESSION", watch.id)->required();
    command->add_option("--seconds", watch.seconds, "stop after this time [s]");
    command->add_option("--count", watch.count, "stop after this many lines");
    command->add_option("--fps", watch.frames_per_second, "lines a second at most")->capture_default_str();
    SetOptions& set = options_.set;
    command = Add("set", "Change live parameters of a session", &Set, set);
    command->add_option("SESSION", set.id)->required();
    command->add_option("SETTING", set.settings, "name=value");
    AddPreset(command, set.preset);
    command->add_option("--at-tick", set.at_tick, "let the change wait until the session stands at this tick");
    command->add_option("--expected-revision", set.expected_revision, "refuse when the session is at another revision");
    AddRequestId(command, set.request_id);
  }

  void AddItself() {
    Add("doctor", "Say whether all is there, and what to type where it is not", &Doctor);
    CompletionOptions& completion = options_.completion;
    Add("completion", "Print what makes a shell complete commands, scenes, sessions and parameters", &PrintCompletion,
        completion)
        ->add_option("SHELL", completion.shell, "bash, zsh or fish")
        ->required();
    app_.add_subcommand("man", "Print the manual page")->callback([this] {
      chosen_ = [this] {
        std::cout << ManualOf(app_);
        return kOk;
      };
    });
  }

  static void AddOwner(CLI::App* command, bool& mine, std::string& name) {
    command->add_flag("--mine", mine, "nobody else may change it, unless you hand control over");
    command->add_option("--name", name, "what others see you as: its owner");
  }

  static void AddRequestId(CLI::App* command, std::string& id) {
    command->add_option("--request-id", id, "a repeat under the same id does nothing more and is answered alike");
  }

  void AddControl() {
    CLI::App* control = app_.add_subcommand("control", "Who may change a session: one at a time, or everybody");
    control->require_subcommand(1);
    const auto add = [this, control](const char* name, const char* help, auto function, auto& options) {
      CLI::App* command = Add(name, help, function, options, control);
      command->add_option("SESSION", options.id)->required();
      return command;
    };
    add("show", "Say who controls it, who is there, and who asks", &ShowControl, options_.session);
    TakeControlOptions& take = options_.take_control;
    CLI::App* command = add("take", "Take control, or ask whoever has it; the owner takes it back", &TakeControl, take);
    command->add_option("--name", take.name, "what others see you as (your login name)");
    command->add_option("--minutes", take.minutes, "how long it stays yours without a command of yours")
        ->check(NumberIn(1.0 / 60, 60.0))
        ->capture_default_str();
    HandControlOptions& hand = options_.hand_control;
    command = add("hand", "Hand control to somebody who is there", &HandControl, hand);
    command->add_option("NAME", hand.name, "as `phrenic control show` lists them")->required();
    add("lend", "Let everybody control it", &LendControl, options_.session);
    add("release", "Give control back, or ask for it no more", &ReleaseControl, options_.session);
  }

  void AddPull() {
    PullOptions& pull = options_.pull;
    CLI::App* command = Add("pull", "Pull a vertex of a session by a force, until it is let go", &PullVertex, pull);
    command->add_option("SESSION", pull.id)->required();
    CLI::Option* body = command->add_option("--body", pull.body, "a deformable body");
    command->add_option("--vertex", pull.vertex, "one of its vertices, from 0")->needs(body);
    command->add_option("--force", pull.force, "X,Y,Z [N]; lets go where it is zero or not given")
        ->delimiter(',')
        ->expected(3)
        ->needs(body);
    command->add_flag("--release", pull.release, "let go of all others");
  }

  void AddChanges() {
    AddPull();
    PlayOptions& play = options_.play;
    CLI::App* command = Add("play", "Let a session play", &Play, play);
    command->add_option("SESSION", play.id)->required();
    command->add_option("--speed", play.speed, "simulated seconds a second")->check(NumberIn(0.01, 100.0));
    command->add_flag("--fast", play.fast, "as fast as the machine can");
    command->add_option("--until", play.until, "pause at this simulated time [s]");
    StepOptions& step = options_.step;
    command = Add("step", "Pause a session and take steps", &TakeSteps, step);
    command->add_option("SESSION", step.id)->required();
    command->add_option("TICKS", step.ticks, "number of steps")->capture_default_str();
    command->add_option("--expected-tick", step.expected_tick, "refuse when the session is at another tick");
    AddRequestId(command, step.request_id);
    AddOnSession("pause", "Pause a session", &Pause);
    AddOnSession("reset", "Take a session back to t = 0", &Reset);
    AddOnSession("delete", "Delete a session", &Delete);
  }

  void AddOnSession(const char* name, const char* help, int (*function)(const Context&, const SessionOptions&)) {
    Add(name, help, function, options_.session)->add_option("SESSION", options_.session.id)->required();
  }

  void AddExport() {
    ExportOptions& options = options_.export_motion;
    CLI::App* command = Add("export", "Run a copy of a session on and write its motion to a file", &Export, options);
    command->add_option("SESSION", options.id)->required();
    command->add_option("FILE", options.motion.file, "its ending tells the format" + ExportEndings())->required();
    command->add_option("--seconds", options.motion.seconds, "simulated time [s] (8; of one instant 0)");
    AddMotion(command, options.motion);
    command->add_flag("--detach", options.detach, "say the export's id, and leave it to the server");
    AddExports();
  }

  void AddExports() {
    ExportsOptions& options = options_.exports;
    CLI::App* exports =
        app_.add_subcommand("exports", "The server's exports: list them, fetch their files, delete them");
    exports->require_subcommand(1);
    Add("list", "List the exports, and how far they are", &ListExports, exports);
    CLI::App* get =
        Add("get", "Wait for an export and download it; goes on with what FILE.part has", &GetExport, options, exports);
    get->add_option("EXPORT", options.id)->required();
    get->add_option("FILE", options.file, "the export's own name in this folder");
    CLI::App* remove = Add("delete", "Cancel and forget an export", &DeleteExport, options, exports);
    remove->add_option("EXPORT", options.id)->required();
  }

  static std::string ExportEndings() {
    std::string names;
    for (const record::Format& format : session::ExportFormats()) {
      names += (names.empty() ? " (." : ", .") + format.name + (format.instant ? "*" : "");
    }
    return names + "; * of one instant)";
  }

  static void AddMotion(CLI::App* command, MotionOptions& motion) {
    const google::protobuf::Descriptor& request = *v1::CreateExportRequest::descriptor();
    command->add_option("--at,--from", motion.start, FieldHelp(request, "start"));
    CLI::Option* rate =
        command->add_option("--fps", motion.frames_per_second, "frames a second in the file (10; .glb: 24 a breath)");
    command->add_option("--every", motion.steps_per_frame, FieldHelp(request, "steps_per_frame"))
        ->check(NumberIn(1, 1'000'000))
        ->excludes(rate);
    command->add_option("--body", motion.bodies, "body or layer; may be repeated (all deformable ones)");
    CLI::Option* positions = command->add_flag("--positions", motion.positions, "where vertices are (.msh, .pvd)");
    command->add_flag("--displacements", motion.displacements, "how far they are from the first frame (.msh, .pvd)")
        ->excludes(positions);
  }

  CLI::App& app_;
  const Context& context_;
  std::function<int()>& chosen_;
  AllOptions options_;
};

}  // namespace

std::shared_ptr<void> AddCommands(CLI::App& app, const Context& context, std::function<int()>& chosen) {
  return std::make_shared<Commands>(app, context, chosen);
}

}  // namespace phrenic::client
