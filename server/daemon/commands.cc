#include "server/daemon/commands.h"

#include <cstdio>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/access/rules.h"
#include "server/access/token_file.h"
#include "server/daemon/serve.h"
#include "server/store/check.h"

namespace phrenic::daemon {
namespace {

int Fail(const absl::Status& status) {
  std::fprintf(stderr, "phrenicd: %s\n", std::string(status.message()).c_str());
  return kFailed;
}

int Check(const std::string& folder) {
  const auto checked = store::CheckStore(folder);
  if (!checked.ok()) return Fail(checked.status());
  std::fputs(store::Describe(folder, *checked).c_str(), stdout);
  return checked->whole() ? kOk : kFailed;
}

struct TokenWords {
  std::string name, role = "viewer";
};

absl::Status NeedsFile(const std::string& file) {
  if (!file.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError("--tokens: pass the token file that the server uses");
}

int TokenAdd(const std::string& file, const TokenWords& words) {
  if (const absl::Status status = NeedsFile(file); !status.ok()) return Fail(status);
  const auto token = access::AddToken(file, {words.name, access::RoleOf(words.role)});
  if (!token.ok()) return Fail(token.status());
  std::fprintf(stderr, "phrenicd: the token of %s is shown only once; save it to a file for phrenic --token-file\n",
               words.name.c_str());
  std::printf("%s\n", token->c_str());
  return kOk;
}

int TokenList(const std::string& file) {
  if (const absl::Status status = NeedsFile(file); !status.ok()) return Fail(status);
  const auto tokens = access::ReadTokens(file);
  if (!tokens.ok()) return Fail(tokens.status());
  for (const auto& [hash, account] : *tokens) {
    std::printf("%-10s %s\n", std::string(access::NameOf(account.role)).c_str(), account.name.c_str());
  }
  return kOk;
}

int TokenRemove(const std::string& file, const TokenWords& words) {
  if (const absl::Status status = NeedsFile(file); !status.ok()) return Fail(status);
  const absl::Status removed = access::RemoveToken(file, words.name);
  return removed.ok() ? kOk : Fail(removed);
}

void AddTokenCommands(CLI::App& app, Flags& flags, std::function<int()>& chosen) {
  const auto words = std::make_shared<TokenWords>();
  const std::string& file = flags.options.accounts.tokens_file;
  CLI::App* token =
      app.add_subcommand("token", "Manage the accounts in the file of --tokens; a running server reloads it");
  token->require_subcommand(1)->fallthrough();
  CLI::App* add = token->add_subcommand("add", "Add an account and print its token, which is shown only once");
  add->add_option("--name", words->name, "name of the account: 1 to 64 letters, digits and -_.@")->required();
  add->add_option("--role", words->role, "viewer, controller, owner or admin")
      ->check(CLI::IsMember({"viewer", "controller", "owner", "admin"}))
      ->capture_default_str();
  add->fallthrough()->callback([&chosen, &file, words] { chosen = [&file, words] { return TokenAdd(file, *words); }; });
  CLI::App* list = token->add_subcommand("list", "List roles and names");
  list->fallthrough()->callback([&chosen, &file] { chosen = [&file] { return TokenList(file); }; });
  CLI::App* remove = token->add_subcommand("remove", "Remove an account");
  remove->add_option("--name", words->name, "name of the account")->required();
  remove->fallthrough()->callback(
      [&chosen, &file, words] { chosen = [&file, words] { return TokenRemove(file, *words); }; });
}

}  // namespace

void AddCommands(CLI::App& app, Flags& flags, std::function<int()>& chosen) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* check = app.add_subcommand("check", "Check a store and print its contents; changes nothing");
  check->add_option("DIR", *folder, "folder of the store")->required();
  check->callback([&chosen, folder] { chosen = [folder] { return Check(*folder); }; });
  AddTokenCommands(app, flags, chosen);
}

}  // namespace phrenic::daemon
