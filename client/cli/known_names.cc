#include "client/cli/known_names.h"

#include <algorithm>
#include <chrono>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/connection/connection.h"
#include "client/terminal/environment.h"
#include "phrenic/v1/export.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/schema/fields.h"
#include "server/schema/places.h"
#include "server/session/scene_catalogue.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using Words = std::vector<std::string>;

constexpr std::chrono::milliseconds kServerDeadline(400);

// Makes one call. Returns an empty response if the server does not answer in time.
template <typename Service, typename Response, typename Method, typename Request>
Response Ask(const std::shared_ptr<grpc::Channel>& channel, Method method, const Request& request) {
  grpc::ClientContext call;
  call.set_deadline(std::chrono::system_clock::now() + kServerDeadline);
  Response response;
  const auto stub = Service::NewStub(channel);
  if (!(stub.get()->*method)(&call, request, &response).ok()) response.Clear();
  return response;
}

// The names that the server knows.
class NameServer {
 public:
  explicit NameServer(const std::string& address) {
    Context context;
    context.server = address;
    channel_ = Connect(context);
  }

  std::vector<v1::SceneSummary> Scenes() const {
    const auto all = Ask<v1::SceneService, v1::ListScenesResponse>(channel_, &v1::SceneService::Stub::ListScenes,
                                                                   v1::ListScenesRequest());
    if (all.scenes_size() == 0) return session::SceneCatalogue({Installed("scenes", PHRENIC_SCENES_DIR)}).List();
    return {all.scenes().begin(), all.scenes().end()};
  }
  v1::ListSessionsResponse Sessions() const {
    return Ask<v1::SessionService, v1::ListSessionsResponse>(channel_, &v1::SessionService::Stub::ListSessions,
                                                             v1::ListSessionsRequest());
  }
  v1::ListExportsResponse Exports() const {
    return Ask<v1::ExportService, v1::ListExportsResponse>(channel_, &v1::ExportService::Stub::ListExports,
                                                           v1::ListExportsRequest());
  }
  v1::ListStudiesResponse Studies() const {
    return Ask<v1::StudyService, v1::ListStudiesResponse>(channel_, &v1::StudyService::Stub::ListStudies,
                                                          v1::ListStudiesRequest());
  }

 private:
  std::shared_ptr<grpc::Channel> channel_;
};

// Returns the value of "--server X" or "--server=X", or the setting's value.
std::string AddressIn(const CLI::App& app, const Words& typed) {
  for (size_t i = 0; i < typed.size(); ++i) {
    if (typed[i] == "--server" && i + 1 < typed.size()) return typed[i + 1];
    if (absl::StartsWith(typed[i], "--server=")) return typed[i].substr(typed[i].find('=') + 1);
  }
  const std::string variable = EnvironmentVariable("PHRENIC_SERVER");
  return !variable.empty() ? variable : app.get_option("--server")->get_default_str();
}

std::vector<Candidate> ChoicesOf(const FieldDescriptor& field) {
  std::vector<Candidate> choices;
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
    for (const char* word : {"on", "off"}) choices.push_back({absl::StrCat(field.name(), "=", word), ""});
  }
  if (field.cpp_type() != FieldDescriptor::CPPTYPE_ENUM) return choices;
  for (const std::string& name : schema::ChoiceNameList(*field.enum_type())) {
    choices.push_back({absl::StrCat(field.name(), "=", name), ""});
  }
  return choices;
}

// Returns "breath_force=" and the like, or the values if `last` has an equals sign.
std::vector<Candidate> SettingsFor(const google::protobuf::Descriptor& type, const std::string& last) {
  std::vector<Candidate> settings;
  if (const size_t equals = last.find('='); equals != std::string::npos) {
    const FieldDescriptor* field = type.FindFieldByName(last.substr(0, equals));
    return field == nullptr ? settings : ChoicesOf(*field);
  }
  for (int f = 0; f < type.field_count(); ++f) {
    const v1::Quantity* quantity = schema::QuantityOf(*type.field(f));
    settings.push_back(
        {absl::StrCat(type.field(f)->name(), "="), quantity == nullptr ? "" : schema::FormatRange(*quantity)});
  }
  return settings;
}

// Returns the presets of the scenes named on the line, directly or by a session that runs them.
std::vector<Candidate> PresetsFor(const NameServer& server, const Words& typed) {
  Words named = typed;
  const v1::ListSessionsResponse sessions = server.Sessions();
  for (const v1::Session& session : sessions.sessions()) {
    if (std::ranges::find(typed, session.id()) != typed.end()) named.push_back(session.scene());
  }
  std::vector<Candidate> presets;
  for (const v1::SceneSummary& scene : server.Scenes()) {
    if (std::ranges::find(named, scene.name()) == named.end()) continue;
    for (const std::string& preset : scene.presets()) presets.push_back({preset, scene.title()});
  }
  return presets;
}

std::vector<Candidate> ScenesOf(const NameServer& server) {
  std::vector<Candidate> names;
  for (const v1::SceneSummary& scene : server.Scenes()) names.push_back({scene.name(), scene.title()});
  return names;
}

std::vector<Candidate> SessionsOf(const v1::ListSessionsResponse& all) {
  std::vector<Candidate> names;
  for (const v1::Session& one : all.sessions()) names.push_back({one.id(), one.scene_title()});
  return names;
}

std::vector<Candidate> ExportsOf(const v1::ListExportsResponse& all) {
  std::vector<Candidate> names;
  for (const v1::Export& one : all.exports()) names.push_back({one.id(), one.file_name()});
  return names;
}

std::vector<Candidate> StudiesOf(const v1::ListStudiesResponse& all) {
  std::vector<Candidate> names;
  for (const v1::Study& one : all.studies()) names.push_back({one.id(), one.scene()});
  return names;
}

std::vector<Candidate> NamesOfKind(Kind kind, const NameServer& server, const Words& typed) {
  switch (kind) {
    case Kind::kScene:
      return ScenesOf(server);
    case Kind::kSession:
      return SessionsOf(server.Sessions());
    case Kind::kExport:
      return ExportsOf(server.Exports());
    case Kind::kStudy:
      return StudiesOf(server.Studies());
    case Kind::kPreset:
      return PresetsFor(server, typed);
    case Kind::kSetting:
      return SettingsFor(*v1::Parameters::descriptor(), typed.back());
    case Kind::kPhysique:
      return SettingsFor(*v1::Physique::descriptor(), typed.back());
    default:
      return {};
  }
}

}  // namespace

Lookup KnownNames(const CLI::App& app) {
  return [&app](Kind kind, const Words& typed) { return NamesOfKind(kind, NameServer(AddressIn(app, typed)), typed); };
}

}  // namespace phrenic::client
