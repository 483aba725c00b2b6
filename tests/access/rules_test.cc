#include "server/access/rules.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace phrenic::access {
namespace {

// Returns "SessionService.GetSession" and so on for every method in the proto files.
std::set<std::string> MethodsOfProtos() {
  std::set<std::string> methods;
  for (const auto& entry : std::filesystem::directory_iterator(PHRENIC_SOURCE_DIR "/proto/phrenic/v1")) {
    std::ifstream in(entry.path());
    std::string service;
    for (std::string line; std::getline(in, line);) {
      std::smatch found;
      if (std::regex_search(line, found, std::regex("^service (\\w+)"))) service = found[1];
      if (std::regex_search(line, found, std::regex("^  rpc (\\w+)\\((stream )?(\\w+)\\)"))) {
        methods.insert(service + "." + found[1].str());
        EXPECT_EQ(found[3].str(), found[1].str() + "Request") << "a rule is found by the request";
      }
    }
  }
  return methods;
}

TEST(Rules, EveryMethodHasOneAndNoOtherHas) {
  std::set<std::string> ruled;
  for (const Rule& rule : Rules()) EXPECT_TRUE(ruled.insert(std::string(rule.method)).second) << rule.method;
  EXPECT_EQ(ruled, MethodsOfProtos());
}

TEST(Rules, AreFoundByTheRequestType) {
  ASSERT_NE(RuleOf("phrenic.v1.DeleteSessionRequest"), nullptr);
  EXPECT_EQ(RuleOf("phrenic.v1.DeleteSessionRequest")->method, "SessionService.DeleteSession");
  EXPECT_EQ(RuleOf("phrenic.v1.NonsenseRequest"), nullptr);
}

TEST(Rules, MethodsThatChangeASessionRequireAController) {
  for (const Rule& rule : Rules()) {
    if (!rule.changes || rule.in_session == v1::ACCESS_ROLE_UNSPECIFIED) continue;
    const bool makes_another = rule.method == "SessionService.ForkSession";
    EXPECT_GE(makes_another ? rule.role : rule.in_session, v1::ACCESS_ROLE_CONTROLLER) << rule.method;
  }
}

TEST(Rules, RoleNamesRoundTrip) {
  for (const auto role :
       {v1::ACCESS_ROLE_VIEWER, v1::ACCESS_ROLE_CONTROLLER, v1::ACCESS_ROLE_OWNER, v1::ACCESS_ROLE_ADMIN}) {
    EXPECT_EQ(RoleOf(NameOf(role)), role);
  }
  EXPECT_EQ(RoleOf("king"), v1::ACCESS_ROLE_UNSPECIFIED);
  EXPECT_EQ(RoleOf(""), v1::ACCESS_ROLE_UNSPECIFIED);
}

}  // namespace
}  // namespace phrenic::access
