#include "client/print/junit.h"

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "client/files/whole_file.h"

namespace phrenic::client {

absl::Status WriteJUnit(const std::string& file, const std::string& suite, const std::vector<JudgedCase>& cases) {
  const auto count = [&cases](auto fits) { return static_cast<int>(std::count_if(cases.begin(), cases.end(), fits)); };
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites").append_child("testsuite");
  root.append_attribute("name") = suite.c_str();
  root.append_attribute("tests") = static_cast<int>(cases.size());
  root.append_attribute("failures") = count([](const JudgedCase& each) { return !each.failure.empty(); });
  root.append_attribute("skipped") = count([](const JudgedCase& each) { return each.skipped; });
  for (const JudgedCase& each : cases) {
    pugi::xml_node judged = root.append_child("testcase");
    judged.append_attribute("classname") = suite.c_str();
    judged.append_attribute("name") = each.name.c_str();
    if (each.skipped) judged.append_child("skipped");
    if (!each.failure.empty()) judged.append_child("failure").append_attribute("message") = each.failure.c_str();
  }
  std::stringstream text;
  document.save(text, "  ");
  return WriteWhole(file, text.str());
}

}  // namespace phrenic::client
