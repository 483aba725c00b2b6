#include "client/files/junit.h"

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "client/files/whole_file.h"

namespace phrenic::client {

absl::Status WriteJUnit(const std::string& file, const std::string& suite, const std::vector<CheckResult>& checks) {
  const auto count = [&checks](auto fits) {
    return static_cast<int>(std::count_if(checks.begin(), checks.end(), fits));
  };
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites").append_child("testsuite");
  root.append_attribute("name") = suite.c_str();
  root.append_attribute("tests") = static_cast<int>(checks.size());
  root.append_attribute("failures") = count([](const CheckResult& each) { return !each.failure.empty(); });
  root.append_attribute("skipped") = count([](const CheckResult& each) { return each.skipped; });
  for (const CheckResult& each : checks) {
    pugi::xml_node test_case = root.append_child("testcase");
    test_case.append_attribute("classname") = suite.c_str();
    test_case.append_attribute("name") = each.name.c_str();
    if (each.skipped) test_case.append_child("skipped");
    if (!each.failure.empty()) test_case.append_child("failure").append_attribute("message") = each.failure.c_str();
  }
  std::stringstream text;
  document.save(text, "  ");
  return WriteWhole(file, text.str());
}

}  // namespace phrenic::client
