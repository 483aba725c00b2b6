#include "client/cli/guide.h"

#include <algorithm>

namespace phrenic::client {
namespace {

constexpr char kScenes[] = "Scenes, with no server", kSessions[] = "Sessions of a server", kStudies[] = "Studies",
               kFiles[] = "Files", kItself[] = "The command line itself";

std::vector<CommandGuide> ScenesGuides() {
  return {
      {"run",
       kScenes,
       {{"phrenic run thorax --seconds 8", "a breath or two, and how fast it went"},
        {"phrenic run thorax --preset deep --export out.msh", "the motion, for Gmsh"},
        {"phrenic run my.textproto --set breath_force=1.5 --set integrator=bdf2", "a scene of your own"},
        {"phrenic run cube-tensegrity --seconds 1 -o json", "for a harness"},
        {"phrenic run thorax --seconds 60 --export out.msh --dry-run", "what it would do"}}},
      {"replay",
       kScenes,
       {{"phrenic run cube-tensegrity --seconds 1 -o json > run.json", "what came of a run"},
        {"phrenic replay run.json", "again: the same to the last bit, or exit code 4"}}},
      {"physiology",
       kScenes,
       {{"phrenic physiology thorax", "four breaths against published ranges"},
        {"phrenic physiology thorax --resolution 8 -o json", "coarser and faster, for a harness"},
        {"phrenic physiology thorax --check --junit breaths.xml", "for CI: exit code 4 outside a range"}}},
      {"patient",
       kScenes,
       {{"phrenic patient labels.nii.gz --out data --name anna", "surfaces, a scene, and what had to be guessed"},
        {"phrenic patient labels.nii.gz --out data --name anna --serve", "and then breathing in the viewer"}}},
      {"phantom", kScenes, {{"phrenic phantom --body tall --out tall.nii.gz", "a volume to try `phrenic patient` on"}}},
  };
}

std::vector<CommandGuide> SessionGuides() {
  return {
      {"scenes",
       kSessions,
       {{"phrenic scenes", "names and titles"}, {"phrenic scenes -o jsonl", "one a line, for scripts"}}},
      {"describe",
       kSessions,
       {{"phrenic describe thorax", "bodies, what runs, largest stable step, parameters"},
        {"phrenic describe my.textproto --resolution 8", "a scene of your own, coarser"}}},
      {"create",
       kSessions,
       {{"phrenic create thorax --play", "a session called thorax, and the viewer's link"},
        {"phrenic create thorax --id class --preset deep --set breath_length=5", ""}}},
      {"fork", kSessions, {{"phrenic fork class --id mine --play", "to try something else from the present instant"}}},
      {"sessions",
       kSessions,
       {{"phrenic sessions", "what runs, how far, who watches"}, {"phrenic sessions -o csv", "for a spreadsheet"}}},
      {"watch",
       kSessions,
       {{"phrenic watch class", "live bars and the last breaths, in a terminal"},
        {"phrenic watch class --count 100 -o csv > breath.csv", "SI units, a line a frame"},
        {"phrenic watch class -o jsonl --seconds 10", "one event a line, for a harness"}}},
      {"set",
       kSessions,
       {{"phrenic set class breath_force=2 apply_links=off", ""},
        {"phrenic set class --preset chest", "one of the scene's ways to breathe"}}},
      {"pull",
       kSessions,
       {{"phrenic pull class --body diaphragm --vertex 812 --force 0,0,1", "newtons"},
        {"phrenic pull class --release", ""}}},
      {"play",
       kSessions,
       {{"phrenic play class --speed 0.5", "half as fast as life"},
        {"phrenic play class --fast --until 60", "as fast as the machine can, to t = 60 s"},
        {"phrenic play class --in-step-with other", "two in lock-step, where each names the other"}}},
      {"step", kSessions, {{"phrenic step class 100 --expected-tick 0 -o json", "with the state's hash"}}},
      {"pause", kSessions, {{"phrenic pause class", ""}}},
      {"reset", kSessions, {{"phrenic reset class", "back to t = 0; parameters stay"}}},
      {"delete", kSessions, {{"phrenic delete class", ""}}},
  };
}

std::vector<CommandGuide> TogetherGuides() {
  return {
      {"control",
       kSessions,
       {{"phrenic control show class", "who controls it, who is there, who asks"},
        {"phrenic control take class --name Ada", "or ask whoever has it"}}},
      {"control show", "", {{"phrenic control show class", ""}}},
      {"control take", "", {{"phrenic control take class --name Ada --minutes 30", "or ask whoever has it"}}},
      {"control hand", "", {{"phrenic control hand class Grace", "to somebody who is there"}}},
      {"control lend", "", {{"phrenic control lend class", "to everybody"}}},
      {"control release", "", {{"phrenic control release class", ""}}},
      {"link", kSessions, {{"phrenic link create class", "prints an address to send to whom you want to watch"}}},
      {"link create", "", {{"phrenic link create class --role controller --hours 2", "for whom may change it, too"}}},
      {"link list", "", {{"phrenic link list class", ""}}},
      {"link revoke", "", {{"phrenic link revoke class 1f0c9a77", "who watches by it is sent away"}}},
      {"export",
       kSessions,
       {{"phrenic export class motion.pvd --seconds 4 --fps 25", "for ParaView"},
        {"phrenic export class now.stl", "the present instant"},
        {"phrenic export class motion.msh --seconds 60 --detach", "and fetch it later: phrenic exports get"}}},
      {"exports",
       kSessions,
       {{"phrenic exports list", ""}, {"phrenic exports get class motion.msh", "goes on where it broke off"}}},
      {"exports list", "", {{"phrenic exports list", "how far each is"}}},
      {"exports get", "", {{"phrenic exports get class motion.msh", "goes on with what motion.msh.part has"}}},
      {"exports delete", "", {{"phrenic exports delete class", ""}}},
      {"upload", kSessions, {{"phrenic upload lung.stl", "prints upload:SHA256, which scenes may name"}}},
  };
}

std::vector<CommandGuide> StudyGuides() {
  return {
      {"study",
       kStudies,
       {{"phrenic study error cube-tensegrity --page error.html", "which integrator, at what step"},
        {"phrenic study stability sheet-2d", ""},
        {"phrenic study cost thorax -o csv", "what each part costs"}}},
      {"study error",
       "",
       {{"phrenic study error cube-tensegrity --page error.html", "tables here, plots in the page"},
        {"phrenic study error thorax --server 127.0.0.1:50051 --detach", "it goes on without you"}}},
      {"study stability", "", {{"phrenic study stability sheet-2d --check limits.textproto", "exit code 4 past one"}}},
      {"study cost", "", {{"phrenic study cost thorax -o csv", ""}}},
      {"study list", "", {{"phrenic study list", ""}}},
      {"study watch", "", {{"phrenic study watch thorax-error", "waits for it, and prints it"}}},
      {"campaign",
       kStudies,
       {{"phrenic campaign run sweep.textproto --out results --page results.html", "goes on where it was stopped"},
        {"phrenic campaign run sweep.textproto --out results --on slurm --jobs 200", "the same, as an array of jobs"}}},
      {"campaign run",
       "",
       {{"phrenic campaign run sweep.textproto --out results", "exit code 4 where a limit is passed"},
        {"phrenic campaign run sweep.textproto --out results -o csv > table.csv", ""}}},
      {"campaign report", "", {{"phrenic campaign report sweep.textproto --out results --page results.html", ""}}},
      {"campaign work", "", {{"phrenic campaign work sweep.textproto --out results --share 0/16", "on any machine"}}},
      {"study delete", "", {{"phrenic study delete thorax-error", ""}}},
  };
}

std::vector<CommandGuide> FileGuides() {
  return {
      {"compare",
       kFiles,
       {{"phrenic compare a.msh b.msh --regions --check hd95_max=2,assd=1", "exit code 4 past a limit"},
        {"phrenic compare session:class/diaphragm lung.stl", "a session's body as it is now"},
        {"phrenic compare a.obj b.obj -o csv --map map.vtp", "and A coloured by distance"}}},
      {"inspect",
       kFiles,
       {{"phrenic inspect lung.stl", "is it whole, in which unit, what to repair"},
        {"phrenic inspect lung.ply --unit-mm 10 -o json", ""}}},
      {"convert",
       kFiles,
       {{"phrenic convert lung.obj lung.msh", ""},
        {"phrenic convert lung.obj whole.obj --repair all", "what inspect says should be repaired"},
        {"phrenic convert lung.ply lung.stl --unit-mm 10 --out-unit-mm 1", "centimetres to millimetres"}}},
      {"doctor", kItself, {{"phrenic doctor", "is all there; if not, what to type"}}},
      {"completion",
       kItself,
       {{"source <(phrenic completion bash)", "in ~/.bashrc; zsh: in ~/.zshrc, after compinit"},
        {"phrenic completion fish > ~/.config/fish/completions/phrenic.fish", ""}}},
      {"man",
       kItself,
       {{"phrenic man | man -l -", "read it"}, {"phrenic man > ~/.local/share/man/man1/phrenic.1", "install it"}}},
  };
}

const std::vector<CommandGuide>& All() {
  static const std::vector<CommandGuide> guides = [] {
    std::vector<CommandGuide> all;
    for (const auto& part : {ScenesGuides(), SessionGuides(), TogetherGuides(), StudyGuides(), FileGuides()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return guides;
}

constexpr Example kFirst[] = {
    {"phrenic run thorax --seconds 8", "simulate here; no server needed"},
    {"phrenic create thorax --play", "a session on the server; prints the viewer's link"},
    {"phrenic watch thorax", "its breath, live in the terminal"},
    {"phrenic set thorax breath_force=2", "change it while it runs"},
    {"phrenic export thorax out.pvd --seconds 4", "take the motion home"},
    {"phrenic doctor", "is all there; if not, what to type"},
};

constexpr Named kExitCodes[] = {
    {"0", "done"},
    {"1", "failed"},
    {"2", "the command line is wrong"},
    {"3", "no server"},
    {"4", "a limit of --check is missed"},
    {"5", "not allowed: somebody else controls the session, or the account may not"},
    {"130", "interrupted"},
};

constexpr Named kVariables[] = {
    {"PHRENIC_SERVER", "HOST:PORT of the server, as --server"},
    {"PHRENIC_TLS_CA", "as --tls-ca"},
    {"PHRENIC_TLS_CERT", "as --tls-cert"},
    {"PHRENIC_TLS_KEY", "as --tls-key"},
    {"PHRENIC_TOKEN_FILE", "as --token-file"},
    {"PHRENIC_TOKEN", "the token itself"},
    {"PHRENIC_JOIN", "what follows #join= in a link to a session"},
    {"PHRENIC_OUTPUT", "as --output"},
    {"PHRENIC_VIEWER", "as --viewer"},
    {"PHRENIC_DATA", "as --data"},
    {"PHRENIC_CONFIG", "another settings file"},
    {"NO_COLOR", "set to anything: no colours"},
    {"XDG_CONFIG_HOME", "folder of settings (~/.config)"},
};

struct Synonym {
  std::string_view word;
  const char* command;
};
constexpr Synonym kSynonyms[] = {
    {"ls", "sessions"},       {"list", "sessions"},      {"ps", "sessions"},
    {"start", "play"},        {"resume", "play"},        {"stop", "pause"},
    {"rm", "delete"},         {"remove", "delete"},      {"kill", "delete"},
    {"new", "create"},        {"open", "create"},        {"add", "create"},
    {"info", "describe"},     {"show", "describe"},      {"view", "watch"},
    {"follow", "watch"},      {"get", "exports get"},    {"download", "exports get"},
    {"save", "export"},       {"status", "doctor"},      {"check", "doctor"},
    {"version", "--version"}, {"diff", "compare"},       {"distance", "compare"},
    {"clone", "fork"},        {"copy", "fork"},          {"simulate", "run"},
    {"parameters", "set"},    {"breathe", "physiology"}, {"completions", "completion"},
};

}  // namespace

std::span<const CommandGuide> Guides() { return All(); }

const CommandGuide* GuideOf(std::string_view command) {
  const auto found = std::ranges::find(All(), command, &CommandGuide::command);
  return found == All().end() ? nullptr : &*found;
}

std::span<const Example> FirstExamples() { return kFirst; }
std::span<const Named> ExitCodes() { return kExitCodes; }
std::span<const Named> EnvironmentVariables() { return kVariables; }

std::string SettingsText() {
  return "A setting comes from the command line, else from the environment, else from the settings file, else it is "
         "the "
         "default; `phrenic doctor` shows which. The file is $XDG_CONFIG_HOME/phrenic/config.toml: options by their "
         "names, those of one command below its name in brackets.";
}

std::string CommandMeantBy(std::string_view word) {
  const auto found = std::ranges::find(kSynonyms, word, &Synonym::word);
  return found == std::end(kSynonyms) ? "" : found->command;
}

}  // namespace phrenic::client
