// `phrenic doctor`: checks the installation and the server. Each problem has a remedy.
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/reachable.h"
#include "client/terminal/environment.h"
#include "client/terminal/terminal.h"
#include "phrenic/v1/server.grpc.pb.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;

constexpr int kServerSeconds = 3;  // deadline of the call to the server

struct Finding {
  std::string verdict;  // "good", "hint" for something optional that is missing, or "bad"
  std::string what, found, remedy;
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
                      there ? "" : "optional; it holds lines such as server = \"HOST:PORT\""});
}

void CheckViewer(const Context& context, const v1::GetServerResponse& server, Findings& findings) {
  const std::string host = HostOf(context).substr(0, HostOf(context).rfind(':'));
  const std::string address = absl::StrCat(host, ":", server.web_port());
  if (server.web_port() == 0) {
    findings.push_back({"hint", "viewer", "not served", "start the server with --web HOST:PORT"});
  } else if (!IsReachable(address)) {
    findings.push_back({"bad", "viewer", absl::StrCat("no answer at ", address),
                        "start the server with --web 0.0.0.0:PORT, or forward the port and set --viewer URL"});
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
                      equal ? "" : "build both from the same source: deploy/run --build-only"});
  CheckViewer(context, server, findings);
  findings.push_back({server.has_data_folder() ? "good" : "hint", "data folder",
                      server.has_data_folder() ? "set" : "none",
                      server.has_data_folder() ? "" : "for your own surfaces and scenes: phrenicd --data DIR"});
}

// Returns true if the server answers.
bool CheckServer(const Context& context, Findings& findings) {
  const auto stub = v1::ServerService::NewStub(Connect(context));
  v1::GetServerResponse server;
  const grpc::Status status =
      Call(context, *stub, &v1::ServerService::Stub::GetServer, v1::GetServerRequest(), &server, kServerSeconds);
  if (status.ok()) {
    CheckAnswer(context, server, findings);
    return true;
  }
  const bool another = IsReachable(HostOf(context));
  if (status.error_code() == grpc::StatusCode::UNIMPLEMENTED) {
    findings.push_back(
        {"bad", "server", absl::StrCat("older version at ", context.server), "rebuild and restart it: deploy/run"});
  } else if (another) {
    findings.push_back({"bad", "server",
                        absl::StrCat("the program at ", context.server, " is not a gRPC server of Phrenic"),
                        "if it is the viewer's port, use the gRPC port: --server HOST:50051"});
  } else {
    findings.push_back({"bad", "server", absl::StrCat("no answer at ", context.server),
                        "start it with deploy/run or phrenicd, or name another: --server HOST:PORT"});
  }
  return false;
}

std::string FindProgram(const std::vector<std::string>& names) {
  const std::string path = EnvironmentVariable("PATH");
  for (const std::string& name : names) {
    for (const absl::string_view folder : absl::StrSplit(path, ':')) {
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
    const std::string path = FindProgram(program.names);
    findings.push_back({path.empty() ? "hint" : "good", program.what, path.empty() ? "not found" : path,
                        path.empty() ? program.remedy : ""});
  }
}

void CheckGraphics(Findings& findings) {
  std::error_code error;
  const bool gpu = fs::exists("/dev/dri", error);
  findings.push_back({gpu ? "good" : "hint", "graphics", gpu ? "/dev/dri" : "no GPU found",
                      gpu ? ""
                          : "if the viewer stays black: chromium --use-gl=angle --use-angle=swiftshader "
                            "--enable-unsafe-swiftshader"});
  findings.push_back({ShowsUnicode() ? "good" : "hint", "locale", ShowsUnicode() ? "UTF-8" : "not UTF-8",
                      ShowsUnicode() ? "" : "for finer bars in phrenic watch: export LC_ALL=C.UTF-8"});
}

std::string Mark(const std::string& verdict) {
  if (verdict == "good") return Painted("ok", Ink::kGreen, STDOUT_FILENO);
  return verdict == "hint" ? Painted("--", Ink::kYellow, STDOUT_FILENO) : Painted("!!", Ink::kRed, STDOUT_FILENO);
}

void PrintFindings(const Findings& findings) {
  constexpr int kRemedyIndent = 6;
  for (const Finding& finding : findings) {
    std::cout << Mark(finding.verdict) << "  "
              << Wrapped(absl::StrCat(finding.what, ": ", finding.found), WidthOf(STDOUT_FILENO), kRemedyIndent)
              << "\n";
    if (!finding.remedy.empty()) {
      std::cout << std::string(kRemedyIndent, ' ') << Wrapped(finding.remedy, WidthOf(STDOUT_FILENO), kRemedyIndent)
                << "\n";
    }
  }
}

void PrintFindingsJson(const Findings& findings) {
  auto rows = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    rows.push_back(
        {{"verdict", finding.verdict}, {"what", finding.what}, {"found", finding.found}, {"remedy", finding.remedy}});
  }
  std::cout << nlohmann::ordered_json{{"findings", rows}}.dump() << "\n";
}

int Doctor(const Context& context) {
  Findings findings;
  CheckSettings(context, findings);
  const bool answered = CheckServer(context, findings);
  CheckPrograms(findings);
  CheckGraphics(findings);
  if (context.json()) {
    PrintFindingsJson(findings);
  } else {
    PrintFindings(findings);
  }
  if (!answered) return kUnreachable;
  const auto bad = [](const Finding& finding) { return finding.verdict == "bad"; };
  return std::ranges::any_of(findings, bad) ? kFailed : kOk;
}

}  // namespace

CommandFunction SetUpDoctor(CLI::App&) { return Doctor; }

}  // namespace phrenic::client
