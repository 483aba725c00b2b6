#include "server/service/calls/call_table.h"

#include <set>

#include "absl/strings/str_replace.h"

namespace phrenic::service {

void CallTable::Add(const std::string& package, Method method) {
  const std::string name(method.rule->method);
  methods_.emplace(absl::StrCat("/", package, ".", absl::StrReplaceAll(name, {{".", "/"}})), std::move(method));
}

const Method* CallTable::Find(const std::string& path) const {
  const auto found = methods_.find(path);
  return found == methods_.end() ? nullptr : &found->second;
}

const access::Rule* CallTable::RuleOf(const std::string& path) const {
  const Method* method = Find(path);
  return method == nullptr ? nullptr : method->rule;
}

std::vector<std::string> CallTable::Services() const {
  std::set<std::string> services;
  for (const auto& [path, method] : methods_) services.insert(path.substr(1, path.rfind('/') - 1));
  return {services.begin(), services.end()};
}

grpc::ServerGenericBidiReactor* CallTable::CreateReactor(grpc::GenericCallbackServerContext* context) {
  return ServedCall::Make(Find(context->method()), guard_, limits_, *context);
}

}  // namespace phrenic::service
