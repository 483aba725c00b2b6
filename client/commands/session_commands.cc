#include <iostream>
#include <set>

#include "client/cli/command_line.h"
#include "client/cli/manual.h"
#include "client/commands/command_tree.h"
#include "phrenic/v1/frames.pb.h"
#include "server/stream/codec.h"

namespace phrenic::client {
namespace {

// Live while the command line is parsed and run.
struct SessionCommandOptions {
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
  LinkOptions link;
  ExportOptions export_motion;
  ExportsOptions exports;
  CompletionOptions completion;
};

class SessionCommands final : public CommandTree {
 public:
  SessionCommands(CLI::App& app, const Context& context, std::function<int()>& chosen)
      : CommandTree(app, context, chosen) {
    AddSessions();
    AddChanges();
    AddControl();
    AddLinks();
    AddExport();
    AddItself();
  }

 private:
  static void AddOwner(CLI::App* command, bool& mine, std::string& name) {
    command->add_flag("--mine", mine, "nobody else may change it, unless you hand control over");
    command->add_option("--name", name, "what others see you as: its owner");
  }

  static void AddRequestId(CLI::App* command, std::string& id) {
    command->add_option("--request-id", id, "a repeat under the same id does nothing more and is answered alike");
  }

  void AddSessions() {
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
    std::set<std::string> codecs;
    for (const stream::CodecRow& row : stream::Codecs()) codecs.emplace(row.name);
    command->add_option("--codec", watch.codec, "also take the vertices in this form, and say what a frame takes")
        ->check(CLI::IsMember(codecs));
    AddNumber(command, "--bound", watch.bound_mm, *v1::WatchFramesRequest::descriptor(), "max_error_mm");
    SetOptions& set = options_.set;
    command = Add("set", "Change live parameters of a session", &Set, set);
    command->add_option("SESSION", set.id)->required();
    command->add_option("SETTING", set.settings, "name=value");
    AddPreset(command, set.preset);
    command->add_option("--at-tick", set.at_tick, "let the change wait until the session stands at this tick");
    command->add_option("--expected-revision", set.expected_revision, "refuse when the session is at another revision");
    AddRequestId(command, set.request_id);
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
    command->add_option("--in-step-with", play.in_step_with, "wait where it gets a frame ahead of this session");
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

  void AddLinks() {
    CLI::App* link = app_.add_subcommand("link", "Let others into a session of yours, on a server with accounts");
    link->require_subcommand(1);
    LinkOptions& options = options_.link;
    CLI::App* create = Add("create", "Print a link that lets whoever has it in", &CreateLink, options, link);
    create->add_option("SESSION", options.id)->required();
    create->add_option("--role", options.role, "viewer, or controller")->capture_default_str();
    create->add_option("--hours", options.hours, "how long it is good for")
        ->check(NumberIn(0.001, 8760.0))
        ->capture_default_str();
    Add("list", "List the session's links", &ListLinks, options, link)->add_option("SESSION", options.id)->required();
    CLI::App* revoke = Add("revoke", "End a link, and send away who watches by it", &RevokeLink, options, link);
    revoke->add_option("SESSION", options.id)->required();
    revoke->add_option("LINK", options.link, "as `phrenic link list` lists them")->required();
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

  SessionCommandOptions options_;
};

}  // namespace

std::shared_ptr<void> AddSessionCommands(CLI::App& app, const Context& context, std::function<int()>& chosen) {
  return std::make_shared<SessionCommands>(app, context, chosen);
}

}  // namespace phrenic::client
