// `phrenic doctor`: whether all is there; each line that is not well has its remedy.
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/commands/commands.h"
#include "client/connection/reachable.h"
#include "client/terminal/terminal.h"
#include "phrenic/v1/server.grpc.pb.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;

constexpr int kPatienceSeconds = 3;

// "good", "hint": goes without, and "bad".
struct Finding {
  std::string verdict, what, found, remedy;
};
using Findings = std::vector<Finding>;

void CheckSettings(const Context& context, Findings& findings) {
  for (const settings::Setting& setting : context.settings) {
    findings.push_back({"good", "setting " + setting.name,
                        absl::StrCat(setting.value.empty() ? "none" : setting.value, ", by ", setting.origin), ""});
  }
  const std::string& file = context.settings_file;
  std::error_code error;
  const bool there = fs::exists(file, error);
  findings.push_back({there ? "good" : "hint", "settings file", there ? file : absl::StrCat("none at ", file),
                      there ? "" : "only if you want one: a line such as server = \"HOST:PORT\""});
}

void CheckViewer(const Context& context, const v1::GetServerResponse& server, Findings& findings) {
  const std::string host = HostOf(context).substr(0, HostOf(context).rfind(':'));
  const std::string address = absl::StrCat(host, ":", server.web_port());
  if (server.web_port() == 0) {
    findings.push_back({"hint", "viewer", "not served", "start the server with --web HOST:PORT"});
  } else if (!IsReachable(address)) {
    findings.push_back({"bad", "viewer", absl::StrCat("nobody answers at ", address),
                        "start the server with --web 0.0.0.0:PORT, or forward the port; --viewer URL where it is"});
  } else if (!server.viewer_is_built()) {
    findings.push_back({"bad", "viewer", "not built", "deploy/run --build-only, or npm run build in web/"});
  } else {
    findings.push_back({"good", "viewer", absl::StrCat(server.encrypted() ? "https://" : "http://", address, "/"), ""});
  }
}

void CheckAnswer(const Context& context, const v1::GetServerResponse& server, Findings& findings) {
  findings.push_back({"good", "server", absl::StrCat("answers at ", context.server), ""});
  const bool equal = server.version() == PHRENIC_VERSION;
  findings.push_back({equal ? "good" : "bad", "versions",
                      equal ? absl::StrCat("both ", PHRENIC_VERSION)
                            : absl::StrCat("server ", server.version(), ", command line ", PHRENIC_VERSION),
                      equal ? "" : "build both from one source: deploy/run --build-only"});
  CheckViewer(context, server, findings);
  findings.push_back({server.has_data_folder() ? "good" : "hint", "data folder",
                      server.has_data_folder() ? "the server has one" : "none",
                      server.has_data_folder() ? "" : "for surfaces and scenes of your own: phrenicd --data DIR"});
}

// True where the server answers.
bool CheckServer(const Context& context, Findings& findings) {
  const auto stub = v1::ServerService::NewStub(Connect(context));
  v1::GetServerResponse server;
  const grpc::Status status =
      Call(context, *stub, &v1::ServerService::Stub::GetServer, v1::GetServerRequest(), &server, kPatienceSeconds);
  if (status.ok()) {
    CheckAnswer(context, server, findings);
    return true;
  }
  const bool another = IsReachable(HostOf(context));
  if (status.error_code() == grpc::StatusCode::UNIMPLEMENTED) {
    findings.push_back(
        {"bad", "server", absl::StrCat("an older one at ", context.server), "build and start it anew: deploy/run"});
  } else if (another) {
    findings.push_back({"bad", "server",
                        absl::StrCat("what listens at ", context.server, " is no gRPC server of Phrenic"),
                        "is it the viewer's port? name that of gRPC: --server HOST:50051"});
  } else {
    findings.push_back({"bad", "server", absl::StrCat("nobody listens at ", context.server),
                        "start it: deploy/run, or phrenicd; or name another: --server HOST:PORT"});
  }
  return false;
}

std::string FindProgram(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    for (const absl::string_view folder : absl::StrSplit(path == nullptr ? "" : path, ':')) {
      if (::access(absl::StrCat(folder, "/", name).c_str(), X_OK) == 0) return absl::StrCat(folder, "/", name);
    }
  }
  return "";
}

void CheckPrograms(Findings& findings) {
  const struct {
    const char* what;
    std::vector<std::string> names;
    const char* remedy;
  } programs[] = {
      {"Gmsh", {"gmsh"}, "opens .msh: apt install gmsh"},
      {"ParaView", {"paraview"}, "opens .pvd and .vtp: apt install paraview"},
      {"browser", {"chromium", "google-chrome", "firefox", "firefox-esr"}, "for the viewer: apt install chromium"},
  };
  for (const auto& program : programs) {
    const std::string place = FindProgram(program.names);
    findings.push_back({place.empty() ? "hint" : "good", program.what, place.empty() ? "not found" : place,
                        place.empty() ? program.remedy : ""});
  }
}

void CheckGraphics(Findings& findings) {
  std::error_code error;
  const bool gpu = fs::exists("/dev/dri", error);
  findings.push_back({gpu ? "good" : "hint", "graphics", gpu ? "/dev/dri" : "no GPU seen",
                      gpu ? ""
                          : "if the viewer stays black: chromium --use-gl=angle --use-angle=swiftshader "
                            "--enable-unsafe-swiftshader"});
  findings.push_back({ShowsUnicode() ? "good" : "hint", "locale", ShowsUnicode() ? "UTF-8" : "not UTF-8",
                      ShowsUnicode() ? "" : "finer bars in phrenic watch: export LC_ALL=C.UTF-8"});
}

std::string Sign(const std::string& verdict) {
  if (verdict == "good") return Painted("ok", Ink::kGreen, STDOUT_FILENO);
  return verdict == "hint" ? Painted("--", Ink::kYellow, STDOUT_FILENO) : Painted("!!", Ink::kRed, STDOUT_FILENO);
}

void Print(const Findings& findings) {
  constexpr int kRemedyAt = 6;
  for (const Finding& finding : findings) {
    std::cout << Sign(finding.verdict) << "  "
              << Wrapped(absl::StrCat(finding.what, ": ", finding.found), WidthOf(STDOUT_FILENO), kRemedyAt) << "\n";
    if (!finding.remedy.empty()) {
      std::cout << std::string(kRemedyAt, ' ') << Wrapped(finding.remedy, WidthOf(STDOUT_FILENO), kRemedyAt) << "\n";
    }
  }
}

void PrintJson(const Findings& findings) {
  auto rows = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    rows.push_back(
        {{"verdict", finding.verdict}, {"what", finding.what}, {"found", finding.found}, {"remedy", finding.remedy}});
  }
  std::cout << nlohmann::ordered_json{{"findings", rows}}.dump() << "\n";
}

}  // namespace

int Doctor(const Context& context) {
  Findings findings;
  CheckSettings(context, findings);
  const bool answered = CheckServer(context, findings);
  CheckPrograms(findings);
  CheckGraphics(findings);
  if (context.json()) {
    PrintJson(findings);
  } else {
    Print(findings);
  }
  if (!answered) return kUnreachable;
  const auto bad = [](const Finding& finding) { return finding.verdict == "bad"; };
  return std::ranges::any_of(findings, bad) ? kFailed : kOk;
}

}  // namespace phrenic::client
