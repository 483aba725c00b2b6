#include "client/cli/scene_argument.h"
#include "client/commands/command_tree.h"
#include "client/print/comparison.h"
#include "phrenic/v1/compare.pb.h"
#include "server/meshio/meshio.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

// Live while the command line is parsed and run.
struct SceneCommandOptions {
  SceneOptions describe;
  RunOptions run;
  ReplayOptions replay;
  PhysiologyOptions physiology;
  StudyOptions error, stability, cost, streaming, study;
  CampaignOptions campaign;
  CompareOptions compare;
  InspectOptions inspect;
  ConvertOptions convert;
  PatientOptions patient;
  PhantomOptions phantom;
  UploadOptions upload;
};

class SceneCommands final : public CommandTree {
 public:
  SceneCommands(CLI::App& app, const Context& context, std::function<int()>& chosen)
      : CommandTree(app, context, chosen) {
    AddScenes();
    AddStudies();
    AddCampaign();
    AddCompare();
    AddFileCommands();
    AddPatientCommands();
    AddUpload();
  }

 private:
  static void AddJUnit(CLI::App* command, std::string& file) {
    command->add_option("--junit", file, "write what was judged to this file, as JUnit XML");
  }

  void AddScenes() {
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
    command->add_option("--threads", run.threads, "that a step of a large scene may have; the motion is the same")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->add_option("--spool", run.spool_dir, "folder on a disk with room for what an export holds back");
    command->add_option("--data", run.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
    command->add_flag("--dry-run", run.dry, "compile the scene and say what would be done; take no step");
    ReplayOptions& replay = options_.replay;
    command = Add("replay", "Run again what was written down, and say whether it is the same", &Replay, replay);
    command->add_option("FILE", replay.file, "what `phrenic run -o json` or `phrenic step -o json` wrote")->required();
    command->add_option("--scene", replay.scene.scene, "a scene's name or .textproto file; the one that FILE names");
    command->add_option("--resolution", replay.scene.resolution_mm, "of generated parts [mm], where it was given")
        ->check(NumberIn(0.5, 50.0));
    command->add_option("--data", replay.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
    PhysiologyOptions& physiology = options_.physiology;
    command =
        Add("physiology", "Let a thorax breathe here, and hold it against published ranges", &Physiology, physiology);
    AddScene(command, physiology.scene);
    command->add_option("--data", physiology.data_dir, "folder of surface files and of scenes/*.textproto")
        ->envname("PHRENIC_DATA");
    command->add_flag("--check", physiology.check, "exit code 4 where a value is outside its range");
    AddJUnit(command, physiology.junit_file);
  }

  void AddStudies() {
    CLI::App* study = app_.add_subcommand("study", "Error against run time, stability, cost and streaming of a scene");
    study->require_subcommand(1);
    AddStudy(study, "error", "Every integrator over a ladder of time steps, against an independent reference",
             options_.error, options_.error.request.mutable_error());
    AddStudy(study, "stability", "A map over stiffness and time step, and a suite of extreme cases", options_.stability,
             options_.stability.request.mutable_stability());
    AddStudy(study, "cost", "What each part of a scene costs, and what leaving it out saves", options_.cost,
             options_.cost.request.mutable_cost());
    AddStudy(study, "streaming", "Error against bandwidth: what a frame takes, by every codec and error bound",
             options_.streaming, options_.streaming.request.mutable_streaming());
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
    AddJUnit(command, options.junit_file);
  }

  void AddCampaign() {
    CLI::App* campaign =
        app_.add_subcommand("campaign", "Many runs: scenes, parameters and meshes in all combinations");
    campaign->require_subcommand(1);
    CampaignOptions& options = options_.campaign;
    CLI::App* run = Add("run", "Compute what is not finished yet, and report", &RunCampaign, options, campaign);
    CLI::App* report = Add("report", "Print what is finished", &ReportCampaign, options, campaign);
    CLI::App* work =
        Add("work", "Compute one share, as `run` has its processes do", &WorkOnCampaign, options, campaign);
    for (CLI::App* command : {run, report, work}) {
      command->add_option("FILE", options.file, "campaign, as text (phrenic/v1/campaign.proto)")->required();
      command->add_option("--out", options.out, "folder of the results, a file a run")->required();
    }
    for (CLI::App* command : {run, work}) {
      command->add_option("--data", options.data_dir, "folder of surface files and of scenes/*.textproto")
          ->envname("PHRENIC_DATA");
    }
    for (CLI::App* command : {run, report}) {
      command->add_option("--page", options.page, "write the table as an HTML page, too");
    }
    run->add_option("--jobs", options.jobs, "processes at once (one a core)")->check(CLI::Range(1, 10'000));
    run->add_option("--on", options.on, "where to: here, slurm")->capture_default_str();
    work->add_option("--share", options.share, "which, of how many: 0/16 to 15/16")->required();
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
    AddJUnit(command, compare.junit_file);
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

  void AddUpload() {
    UploadOptions& upload = options_.upload;
    CLI::App* command = Add("upload", "Give the server a surface file, for scenes of any session", &Upload, upload);
    command->add_option("FILE", upload.file, "a surface (" + meshio::Endings() + ")")->required();
    AddUnit(command, "--unit-mm", upload.unit_mm, "its");
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

  SceneCommandOptions options_;
};

}  // namespace

std::shared_ptr<void> AddSceneCommands(CLI::App& app, const Context& context, std::function<int()>& chosen) {
  return std::make_shared<SceneCommands>(app, context, chosen);
}

}  // namespace phrenic::client
