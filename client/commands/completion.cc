// `phrenic completion SHELL`: scripts that call `phrenic __complete LINE` at each press of the tab key.
#include <iostream>
#include <memory>
#include <string>

#include "client/commands/commands.h"

namespace phrenic::client {
namespace {

// Bash ends a word at "=" and ":" and replaces only the text after the last of them.
constexpr char kBash[] = R"bash(# Completion of phrenic in bash: source <(phrenic completion bash)
_phrenic() {
  local line=${COMP_LINE:0:COMP_POINT} word directive answer
  local -a answers=()
  word=${line##*[[:space:]]}
  mapfile -t answers < <("${COMP_WORDS[0]}" __complete "$line" 2>/dev/null)
  [[ ${#answers[@]} -gt 0 ]] || return
  directive=${answers[-1]}
  unset 'answers[-1]'
  COMPREPLY=()
  for answer in "${answers[@]}"; do COMPREPLY+=("${answer%%$'\t'*}"); done
  if [[ $word == *[=:]* && $COMP_WORDBREAKS == *=* ]]; then
    COMPREPLY=("${COMPREPLY[@]#"${word%"${word##*[=:]}"}"}")
  fi
  case $directive in
    :files) compopt -o filenames; mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "${word##*=}") ;;
    :folders) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "${word##*=}") ;;
    :nospace) compopt -o nospace ;;
  esac
}
complete -F _phrenic phrenic
)bash";

constexpr char kZsh[] = R"zsh(#compdef phrenic
# Completion of phrenic in zsh: source <(phrenic completion zsh), after compinit
_phrenic() {
  local directive answer word meaning
  local -a answers described bare
  answers=("${(@f)$("${(Q)words[1]}" __complete "${(j: :)words[1,CURRENT-1]} $PREFIX" 2>/dev/null)}")
  directive=${answers[-1]}
  answers[-1]=()
  for answer in $answers; do
    word=${answer%%$'\t'*}
    meaning=
    [[ $answer == *$'\t'* ]] && meaning=${answer#*$'\t'}
    described+=("${word//:/\\:}${meaning:+:$meaning}")
  done
  case $directive in
    :nospace) _describe -t phrenic phrenic described -S '' ;;
    :files) _describe -t phrenic phrenic described; [[ $PREFIX == --*=* ]] && compset -P '*='; _files ;;
    :folders) [[ $PREFIX == --*=* ]] && compset -P '*='; _files -/ ;;
    *) _describe -t phrenic phrenic described ;;
  esac
}
compdef _phrenic phrenic
)zsh";

constexpr char kFish[] =
    R"fish(# Completion of phrenic in fish: phrenic completion fish > ~/.config/fish/completions/phrenic.fish
function __phrenic_complete
    set -l program (commandline -opc)[1]
    set -l answers ($program __complete (commandline -cp | string collect) 2>/dev/null)
    test (count $answers) -gt 0; or return
    set -l directive $answers[-1]
    set -e answers[-1]
    printf '%s\n' $answers
    switch $directive
        case :files
            __fish_complete_path (commandline -ct)
        case :folders
            __fish_complete_directories (commandline -ct)
    end
end
complete -c phrenic -f -a '(__phrenic_complete)'
)fish";

}  // namespace

CommandFunction SetUpCompletion(CLI::App& command) {
  const auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, "bash, zsh or fish")->required();
  return [shell](const Context&) {
    std::cout << (*shell == "bash" ? kBash : *shell == "zsh" ? kZsh : kFish);
    return kOk;
  };
}

}  // namespace phrenic::client
